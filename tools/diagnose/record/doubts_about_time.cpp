#include "tools/diagnose/record/doubts_about_time.h"
#include "tools/experiment/experiment_ports.h"

namespace loopwright::diagnosis {

std::vector<RecordFinding> doubts_about_time(const std::string& diagram,
                                             const std::vector<std::string>& experiments,
                                             const LoadOptions& options, bool is_axis) {
  Problems problems, doubts;
  bool are_far_apart = false;
  for (const std::string& path : experiments) {
    const auto experiment = load_experiment(path, problems);
    const auto loaded =
        experiment ? load_diagram(diagram, with_own_values(*experiment, options), problems) : nullptr;
    if (const auto plan = loaded ? compile(*loaded, problems) : nullptr)
      are_far_apart |= check_unit_of_time(*plan, *experiment, doubts);
  }
  Problems errors;
  for (Problem problem : doubts.list()) {
    problem.severity = Problem::Severity::error;
    errors.add(std::move(problem));
  }
  if (is_axis && are_far_apart) throw InputError(std::move(errors));
  problems.add(doubts);
  std::vector<RecordFinding> findings;
  for (const Problem& problem : problems.list())
    if (problem.severity == Problem::Severity::warning && problem.pointer == time_of_rows)
      findings.push_back({problem.message, problem.hint, false, false});
  return findings;
}

}  // namespace loopwright::diagnosis
