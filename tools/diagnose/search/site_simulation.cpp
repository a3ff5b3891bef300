#include "tools/diagnose/search/site_simulation.h"
#include <cmath>

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

}  // namespace loopwright::diagnosis
