#include "tools/diagnose/verdict/alike_sites.h"
#include <fmt/format.h>
#include <cmath>
#include "models/random/philox.h"
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
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
    if (!(column.norm() > 0)) {
      sentences.push_back(fmt::format("nothing at {} shows in what is measured", sites[s].name));
      continue;
    }
    columns.emplace_back(s, column.normalized());
  }
  for (size_t a = 0; a < columns.size(); ++a)
    for (size_t b = a + 1; b < columns.size(); ++b)
      if (std::abs(columns[a].second.dot(columns[b].second)) > criteria::alike_responses)
        sentences.push_back(fmt::format("what acts at {} and what acts at {} look alike in what is measured",
                                        sites[columns[a].first].name, sites[columns[b].first].name));
  return sentences;
}

}  // namespace loopwright::diagnosis
