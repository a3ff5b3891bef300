/// The roles of blocks in a diagram of a motion control loop.
#pragma once
#include "tools/stability/stability.h"

namespace loopwright {

/// Blocks by their paths, ports by their names; empty if there is none.
struct LoopRoles {
  std::string disturbance;         ///< input port of the plant, among the outermost blocks
  std::string position;            ///< port whose number the controller uses as the position
  std::string observer;            ///< block of type DisturbanceObserver, or its continuous counterpart
  std::string feedback;            ///< block of type PdController, or its continuous counterpart
  std::string learned;             ///< block of type Gpr
  std::string weighting;           ///< block of type CompensationFilter that reads it
  std::string velocity_estimator;  ///< block of type VelocityEstimator that the learned block reads
};

/// The plant is the outermost block with the most continuous states, except controllers; `disturbance` names
/// its input if it has several. Problems for roles that are filled twice or not at all (position,
/// disturbance).
LoopRoles find_roles(const Plan& plan, const Diagram& diagram, const std::string& disturbance,
                     Problems& problems);

/// What a diagram states about its learned block.
struct LearnedFunction {
  double by_position = 0, by_velocity = 0;  ///< greatest slopes, command per position, command per velocity
  double greatest = 0;                      ///< |mean|
  double lead = 0;                          ///< s
  bool holds_beyond_training = true;        ///< the slopes are valid at any velocity
};

/// Reads the model that the block names. Problems as for the block itself.
LearnedFunction read_learned(const Diagram& diagram, const std::string& block, Problems& problems);

}  // namespace loopwright
