#include "tools/stability/kick.h"
#include <algorithm>
#include <cmath>
#include "engine/run/require_finished.h"
#include "tools/linearize/changed_diagram.h"

namespace loopwright {
namespace {

std::vector<double> positions(Diagram diagram, const std::string& position, const RunOptions& options,
                              Problems& problems, std::vector<double>& time) {
  diagram.log = {{position, {}}};
  const auto plan = problems.has_errors() ? nullptr : compile(diagram, problems);
  if (!plan) throw InputError(std::move(problems));
  RunResult result = simulate(*plan, options);
  require_finished(result);
  time = result.recording.columns[0].values;
  return std::move(result.recording.columns[1].values);
}

}  // namespace

KickTest kick(const Diagram& diagram, const std::string& port, const std::string& position, double size,
              double duration, double floor, const RunOptions& options) {
  const double start = diagram.solver.start.value, stop = diagram.solver.stop.value;
  const double step = diagram.solver.step.is_given ? diagram.solver.step.value : 1e-3;
  const double at = std::round(0.5 * (start + stop) / step) * step;
  const BlockEntry pulse = block_with(
      "kick", "PulseTrain", {{"period", 2 * (stop + 1)}, {"width", duration}, {"start", at}, {"high", size}});
  Problems problems;
  KickTest test;
  const Diagram kicked = with_added_signal(diagram, port, pulse, problems);
  const std::vector<double> quiet = positions(diagram, position, options, problems, test.time),
                            moved = positions(kicked, position, options, problems, test.time);
  const double late = stop - 0.1 * (stop - at);
  for (size_t i = 0; i < std::min(quiet.size(), moved.size()); ++i) {
    test.difference.push_back(moved[i] - quiet[i]);
    test.peak = std::max(test.peak, std::abs(test.difference[i]));
    if (test.time[i] >= late) test.rest = std::max(test.rest, std::abs(test.difference[i]));
  }
  test.tolerance = std::max(1e-3 * test.peak, floor);
  test.decays = test.peak > 0 && test.rest <= test.tolerance;
  return test;
}

}  // namespace loopwright
