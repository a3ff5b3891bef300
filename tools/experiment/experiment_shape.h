/// The keys of experiment files, for their reader and for the JSON Schema.
#pragma once
#include "engine/json/file_shape.h"

namespace loopwright {

FileShape experiment_shape();
FileShape driven_port_shape();
FileShape compared_port_shape();
FileShape roles_shape();
FileShape hold_out_shape();

}  // namespace loopwright
