#include "tools/deploy/replay.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include "hw/device/output.h"
#include "hw/realtime/deploy.h"
#include "hw/realtime/log_columns.h"

namespace loopwright {
namespace {

/// The inputs of the replay: the columns of one axis.
struct Measured {
  const Column* position = nullptr;
  const Column* velocity = nullptr;  // of the device; null if the block computes it
};

/// A column of the log that the replay also computes: a signal of the plan, or what the device applied.
struct Computed {
  const Column* logged;
  Number number;  // of the signal; of an applied output -1
  size_t output = 0;
};

/// The outputs of the device, as IoDevice::write() applies them.
class AppliedOutputs {
 public:
  explicit AppliedOutputs(const hw::Hardware& hardware) : hardware_(hardware) {
    for (const hw::OutputChannel& output : hardware.device->outputs) values_.push_back(output.initial);
  }
  void write(const hw::PeriodStepper& stepper) {
    bool is_finite = true;
    for (size_t a = 0; a < hardware_.axes.size(); ++a) is_finite &= std::isfinite(stepper.command(a));
    for (size_t a = 0; a < hardware_.axes.size(); ++a) {
      const auto i = size_t(hardware_.axes[a].io->command_channel);
      const hw::OutputChannel& output = hardware_.device->outputs[i];
      values_[i] = is_finite ? hw::limited(output, stepper.command(a), values_[i], hardware_.period_s).value
                             : output.safe;
    }
  }
  double operator[](size_t output) const { return values_[output]; }

 private:
  const hw::Hardware& hardware_;
  std::vector<double> values_;
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

const std::string* fact(const Recording& log, std::string_view name) {
  for (const auto& [key, value] : log.facts)
    if (key == name) return &value;
  return nullptr;
}

/// The columns that the replay computes. What it cannot compute is listed in `result.taken`.
std::vector<Computed> computed_columns(const Plan& plan, const hw::Hardware& hardware, const Recording& log,
                                       const std::vector<Measured>& measured, Replay& result,
                                       Problems& problems) {
  using Kind = hw::LogColumn::Kind;
  std::vector<Computed> computed;
  std::vector<const Column*> verified{log.find("time"), log.find(hw::lost_column)};
  for (const hw::LogColumn& column : hw::log_columns(plan, hardware)) {
    if (column.kind != Kind::signal && column.kind != Kind::applied) continue;
    const Column* const logged = find(log, column.name, problems);
    const bool is_measured = std::ranges::any_of(
        measured, [&](const Measured& m) { return logged == m.position || logged == m.velocity; });
    if (!logged || is_measured) continue;
    computed.push_back({logged, column.kind == Kind::signal ? column.number : -1, column.output});
    result.columns.push_back({column.name, column.unit});
    verified.push_back(logged);
  }
  for (const Column& column : log.columns)
    if (std::ranges::find(verified, &column) == verified.end()) result.taken.push_back(column.name);
  if (fact(log, "outputs_safe")) result.taken.push_back("outputs_safe");
  return computed;
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

/// Why this row cannot come now; empty: it can.
std::string misplaced(double time, double now, const Column* lost, int64_t missing, size_t row,
                      const hw::PeriodStepper& stepper) {
  if (!equal_bits(time, now))
    return fmt::format("the log has a hole: row {} is at {:g} s, and should be at {:g} s", row + 1, time,
                       now);
  if (lost && lost->values[row] != double(missing))
    return fmt::format("row {}: {} is {:g}, and its time is {} instants after the row before", row + 1,
                       hw::lost_column, lost->values[row], missing + 1);
  if (stepper.run().now().tick > stepper.run().plan().stop_tick)
    return fmt::format("row {} at {:g} s is after the end of the run", row + 1, now);
  return {};
}

/// Compares the end of the log with what it promises: the number of its rows, or else the end of the run.
std::string missing_at_end(const Recording& log, const hw::PeriodStepper& stepper) {
  const Plan& plan = stepper.run().plan();
  const std::string last =
      log.rows() == 0 ? "the log has no rows"
                      : fmt::format("rows after {:g} s are missing", log.find("time")->values.back());
  if (const std::string* rows = fact(log, "rows")) {
    if (*rows == fmt::format("{}", log.rows())) return {};
    return fmt::format("{}: the log states {} rows and has {}", last, *rows, log.rows());
  }
  const bool is_whole = stepper.run().now().tick > plan.stop_tick;
  if (is_whole || fact(log, "incomplete")) return {};
  return fmt::format("{}: the run ends at {:g} s, and the log does not state that it ended before", last,
                     plan.clock.time(plan.stop_tick));
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
  const auto computed = computed_columns(plan, hardware, log, measured, result, problems);
  if (const std::string* reason = fact(log, "incomplete")) result.incomplete = *reason;
  compare_origin(plan, log, result, problems);
  if (problems.has_errors()) return result;

  const Column* lost = log.find(hw::lost_column);
  hw::PeriodStepper stepper(plan, hardware);
  AppliedOutputs applied(hardware);
  for (size_t row = 0; row < log.rows(); ++row) {
    const int64_t missing = missing_before(lost, row, stepper);
    const double now = plan.clock.time(stepper.run().now().tick + missing * hardware.period_ticks);
    result.fault = misplaced(time->values[row], now, lost, missing, row, stepper);
    if (!result.fault.empty()) return result;
    for (size_t a = 0; a < measured.size(); ++a)
      stepper.measure(a, measured[a].position->values[row],
                      measured[a].velocity ? measured[a].velocity->values[row] : 0);
    stepper.compute(missing, [](int) {});
    if (stepper.run().failed()) {
      result.fault = stepper.fault();
      return result;
    }
    applied.write(stepper);
    for (size_t c = 0; c < computed.size(); ++c) {
      const auto& [logged, number, output] = computed[c];
      compare(logged->values[row], number < 0 ? applied[output] : stepper.run().number(number), int64_t(row),
              now, result.columns[c]);
    }
    stepper.finish();
    ++result.rows;
  }
  result.fault = missing_at_end(log, stepper);
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
  if (!replay.taken.empty())
    text += fmt::format("  taken from the log, not verified: {}\n", fmt::join(replay.taken, ", "));
  if (!replay.incomplete.empty())
    text += fmt::format("the log states that it is incomplete: {}\n", replay.incomplete);
  if (!replay.fault.empty()) text += replay.fault + "\n";
  return text + fmt::format("{} rows: the log and the plan {} each other\n", replay.rows,
                            replay.explains() ? "explain" : "do not explain");
}

}  // namespace loopwright
