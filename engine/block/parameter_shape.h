/// Described parameters as the shape of a file.
#pragma once
#include "engine/block/parameters.h"
#include "engine/json/file_shape.h"

namespace loopwright {

/// How the numbers and lists of a file are written.
enum class Writing {
  plain,     ///< as they are
  evaluated  ///< or as expressions, with units, or taken from other files
};

/// What may stand in the place of a parameter. Its unit is part of the sentence.
FileShape shape_of(const ParameterInfo& parameter, Writing writing);

/// The object that read_fields() reads.
FileShape shape_of(const std::vector<ParameterInfo>& fields, Writing writing);

}  // namespace loopwright
