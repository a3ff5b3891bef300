/// The keys of training files, for the JSON Schema.
#pragma once
#include "engine/json/file_shape.h"

namespace loopwright {

FileShape training_shape();

}  // namespace loopwright
