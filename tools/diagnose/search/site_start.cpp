#include "tools/diagnose/search/site_start.h"
#include <algorithm>

namespace loopwright::diagnosis {
namespace {

constexpr int most_first_substeps = 64;

/// Sizes of states and sites, from those before. False if the model diverges with the shortest steps.
bool learn_sizes_further(SiteFitter& fitter, SiteHypothesis& h) {
  constexpr int rounds = 3;  // the sizes of the first pass are guesses
  SitePass pass;
  for (int round = 0; round < rounds; ++round) {
    h.noise = fitter.filter().guess_noise();
    while (!fitter.pass(h, true, pass)) {  // a fast state needs shorter steps
      if (fitter.model().substeps() >= most_first_substeps) return false;
      fitter.model().set_substeps(2 * fitter.model().substeps());
    }
    fitter.filter().learn_scales(pass);
    fitter.filter().choose_substeps(pass);
  }
  return true;
}

/// The same with smaller guesses for the sites, where the first leads to states for which the model was not
/// made: an ampere that drives a diode to e⁶⁰ tells nothing of its response.
bool learn_sizes(SiteFitter& fitter, SiteHypothesis& h) {
  constexpr double guesses[] = {1e-2, 1e-4, 1e-6};  // SI
  const int substeps = fitter.model().substeps();
  if (learn_sizes_further(fitter, h)) return true;
  for (const double guess : guesses) {
    fitter.filter().guess_scales(guess), fitter.model().set_substeps(substeps);
    if (learn_sizes_further(fitter, h)) return true;
  }
  return false;
}

}  // namespace

std::optional<double> start_from_stated(SiteFitter& fitter, ErrorsOf errors,
                                        const std::vector<SlowNoise>& disturbances, SiteHypothesis& h) {
  h.factors.assign(fitter.model().parameters().size(), 1.0);
  h.is_free.assign(fitter.model().parameters().size(), false);
  SitePass pass;
  if (errors == ErrorsOf::predictions) {
    if (!learn_sizes(fitter, h)) return {};
    h.noise = fitter.filter().guess_noise();
    h.noise.slow = disturbances;
  } else {  // the sizes are those that predictions have found
    h.noise = fitter.filter().noise_of_simulation();
    if (!fitter.pass(h, false, pass)) return {};
  }
  fitter.fit_noise(h);
  return fitter.pass(h, false, pass) ? std::optional(double(pass.readings)) : std::nullopt;
}

SiteHypothesis with_free_parameters(SiteFitter& fitter, SiteHypothesis h) {
  constexpr double least_response = 1e-3;  // in whitened errors, for a change by all of the parameter
  std::fill(h.is_free.begin(), h.is_free.end(), true);
  SitePass pass;
  if (!fitter.pass(h, false, pass)) return h;
  const Eigen::MatrixXd J = fitter.jacobian(h, pass);
  for (size_t i = 0; i < h.is_free.size(); ++i) h.is_free[i] = J.col(Eigen::Index(i)).norm() > least_response;
  fitter.refine(h, 8);
  fitter.anneal(h);
  return h;
}

}  // namespace loopwright::diagnosis
