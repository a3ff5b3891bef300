/// From recordings to samples: sections of constant velocity, windows, labels without lag.
#pragma once
#include "tools/gp/training.h"

namespace loopwright {

/// Position relative to the model's origin, velocity, disturbance: all in SI, labels including their mean.
struct TrainingSamples {
  gp::Samples samples;
  std::string label_unit;          ///< SI
  std::string hash;                ///< of the samples
  std::vector<std::string> files;  ///< that were read
  size_t before_thinning = 0;
  /// The parts that were used, for the report.
  struct Section {
    std::string file;
    double velocity = 0, from = 0, to = 0, low = 0, high = 0;  ///< m/s, s, m
    size_t count = 0;
  };
  std::vector<Section> sections;
  std::vector<std::string> warnings;
};

/// Null when there are errors, each with its source location in the training file or recording.
std::shared_ptr<const TrainingSamples> collect_samples(const Training& training, Problems& problems);

}  // namespace loopwright
