#include "tools/deploy/replay.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include "hw/realtime/deploy.h"
#include "hw/realtime/log_columns.h"

namespace loopwright {
namespace {

/// The inputs of the replay: the columns of one axis.
struct Measured {
  const Column* position = nullptr;
  const Column* velocity = nullptr;  // of the device; null if the block computes it
};

/// A column of the log that the replay also computes.
struct Computed {
  const Column* logged;
  Number number;
};

const Column* find(const Recording& log, const std::string& name, Problems& problems) {
  if (const Column* column = log.find(name)) return column;
  auto& p =
      problems.error({}, "", "", fmt::format("the log has no column \"{}\", which the replay needs", name));
  p.hint = "a log of loopwright deploy, of this diagram, with the same --variant and --set";
  return nullptr;
}

std::vector<Measured> measured_columns(const hw::Hardware& hardware, const Recording& log,
                                       Problems& problems) {
  std::vector<Measured> measured;
  for (const hw::Axis& axis : hardware.axes) {
    Measured columns{find(log, axis.path + ".position", problems), nullptr};
    if (axis.io->velocity_channel >= 0) columns.velocity = find(log, axis.path + ".velocity", problems);
    measured.push_back(columns);
  }
  return measured;
}

/// The origin stored in the log must match the plan. A log without these facts has lost them, or comes from a
/// version that did not write them; then only its values can be compared.
void compare_origin(const Plan& plan, const Recording& log, Replay& result, Problems& problems) {
  const Identity before = identity_of(log.facts);
  if (before.structure.empty()) return;
  for (const std::string& change : changes(before, plan.identity))
    problems.error({}, "", "", "the log was made by something else: " + change).hint =
        "a replay needs the diagram, --set, --variant and files of the deployment";
  if (before.build != plan.identity.build)
    result.other_build =
        fmt::format("the log was made by another build of the program ({}, here {}): bits may differ",
                    before.build, plan.identity.build);
}

bool equal_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

void compare(double logged, double computed, int64_t row, double time, ReplayedColumn& to) {
  if (equal_bits(logged, computed)) return;
  if (to.differing++ == 0) to.first_row = row, to.first_time = time;
  to.largest = std::max(to.largest, std::abs(logged - computed));
}

/// Instants without a row before this row, as counted by the loop; 0 in logs that do not state it.
int64_t missing_before(const Column* lost, size_t row, const hw::PeriodStepper& stepper) {
  const double instants = lost && row > 0 ? lost->values[row] : 0;
  if (!(instants >= 0) || instants > hw::longest_gap || instants != std::floor(instants)) return 0;
  return stepper.ends_within(int64_t(instants)) ? 0 : int64_t(instants);
}

}  // namespace

bool Replay::explains() const {
  return fault.empty() && rows > 0 &&
         std::ranges::all_of(columns, [](const ReplayedColumn& c) { return c.differing == 0; });
}

Replay replay(const Plan& plan, const hw::Hardware& hardware, const Recording& log, Problems& problems) {
  Replay result;
  const Column* time = find(log, "time", problems);
  const auto measured = measured_columns(hardware, log, problems);
  std::vector<Computed> computed;
  for (const hw::LogColumn& column : hw::log_columns(plan, hardware))
    if (column.kind == hw::LogColumn::Kind::signal)
      if (const Column* logged = find(log, column.name, problems)) {
        computed.push_back({logged, column.number});
        result.columns.push_back({column.name, column.unit});
      }
  compare_origin(plan, log, result, problems);
  if (problems.has_errors()) return result;

  const Column* lost = log.find(hw::lost_column);
  hw::PeriodStepper stepper(plan, hardware);
  for (size_t row = 0; row < log.rows(); ++row) {
    const int64_t missing = missing_before(lost, row, stepper);
    const double now = plan.clock.time(stepper.run().now().tick + missing * hardware.period_ticks);
    if (!equal_bits(time->values[row], now)) {
      result.fault = fmt::format("the log has a hole: row {} is at {:g} s, and should be at {:g} s", row + 1,
                                 time->values[row], now);
      return result;
    }
    for (size_t a = 0; a < measured.size(); ++a)
      stepper.measure(a, measured[a].position->values[row],
                      measured[a].velocity ? measured[a].velocity->values[row] : 0);
    stepper.compute(missing, [](int) {});
    if (stepper.run().failed()) {
      result.fault = stepper.fault();
      return result;
    }
    for (size_t c = 0; c < computed.size(); ++c)
      compare(computed[c].logged->values[row], stepper.run().number(computed[c].number), int64_t(row), now,
              result.columns[c]);
    stepper.finish();
    ++result.rows;
  }
  return result;
}

std::string to_text(const Replay& replay) {
  std::string text;
  if (!replay.other_build.empty()) text += "warning: " + replay.other_build + "\n";
  for (const ReplayedColumn& column : replay.columns)
    text +=
        column.differing == 0
            ? fmt::format("  {}: equal in every bit\n", column.name)
            : fmt::format("  {}: {} of {} rows differ, first at {:g} s, by at most {:.3g} {}\n", column.name,
                          column.differing, replay.rows, column.first_time, column.largest, column.unit);
  if (!replay.fault.empty()) text += replay.fault + "\n";
  return text + fmt::format("{} rows: the log and the plan {} each other\n", replay.rows,
                            replay.explains() ? "explain" : "do not explain");
}

}  // namespace loopwright
