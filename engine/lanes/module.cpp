/// Compiled into every lane module, with LOOPWRIGHT_LANE_REAL set to the scalar of its instruction set.
#include "engine/lanes/module.h"
#include <map>
#include "engine/lanes/lane_run_of.h"
#include "engine/run/lane_instance.h"

namespace loopwright {

template <class Real> std::map<std::string, Kernels<Real>, std::less<>>& lane_kernels() {
  static std::map<std::string, Kernels<Real>, std::less<>> kernels;
  return kernels;
}
template std::map<std::string, Kernels<LOOPWRIGHT_LANE_REAL>, std::less<>>&
lane_kernels<LOOPWRIGHT_LANE_REAL>();

}  // namespace loopwright

extern "C" [[gnu::visibility("default")]] const loopwright::LaneModule* loopwright_lane_module() {
  using namespace loopwright;
  static const LaneModule module{lane_layout, [](const Plan& plan, int arenas) -> LaneRun* {
                                   return new LaneRunOf<LOOPWRIGHT_LANE_REAL>(plan, arenas);
                                 }};
  return &module;
}
