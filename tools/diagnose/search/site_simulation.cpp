#include "tools/diagnose/search/site_simulation.h"
#include <cmath>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {

std::optional<SimulationErrors> simulation_errors(SiteFitter& fitter, const SiteHypothesis& h) {
  fitter.model().use(h.factors, h.terms);
  const SignalRecord& record = fitter.model().record();
  const size_t outputs = record.outputs.size(), rows = record.rows();
  SimulationErrors errors;
  for (const bool held_out : {false, true}) {
    const size_t begin = held_out ? record.held_out_from : 0, end = held_out ? rows : record.held_out_from;
    if (begin == end) continue;
    std::vector<double> squares(outputs), readings(outputs), e;
    for (size_t from = begin, to = begin; from < end; from = to) {
      do ++to;
      while (to < end && !record.begins_at(to));
      e.resize((to - from) * outputs);
      if (!fitter.filter().simulate_freely(from, to, e)) return {};
      for (size_t i = 0; i < e.size(); ++i)
        if (!std::isnan(e[i])) squares[i % outputs] += e[i] * e[i], ++readings[i % outputs];
    }
    std::vector<double>& list = held_out ? errors.held_out : errors.fitted;
    for (size_t j = 0; j < outputs; ++j) list.push_back(std::sqrt(squares[j] / std::max(1.0, readings[j])));
  }
  return errors;
}

bool forgets_its_start(SiteFitter& fitter, SiteHypothesis h) {
  SitePass pass;
  if (!fitter.pass(h, false, pass)) return true;
  const auto count = Eigen::Index(fitter.model().states()), all = Eigen::Index(pass.states);
  const Eigen::Map<const Eigen::MatrixXd> path(pass.filtered.data(), all, Eigen::Index(pass.rows));
  Eigen::VectorXd size = path.topRows(count).rowwise().norm() / std::sqrt(double(pass.rows));
  for (double& s : size)
    if (!(s > 0)) s = 1;
  Eigen::MatrixXd growth;
  for (size_t row = 0; row < pass.rows; ++row) {
    if (fitter.model().record().begins_at(row)) growth = size.asDiagonal();
    const Eigen::Map<const Eigen::MatrixXd> A(&pass.A[row * size_t(all * all)], all, all);
    growth = (A.topLeftCorner(count, count) * growth).eval();
    if (!((size.cwiseInverse().asDiagonal() * growth).norm() < criteria::most_growth)) return true;
  }
  return false;
}

}  // namespace loopwright::diagnosis
