/// What a lane module hands to the program: the only thing that it exports.
#pragma once
#include "engine/lanes/lane_run.h"

namespace loopwright {

/// Sizes of what crosses the border between program and module. They differ when the two are not of one
/// build.
inline constexpr std::array<size_t, 6> lane_layout{sizeof(Plan),         sizeof(Plan::Block),
                                                   sizeof(BlockType),    sizeof(FaultReport),
                                                   sizeof(Call<double>), sizeof(LaneFailure)};

struct LaneModule {
  std::array<size_t, 6> layout;
  LaneRun* (*make)(const Plan& plan, int arenas);
};
/// The name and type of the entry.
inline constexpr const char* lane_module_entry = "loopwright_lane_module";
using LaneModuleEntry = const LaneModule*();

}  // namespace loopwright
