/// A model file for tests of blocks on learned disturbances.
#pragma once
#include <unistd.h>
#include <filesystem>
#include "blocks/learning/model_file.h"
#include "tests/models/gp/disturbance.h"

namespace loopwright {

/// PE(x) + SE(v), from 400 samples of velocities 0.05 … 0.5 m/s, with a homing offset of 3 mm.
inline LearnedModel trained_model(const gp::Kernel& kernel = gp::additive()) {
  const gp::Samples samples = gp::disturbance(400, gp::Velocities::few);
  LearnedModel learned;
  learned.title = "Cogging of a test axis";
  learned.label_unit = "V";
  learned.sample_count = samples.labels.size();
  learned.model = {kernel, 0.12, 0.003, 0, {gp::Range{0.1, 0.325}, gp::Range{0.05, 0.5}}, samples};
  std::string why_not;
  if (const auto statistics = gp::summarise(kernel, {0.25, 0.05}, samples, why_not))
    learned.model.data = *statistics;
  for (size_t i = 0; i < gp::parameters_of(kernel).size(); ++i) learned.priors.push_back({1, 1, 0.01, 100});
  learned.shown = gp::disturbance(20, gp::Velocities::few);
  return learned;
}

/// A temporary folder with the model in it.
class ModelFolder {
 public:
  explicit ModelFolder(const LearnedModel& model = trained_model())
      : folder_(std::filesystem::temp_directory_path() /
                ("learned_model_" + std::to_string(getpid()) + "_" + std::to_string(count_++))) {
    std::filesystem::create_directories(folder_);
    write_model(path(), model);
  }
  ~ModelFolder() { std::filesystem::remove_all(folder_); }
  std::string path() const { return (folder_ / "axis.model.json").string(); }

 private:
  static inline int count_ = 0;
  std::filesystem::path folder_;
};

}  // namespace loopwright
