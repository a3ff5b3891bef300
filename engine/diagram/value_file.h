/// Values of another JSON or MAT file in the place of values in a diagram: {"file": "gains.json", "name":
/// "K"}.
#pragma once
#include "engine/json/reader.h"

namespace loopwright {

/// Whether the value is an object of just "file" and "name".
bool refers_to_file(const Value& value);

/// The number, flag, text or list with this name. The path of the file is relative to the file that contains
/// it; the parts of the name are joined by dots, elements of lists are counted from 0: "poles.0.re". The file
/// contains plain JSON: numbers with units, {"value": 5, "unit": "mm"}, but neither expressions nor further
/// files. A MAT file is one whose name ends in ".mat", see mat_value.h. Reports whatever is missing; the
/// result is then broken.
Value value_from_file(const Value& reference, const Reader& reader);

/// Puts the value of the file in the place of a value that refers to it, and leaves all others.
void take_from_file(Value& value, const Reader& reader);

}  // namespace loopwright
