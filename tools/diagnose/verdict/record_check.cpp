/// Faults of a record and missing excitation, with their consequences.
#include <fmt/format.h>
#include "tools/compare/excitation.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/verdict/verdict.h"

namespace loopwright::diagnosis {

std::optional<RecordFinding> too_few_rows(const Trials& trials) {
  const size_t rows = fitted_numbers(trials) / trials.ports();
  if (trials.has_map() || double(rows) >= criteria::least_rows) return {};
  size_t all = 0;
  for (const Trial& trial : trials.list) all += trial.held_out_from;
  return RecordFinding{
      fmt::format("of {} rows that may be fitted, {} count", all, rows),
      fmt::format("no verdict rests on fewer than {}: record faster, longer, or with longer ways between "
                  "reversals; rows at rest and just after a rest or a reversal do not count",
                  criteria::least_rows),
      true};
}

std::vector<RecordFinding> look_at_records(const Trials& trials,
                                           const std::vector<InverseDynamics>& inverse) {
  std::vector<RecordFinding> findings;
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const AxisModel& model = *trials.list[t].model;
    Machine machine;
    machine.motion = inverse[t].motion, machine.mass = model.nominal_inertia();
    ForceResidual residual;
    residual.value = residual_with(trials.list[t], inverse[t], {});
    const MeasuredPort* position = model.record().find("position");
    const RecordContent content = content_of(machine, residual, position ? position->resolution : 0);
    const std::string of = trials.list.size() > 1 ? fmt::format("record {}: ", t + 1) : "";
    for (const RecordFault& fault : faults_of(machine, residual, content)) {
      if (trials.has_map() && fault.name != "one_direction") continue;  // a map has no times and no speeds
      findings.push_back({of + fault.text, fault.cost, fault.is_fatal, fault.may_be_physics});
    }
  }
  return findings;
}

}  // namespace loopwright::diagnosis
