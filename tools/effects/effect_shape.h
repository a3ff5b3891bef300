/// The keys of effect files, for their reader and for the JSON Schema.
#pragma once
#include "engine/json/file_shape.h"

namespace loopwright {

FileShape effect_shape();       ///< of an axis
FileShape site_effect_shape();  ///< at a site of any diagram
FileShape site_parameter_shape();
FileShape any_effect_shape();  ///< one of both
FileShape effect_form_shape();
FileShape fitted_parameter_shape();
FileShape given_parameter_shape();
FileShape signal_attachment_shape();     ///< to the force, the input or the sensor
FileShape parameter_attachment_shape();  ///< to a parameter of a block
FileShape needs_shape();
FileShape confusable_shape();
FileShape separating_experiment_shape();

}  // namespace loopwright
