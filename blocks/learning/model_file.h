/// Learned disturbances as files: JSON, versioned, with a checksum over all results of training.
#pragma once
#include <string>
#include <vector>
#include "engine/json/problem.h"
#include "models/gp/hyperparameters.h"
#include "models/gp/model.h"

namespace loopwright {

/// A model with the information about it that a reader needs.
struct LearnedModel {
  gp::Model model;
  std::string title;
  std::string position_unit = "m", velocity_unit = "m/s", label_unit;  ///< SI
  std::vector<std::string> files;                                      ///< recordings used for training
  std::string data_hash;  ///< of the samples, by content_hash()
  size_t sample_count = 0;
  std::vector<gp::Prior> priors;      ///< in the order of gp::parameters_of()
  double log_evidence = 0;            ///< log marginal likelihood at the hyper-parameters
  double residual_rms = 0;            ///< label unit, over the samples
  std::vector<std::string> warnings;  ///< given by training
  gp::Samples shown;                  ///< some of the samples, for plots
};

inline constexpr int model_file_version = 1;

/// Problems have their source location in the model file, or at `reference` if the file cannot be read at
/// all. The result is valid only if no error was added.
LearnedModel read_model(const std::string& path, const Place& reference, Problems& problems);
/// The same for a file already in memory.
LearnedModel read_model(std::shared_ptr<const SourceFile> file, Problems& problems);

/// Writes the file completely or not at all; throws std::runtime_error as write_file().
void write_model(const std::string& path, const LearnedModel& model);

}  // namespace loopwright
