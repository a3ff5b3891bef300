/// The variables of a MAT file as values, named as those of a JSON file.
#pragma once
#include <optional>
#include <string>
#include "engine/json/reader.h"

namespace loopwright {

/// Whether the name ends in ".mat", in upper or lower case.
bool is_mat_path(const std::string& path);

/// An object of all variables. The child process of recordings reads them (engine/record/mat_variables.h).
///
/// A structure is an object, an array of structures a list of objects. Of numbers, one alone is a number, one
/// row or one column a list, any other matrix a list of rows; matrix_form() says which. Logical values are
/// flags, characters in one row a text, cells of texts a list of texts. Whatever else a variable may be,
/// why_unusable() tells. All values have the place of `reference`, {"file": …, "name": …}: a binary file has
/// no lines. A file that cannot be read is a problem there, and the result is empty.
std::optional<Value> values_of_mat(const std::string& path, const Value& reference, const Reader& reader);

/// "complex numbers" and the like; empty for a value that can be used.
std::string why_unusable(const Value& value);

}  // namespace loopwright
