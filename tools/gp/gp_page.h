/// Presents the trained model: hyper-parameters and priors, the surface, residuals, warnings.
#pragma once
#include "tools/gp/train.h"
#include "tools/report/report.h"

namespace loopwright {

/// Samples with which a model is shown, and their title.
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
