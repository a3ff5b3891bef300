#include "tools/diagnose/verdict/followed_signal.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/verdict/smooth_share.h"

namespace loopwright::diagnosis {
namespace {

/// Along the rows in which the filter has settled.
class Course {
 public:
  Course(const SiteModel& model, const SitePass& pass)
      : pass_(pass), settles_(model.record().settling_rows()) {}

  std::vector<double> of_state(size_t state) const {
    return along([&](size_t row) { return pass_.filtered[row * pass_.states + state]; });
  }
  std::vector<double> of_variable(const SiteVariable& variable) const {
    return along([&](size_t row) { return variable.at(&pass_.path[0][row * pass_.numbers]); });
  }

 private:
  template <class At> std::vector<double> along(At&& at) const {
    std::vector<double> values;
    for (size_t row = 0; row < pass_.rows; ++row)
      if (!settles_[row]) values.push_back(at(row));
    return values;
  }

  const SitePass& pass_;
  const std::vector<bool> settles_;
};

}  // namespace

std::optional<FollowedSignal> followed_signal(SiteFitter& fitter, SiteHypothesis h, size_t disturbance) {
  SitePass pass;
  if (!fitter.pass(h, true, pass)) return {};
  const SiteModel& model = fitter.model();
  const int site = h.noise.slow[disturbance].site;
  const Course course(model, pass);
  const std::vector<double> slow = course.of_state(size_t(model.states()) + disturbance);
  const size_t stretch = slow.size() / criteria::folds + 1;
  FollowedSignal best{"", criteria::least_share_of_disturbance};
  const auto compare = [&](std::span<const double> signal, std::span<const double> side, std::string name) {
    const double share = smooth_share(slow, signal, criteria::levels_of_disturbance, stretch, side);
    if (share > best.share) best = {std::move(name), share};
  };
  const std::vector<SiteVariable>& variables = model.variables();
  for (size_t v = 0; v < variables.size(); ++v) {
    if (model.nearness(site, int(v)) != Nearness::near) continue;
    const std::vector<double> signal = course.of_variable(variables[v]);
    compare(signal, {}, variables[v].name);
    for (size_t s = 0; s < variables.size(); ++s)
      if (s != v && variables[s].quantity == Quantity::velocity &&
          model.nearness(site, int(s)) == Nearness::near)
        compare(signal, course.of_variable(variables[s]),
                variables[v].name + " and the direction of " + variables[s].name);
  }
  return best.name.empty() ? std::nullopt : std::optional(best);
}

}  // namespace loopwright::diagnosis
