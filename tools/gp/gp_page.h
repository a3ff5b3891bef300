/// What was learned, for a reader: hyper-parameters and priors, the surface, residuals, doubts.
#pragma once
#include "tools/gp/train.h"
#include "tools/report/report.h"

namespace loopwright {

/// Samples that a model is shown with, and what they are.
struct ShownSamples {
  std::string title;  ///< "Training", "evaluation.training.json"
  gp::Samples samples;
  Score score;
};

/// "PE(x) + SE(v)".
std::string formula(const gp::Kernel& kernel);
report::Page model_page(const LearnedModel& learned, const std::vector<ShownSamples>& shown,
                        const std::vector<std::string>& notes);
/// A few lines for a terminal.
std::string model_summary(const LearnedModel& learned, const std::vector<ShownSamples>& shown);
/// Stable keys: hyper_parameters.<name>, log_evidence, residual_rms, samples, warnings, slope_bounds,
/// scores.<title>.{rmse,mean,greatest,samples}.
std::string model_json(const LearnedModel& learned, const std::vector<ShownSamples>& shown);

}  // namespace loopwright
