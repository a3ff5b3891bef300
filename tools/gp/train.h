/// Training: from samples to a model, with the warnings that a user needs before relying on it.
#pragma once
#include <functional>
#include "blocks/learning/model_file.h"
#include "tools/gp/samples.h"

namespace loopwright {

struct TrainedModel {
  LearnedModel learned;
  gp::Fit fit;
  std::shared_ptr<const TrainingSamples> samples;
  std::vector<double> residuals;   ///< label - prediction, one per sample
  std::vector<std::string> notes;  ///< how it was computed
  bool is_structured = true;
};

/// Completed and total evaluations of the log evidence, for a progress bar; false stops the training.
using TrainingProgress = std::function<bool(double done, double total)>;

/// Null when there are errors: too few samples, labels that do not vary, a kernel that is too large. Anything
/// merely doubtful is in `learned.warnings`.
std::shared_ptr<const TrainedModel> train(const Training& training, Problems& problems,
                                          const TrainingProgress& progress = {});

/// Accuracy of a model on other samples.
struct Score {
  double rmse = 0, mean = 0, greatest = 0;  ///< label unit
  double label_deviation = 0;
  std::vector<double> residuals;
};
Score score(const gp::Model& model, const gp::Samples& samples);

/// The share of the labels' variance that three harmonics of a period explain, after subtracting the mean at
/// each velocity; and the period within half an octave of it that explains most.
struct PeriodCheck {
  double share = 0, best_period = 0, best_share = 0;
};
PeriodCheck check_period(const gp::Samples& samples, double period);

}  // namespace loopwright
