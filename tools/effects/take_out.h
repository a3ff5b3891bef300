/// Blocks around an effect by which one number of the diagram takes it out.
#pragma once
#include <string>
#include "tools/effects/effect.h"

namespace loopwright {

/// The value of a setting that stands for the number: 1 with the effect, 0 without it.
inline const std::string switch_value = "=@with";
/// Whether a setting of a block has it.
bool mentions_switch(const Value& block);
/// The parameter of the diagram: "with_cogging".
inline const std::string switch_prefix = "with_";
inline std::string switch_of(const std::string& effect) { return switch_prefix + effect; }

/// The same effect with more blocks. A force is multiplied by the number. An effect of the input or of the
/// sensor is chosen, or the signal without it; the input is then read by one block alone. What is added to
/// parameters of existing blocks is multiplied when it is inserted.
Effect with_switch(Effect effect);

}  // namespace loopwright
