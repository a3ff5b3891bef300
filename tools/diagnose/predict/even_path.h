/// A path whose rows were not sampled evenly, as an effect with a memory runs along it: the blocks of effects
/// step from sample to sample, all of the same length.
#pragma once
#include <span>
#include <vector>
#include "tools/diagnose/predict/predictor.h"
#include "tools/effects/effect_run.h"

namespace loopwright::diagnosis {

/// The signals of a path at even instants, each from the row nearest to
/// it.
class EvenPath {
 public:
  /// `parts`: instants in a sample time.
  explicit EvenPath(const Path& path, int parts = 1);

  size_t rows() const { return position_.size(); }
  RoleSignals signals() const;
  /// What an effect gives over the even samples, as it is over the rows of the path.
  void to_rows(std::vector<float>& mean, std::vector<float>& change) const;

 private:
  std::vector<double> edges_, even_edges_;  ///< [sample times]
  std::vector<double> position_, velocity_, acceleration_, input_, force_;
};

}  // namespace loopwright::diagnosis
