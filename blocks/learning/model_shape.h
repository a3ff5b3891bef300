/// The keys of files of learned models, for the JSON Schema.
#pragma once
#include "engine/json/file_shape.h"

namespace loopwright {

FileShape model_shape();

}  // namespace loopwright
