#include "tools/diagnose/search/site_start.h"

namespace loopwright::diagnosis {
namespace {

constexpr int most_first_substeps = 64;

/// Sizes of states and sites. False if the model diverges with the shortest steps.
bool learn_sizes(SiteFitter& fitter, SiteHypothesis& h) {
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

}  // namespace loopwright::diagnosis
