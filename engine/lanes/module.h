/// The interface of a lane module to the program: its only export.
#pragma once
#include "engine/lanes/lane_run.h"

namespace loopwright {

/// Sizes of the types shared by program and module. They differ if the two are not from the same build.
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
