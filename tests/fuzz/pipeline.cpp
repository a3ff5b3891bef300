#include "tests/fuzz/pipeline.h"
#include <gtest/gtest.h>
#include <algorithm>
#include <atomic>
#include <span>
#include "tools/compare/compare.h"

namespace loopwright::fuzz {

void expect_helpful(const Problems& problems, const std::string& what) {
  EXPECT_TRUE(problems.has_errors()) << "refused without an error\n" << what;
  EXPECT_FALSE(problems.text().empty()) << what;
  for (const Problem& problem :
       std::span(problems.list()).first(std::min<size_t>(problems.list().size(), 50))) {
    EXPECT_FALSE(problem.message.empty()) << what;
    ASSERT_TRUE(problem.place.file) << "no place: " << to_string(problem) << "\n" << what;
    EXPECT_LE(problem.place.offset, problem.place.file->text.size()) << to_string(problem) << "\n" << what;
    const LineColumn at = line_column(problem.place);
    EXPECT_TRUE(at.line >= 1 && at.column >= 1) << to_string(problem) << "\n" << what;
  }
}

namespace {

Outcome outcome_of(const RunResult& result, const std::string& what) {
  const Recording& recording = result.recording;
  EXPECT_FALSE(recording.columns.empty()) << what;
  for (const Column& column : recording.columns)
    EXPECT_EQ(column.values.size(), recording.rows()) << column.name << "\n" << what;
  EXPECT_EQ(result.message.empty(), result.status == RunStatus::finished) << result.message << "\n" << what;
  if (result.status == RunStatus::interrupted) return Outcome::cut_short;
  return result.status == RunStatus::failed ? Outcome::failed : Outcome::finished;
}

/// Ends a run at its first progress call, which comes after 1024 steps.
RunResult run_shortly(const Plan& plan) {
  std::atomic<bool> interrupt = false;
  RunOptions options;
  options.interrupt = &interrupt;
  options.progress = [&](double, double) { interrupt = true; };
  return simulate(plan, options);
}

/// The same plan with a near end: 300 steps, samples or rows away.
Plan shortened(const Plan& plan) {
  Plan short_plan = plan;
  int64_t step = plan.record_ticks;
  if (is_fixed_step(plan.method)) step = std::min(step, plan.step_ticks);
  for (const Rate& rate : plan.rates) step = std::min(step, rate.period);
  if (step < (plan.stop_tick - plan.start_tick) / 300) short_plan.stop_tick = plan.start_tick + 300 * step;
  return short_plan;
}

}  // namespace

Outcome run_diagram(const std::string& path, const std::string& what) {
  try {
    Problems problems;
    const auto diagram = load_diagram(path, {}, problems);
    const auto plan = diagram ? compile(*diagram, problems) : nullptr;
    if (!plan || problems.has_errors()) {
      expect_helpful(problems, what);
      return Outcome::refused;
    }
    EXPECT_FALSE(describe(*plan).empty()) << what;
    return outcome_of(run_shortly(shortened(*plan)), what);
  } catch (const InputError& error) {
    EXPECT_TRUE(error.problems.has_errors()) << what;
  } catch (const std::exception& error) {
    ADD_FAILURE() << "an exception got out: " << error.what() << "\n" << what;
  }
  return Outcome::refused;
}

Outcome compare_experiment(const std::string& diagram, const std::string& experiment,
                           const std::string& what) {
  std::atomic<bool> interrupt = false;
  RunOptions options;
  options.interrupt = &interrupt;
  options.progress = [&](double, double) { interrupt = true; };
  try {
    const Comparison comparison = compare(diagram, experiment, {}, options);
    EXPECT_FALSE(to_json(comparison).empty()) << what;
    EXPECT_FALSE(to_text(comparison).empty()) << what;
    for (const ComparedSignal& signal : comparison.signals) {
      EXPECT_EQ(signal.measured.size(), comparison.time.size()) << what;
      EXPECT_EQ(signal.error.size(), comparison.time.size()) << what;
    }
    return outcome_of(comparison.run, what);
  } catch (const InputError& error) {
    expect_helpful(error.problems, what);
  } catch (const std::exception& error) {
    ADD_FAILURE() << "an exception got out: " << error.what() << "\n" << what;
  }
  return Outcome::refused;
}

}  // namespace loopwright::fuzz
