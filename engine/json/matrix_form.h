/// What a value was that comes from a matrix with rows and columns.
#pragma once
#include <string_view>
#include "engine/json/value.h"

namespace loopwright {

/// One element is a number (or a flag) among values, one row or one column a list, any other matrix a list of
/// rows.
enum class MatrixForm { none, one, row, column, full };

/// The form is kept in members that numbers and lists do not use otherwise: copies of a value keep it, and
/// values that are read from JSON have none.
inline void set_matrix_form(Value& value, MatrixForm form) {
  if (value.kind == Value::Kind::number) value.boolean = form == MatrixForm::one;
  if (value.kind != Value::Kind::list) return;
  value.text = form == MatrixForm::row      ? "row"
               : form == MatrixForm::column ? "column"
               : form == MatrixForm::full   ? "matrix"
                                            : "";
}

inline MatrixForm matrix_form(const Value& value) {
  if (value.kind == Value::Kind::number && value.boolean) return MatrixForm::one;
  if (value.kind != Value::Kind::list) return MatrixForm::none;
  return value.text == "row"      ? MatrixForm::row
         : value.text == "column" ? MatrixForm::column
         : value.text == "matrix" ? MatrixForm::full
                                  : MatrixForm::none;
}

}  // namespace loopwright
