#include "tools/diagnose/record/doubts_about_time.h"
#include "tools/experiment/experiment_ports.h"

namespace loopwright::diagnosis {

std::vector<RecordFinding> doubts_about_time(const std::string& diagram,
                                             const std::vector<std::string>& experiments,
                                             const LoadOptions& options, bool is_axis) {
  Problems problems;
  for (const std::string& path : experiments) {
    const auto experiment = load_experiment(path, problems);
    const auto loaded =
        experiment ? load_diagram(diagram, with_own_values(*experiment, options), problems) : nullptr;
    if (const auto plan = loaded ? compile(*loaded, problems) : nullptr)
      check_unit_of_time(*plan, *experiment, problems);
  }
  std::vector<RecordFinding> findings;
  Problems doubts;
  for (Problem problem : problems.list()) {
    if (problem.severity != Problem::Severity::warning || problem.pointer != time_of_rows) continue;
    findings.push_back({problem.message, problem.hint, false, false});
    problem.severity = Problem::Severity::error;
    doubts.add(std::move(problem));
  }
  if (is_axis && doubts.has_errors()) throw InputError(std::move(doubts));
  return findings;
}

}  // namespace loopwright::diagnosis
