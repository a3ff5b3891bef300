#include "tools/diagnose/verdict/followed_signal.h"
#include <algorithm>
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

/// A function of any signal contains a constant: the mean of a disturbance follows none.
std::vector<double> about_its_mean(std::vector<double> values) {
  double mean = 0;
  for (const double v : values) mean += v / double(values.size());
  for (double& v : values) v -= mean;
  return values;
}

}  // namespace

std::optional<FollowedSignal> followed_signal(SiteFitter& fitter, SiteHypothesis h, size_t disturbance) {
  SitePass pass;
  if (!fitter.pass(h, true, pass)) return {};
  const SiteModel& model = fitter.model();
  const int site = h.noise.slow[disturbance].site;
  const Course course(model, pass);
  const std::vector<double> slow = about_its_mean(course.of_state(size_t(model.states()) + disturbance));
  const size_t stretch = slow.size() / criteria::folds + 1;
  FollowedSignal best{"", criteria::least_share_of_disturbance};
  const auto compare = [&](std::span<const double> signal, std::span<const double> side, std::string name) {
    const double share = smooth_share(slow, signal, criteria::levels_of_disturbance, stretch, side);
    if (share > best.share + (best.name.empty() ? 0 : criteria::least_dependence))
      best = {std::move(name), share};
  };
  const std::vector<SiteVariable>& variables = model.variables();
  std::vector<size_t> near;
  for (size_t v = 0; v < variables.size(); ++v)
    if (model.nearness(site, int(v)) == Nearness::near) near.push_back(v);
  // What only follows from a state comes after it.
  std::ranges::stable_partition(near, [&](size_t v) { return variables[v].is_state; });
  for (const size_t v : near) compare(course.of_variable(variables[v]), {}, variables[v].name);
  for (const size_t v : near)
    for (const size_t side : near)
      if (side != v && variables[side].quantity == Quantity::velocity)
        compare(course.of_variable(variables[v]), course.of_variable(variables[side]),
                variables[v].name + " and the direction of " + variables[side].name);
  return best.name.empty() ? std::nullopt : std::optional(best);
}

}  // namespace loopwright::diagnosis
