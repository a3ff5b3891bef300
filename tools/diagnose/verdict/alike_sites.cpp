#include "tools/diagnose/verdict/alike_sites.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "models/random/philox.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/term_text.h"
#include "tools/diagnose/wording.h"

namespace loopwright::diagnosis {
namespace {

const TermShape& shape_of(std::string_view name) {
  return *std::ranges::find(named_shapes(), name, &TermShape::name);
}

/// What is nearest to zero, with its sign, if all are on one side of it; otherwise zero.
double nearest_of_one_side(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax(values);
  return low > 0 ? low : std::min(high, 0.0);
}

/// The whitened errors that a constant at the site makes.
Eigen::VectorXd response_to_constant(SiteFitter& fitter, const SitePass& pass, int site) {
  const std::vector<double> one(pass.rows, 1.0);
  Eigen::VectorXd column(Eigen::Index(pass.error.size()));
  fitter.filter().respond(pass, site, one, one, one, {column.data(), pass.error.size()});
  return column;
}

}  // namespace

std::vector<SiteTerm> same_beside_zero(SiteFitter& fitter, SiteHypothesis h, size_t term) {
  const SiteTerm found = h.terms[term];
  const bool is_constant = found.shape->name == "constant", is_dead_zone = found.shape->name == "dead_zone";
  std::vector<SiteTerm> list;
  SitePass pass;
  if ((!is_constant && !is_dead_zone) || !fitter.pass(h, true, pass)) return list;
  const SiteModel& model = fitter.model();
  for (int site = 0; site < int(model.sites().size()); ++site) {
    const int input = model.input_of(site);
    const double nearest = input < 0 ? 0 : nearest_of_one_side(model.record().inputs[size_t(input)].value);
    if (nearest == 0) continue;
    SiteTerm same;
    same.site = site;
    if (is_dead_zone && site == found.site && found.nonlinear[0] < std::abs(nearest)) {
      same.shape = &shape_of("constant"), same.coefficient[0] = std::copysign(found.nonlinear[0], -nearest);
      list.push_back(same);
    }
    if (!is_constant) continue;
    const Eigen::VectorXd there = response_to_constant(fitter, pass, found.site),
                          here = response_to_constant(fitter, pass, site);
    const double product = here.dot(there);
    if (!(std::abs(product) > criteria::alike_responses * here.norm() * there.norm())) continue;
    const double half_width = -found.coefficient[0] * product / here.squaredNorm() * (nearest < 0 ? -1 : 1);
    if (!(half_width > 0) || half_width >= std::abs(nearest)) continue;
    same.shape = &shape_of("dead_zone"), same.variable = model.own_variable(site);
    same.nonlinear[0] = half_width;
    list.push_back(same);
  }
  return list;
}

std::vector<std::string> alike_sites(SiteFitter& fitter, SiteHypothesis h) {
  std::vector<std::string> sentences;
  SitePass pass;
  if (!fitter.pass(h, true, pass)) return sentences;
  std::vector<double> trial(pass.rows);
  for (size_t k = 0; k < pass.rows; ++k) trial[k] = uniform_pair(1, 0, k / criteria::trial_hold).first - 0.5;
  const std::vector<Site>& sites = fitter.model().sites();
  std::vector<std::pair<size_t, Eigen::VectorXd>> columns;
  for (size_t s = 0; s < sites.size(); ++s) {
    if (sites[s].kind == Site::Kind::sensor) continue;
    Eigen::VectorXd column(Eigen::Index(pass.error.size()));
    fitter.filter().respond(pass, int(s), trial, trial, trial, {column.data(), pass.error.size()});
    const auto is_site = [&](const RecordedOutput& output) { return output.port == sites[s].name; };
    if (!(column.norm() > 0) && std::ranges::any_of(fitter.model().record().outputs, is_site)) {
      sentences.push_back("what is added at " + sites[s].name +
                          " is added to what is measured, with no state between: no law is looked for there");
      continue;
    }
    if (!(column.norm() > 0)) {
      sentences.push_back(fmt::format("nothing at {} shows in what is measured", sites[s].name));
      continue;
    }
    if (std::isfinite(column.norm())) columns.emplace_back(s, column.normalized());
  }
  while (!columns.empty()) {
    std::vector<std::string> alike;
    std::vector<Eigen::VectorXd> group{columns.front().second};
    for (size_t next = 0; next < group.size(); ++next)  // those that look like one of the group belong to it
      std::erase_if(columns, [&](const auto& column) {
        if (!(std::abs(group[next].dot(column.second)) > criteria::alike_responses)) return false;
        alike.push_back("what acts at " + sites[column.first].name);
        if (column.second != group.front()) group.push_back(column.second);
        return true;
      });
    if (alike.size() > 1)
      sentences.push_back(loopwright::joined(alike, " and ") + " look alike in what is measured");
  }
  return sentences;
}

std::vector<std::string> possible_products(const SiteModel& model, const SiteHypothesis& h) {
  std::vector<std::string> sentences;
  const auto is_linear = [](const SiteTerm& term) { return term.shape->name == "linear"; };
  for (size_t a = 0; a < h.terms.size(); ++a)
    for (size_t b = a + 1; b < h.terms.size(); ++b) {
      const SiteTerm &one = h.terms[a], &other = h.terms[b];
      if (!is_linear(one) || !is_linear(other) || one.site != other.site || one.variable == other.variable)
        continue;
      sentences.push_back(
          fmt::format("{} and {} may be one law of both signals, such as their product, which near one point "
                      "of operation is a law of each",
                      describe(model, one), describe(model, other)));
    }
  return sentences;
}

}  // namespace loopwright::diagnosis
