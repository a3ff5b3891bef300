#include "tools/effects/check_blocks.h"
#include "tools/effects/bound.h"
#include "tools/effects/effect_plan.h"

namespace loopwright {

void check_blocks(const Effect& effect, Problems& problems) {
  Problems of_linear, of_rotary;
  const bool fits = compile_effect(effect, {"m", "N", "N"}, example_sizes(), of_linear) ||
                    compile_effect(effect, {"rad", "N*m", "A"}, example_sizes(), of_rotary);
  if (!fits) problems.add(of_linear);
}

}  // namespace loopwright
