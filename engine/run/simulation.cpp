#include "engine/run/simulation.h"
#include <fmt/format.h>
#include <chrono>
#include <cmath>
#include "engine/run/chattering.h"
#include "engine/run/checkpoint.h"
#include "engine/run/fault_text.h"
#include "engine/run/fixed_step.h"
#include "engine/run/history_points.h"
#include "engine/run/recorder.h"
#include "engine/run/pole_check.h"
#include "engine/run/source_periods.h"
#include "engine/solve/solver.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

using Clock = std::chrono::steady_clock;

class Simulation {
 public:
  Simulation(const Plan& plan, const RunOptions& options)
      : plan_(plan),
        options_(options),
        run_(plan),
        recorder_(plan),
        chattering_(plan),
        history_points_(run_) {
    identity_ = {plan.seed, options.run};
    run_.reset(identity_);
    for (const Plan::Crossing& crossing : plan.crossings) directions_.push_back(crossing.direction);
    if (!options.resume_file.empty())
      solver_bytes_ = read_checkpoint(options.resume_file, run_, identity_, recorder_);
    if (!options.checkpoint_file.empty() && options.checkpoint_every > 0) {
      checkpoint_every_ = options.checkpoint_every;
      plan_next_checkpoint(run_.now().time);
    }
  }

  RunResult simulate() {
    const auto started = Clock::now();
    if (run_.failed())
      fail_by_fault();
    else if (options_.resume_file.empty())
      look_at_poles();
    if (result_.status == RunStatus::finished)
      is_fixed_step(plan_.method) || !plan_.steps_between_samples ? run_fixed() : run_variable();
    if (result_.status == RunStatus::finished && options_.at_stop) options_.at_stop(run_);
    result_.time = run_.now().time;
    result_.statistics.rows = recorder_.rows();
    result_.statistics.wall_seconds = std::chrono::duration<double>(Clock::now() - started).count();
    for (size_t i = 0; i < plan_.crossings.size(); ++i)
      if (chattering_.events(i) > 0)
        result_.statistics.events.push_back({chattering_.name(i), chattering_.events(i)});
    result_.recording = std::move(recorder_.recording());
    add_facts();
    return std::move(result_);
  }

 private:
  // ---- fixed step ----
  void run_fixed() {
    if (!solver_bytes_.empty()) restore(nullptr);
    const bool reached_stop = run_fixed_steps(
        run_, first_row(), [&] { recorder_.record(run_); },
        [&](bool has_row) {
          ++result_.statistics.steps;
          if (run_.failed()) return fail_by_fault();
          if (has_row && !check_finite()) return false;
          if (run_.now().time >= next_checkpoint_) checkpoint(nullptr);
          return go_on();
        });
    if (reached_stop) run_.failed() ? fail_by_fault() : check_finite();
  }
  /// The first tick, now or later, with a row; rows are counted from the start. A checkpoint does not contain
  /// the row of its tick.
  int64_t first_row() const {
    const int64_t since_start = run_.now().tick - plan_.start_tick, every = plan_.record_ticks;
    return plan_.start_tick + (since_start + every - 1) / every * every;
  }

  // ---- variable step ----
  void run_variable() {
    SolverOptions options;
    options.method = plan_.method;
    options.relative_tolerance = plan_.relative_tolerance,
    options.absolute_tolerance = plan_.absolute_tolerance;
    options.maximum_step =
        std::isfinite(plan_.maximum_step) ? plan_.maximum_step : default_maximum_step(run_);
    if (std::isfinite(options.maximum_step))  // many short steps do not mean that the solver is stuck
      options.maximum_steps_between_stops += int64_t(
          std::fmin(1e15, 10 * plan_.clock.time(plan_.stop_tick - plan_.start_tick) / options.maximum_step));
    const OdeSystem system{&run_, plan_.states, int(plan_.crossings.size()),
                           [](void* self, double t, const double* x, double* rate) {
                             return static_cast<Run<double>*>(self)->derivatives_at(t, x, rate);
                           },
                           [](void* self, double t, const double* x, double* value) {
                             return static_cast<Run<double>*>(self)->crossings_at(t, x, value);
                           }};
    Solver solver(options, system);
    next_row_ = first_row();
    run_.allow_look_ahead();
    bool has_started = !solver_bytes_.empty();
    if (has_started) restore(&solver);
    for (;;) {
      if (!is_between_ticks_) {
        if (run_.now().time >= next_checkpoint_ && has_started) checkpoint(&solver);
        if (!begin_at_tick() || run_.now().tick == plan_.stop_tick) break;
        copy_states();
        run_.reuse_signals();
        has_started ? solver.restart(run_.now().time, x_.data()) : solver.start(run_.now().time, x_.data());
      }
      has_started = true, is_between_ticks_ = false;
      const int64_t next = std::min(plan_.stop_tick, plan_.rates.empty() ? INT64_MAX : run_.next_due());
      if (!advance(solver, next) || !go_on()) break;
    }
    tell_narrow_passages(solver, options.maximum_step);
    count(solver.statistics());
    if (stiffest_state_ >= 0)
      result_.warnings.push_back(
          fmt::format("\"{}\" makes the diagram stiff: stability, not accuracy, sets the step of {}; "
                      "\"cvode-bdf\" would take longer steps",
                      block_of_state(stiffest_state_), to_name(plan_.method)));
  }
  /// Parts 1 to 4 of the step, at a tick. Returns false if the run has failed.
  bool begin_at_tick() {
    const int64_t tick = run_.now().tick;
    const uint64_t due = run_.due();
    run_.evaluate(due, true);
    run_.accept();
    if (tick >= next_row_ || tick == plan_.stop_tick) {
      recorder_.record(run_);
      next_row_ = tick + plan_.record_ticks;
      if (!check_finite()) return false;
    }
    if (run_.failed()) return fail_by_fault();
    if (tick == plan_.stop_tick) return true;
    run_.update(due);
    return !run_.failed() || fail_by_fault();
  }
  void count(const SolverStatistics& s) {
    result_.statistics.steps = s.steps,
    result_.statistics.rejected_steps = s.error_test_failures + s.convergence_failures;
    result_.statistics.derivative_evaluations = s.derivative_evaluations,
    result_.statistics.restarts = s.restarts;
    if (s.stiff) stiffest_state_ = s.stiffest_state;
  }

  /// Advances from the present tick to the next one at which something is due, through events and known
  /// discontinuities.
  bool advance(Solver& solver, int64_t next) {
    const double end = plan_.clock.time(next);
    while (solver.t() < end) {
      const double begin = solver.t(), stop = std::min(end, run_.next_stop(begin));
      const Advance step = solver.step(stop, directions_.empty() ? nullptr : directions_.data());
      if (!succeeded(step.status)) return fail_by_solver(solver, step);
      if (!record_between(solver, next, step.status == SolverStatus::stepped)) return false;
      if (!accept_step(solver, begin)) return false;  // also before a jump: a delay stores both sides of it
      if (step.status == SolverStatus::stepped) {
        checkpoint_inside(solver);
        if (!go_on()) return false;
        continue;
      }
      if (step.status == SolverStatus::reached_stop && step.t >= end) break;
      if (step.status == SolverStatus::event && !chattering_.count(step.t, solver.fired()))
        return fail_by_chattering(step.t);
      if (step.status == SolverStatus::reached_stop && !chattering_.count(step.t, {}))
        return fail(
            fmt::format("{} known discontinuities follow within {:.3g} s at t = {:g} s: is the period of a "
                        "source far too short?",
                        Chattering::most, chattering_.span(), step.t));
      handle_event(solver);
      if (run_.failed()) return fail_by_fault();
      if (!record_at_event(next)) return false;
      checkpoint_inside(solver);
      if (!go_on()) return false;
    }
    run_.look_at(end, solver.x().data());
    run_.move_to(next);
    return true;
  }
  /// Computes the signals at an event or a known discontinuity: decisions, jumps, and a restart of the
  /// solver.
  void handle_event(Solver& solver) {
    run_.look_at(solver.t(), solver.x().data());
    run_.evaluate(0, true);
    run_.accept();
    copy_states();
    run_.reuse_signals();
    solver.restart(solver.t(), x_.data());
  }
  /// Accepts the end of a step that began at `begin`, and before it as many instants inside the step as a
  /// history needs to be interpolated within the tolerance.
  bool accept_step(Solver& solver, double begin) {
    if (!run_.has_accepted_memory()) return true;
    const auto at = [&](int i, int pieces) {
      return i < pieces ? begin + (solver.t() - begin) * i / pieces : solver.t();
    };
    const int pieces = history_points_.pieces(run_, [&](int i, int n) { look_within(solver, at(i, n)); });
    for (int i = 1; i <= pieces; ++i) {
      look_within(solver, at(i, pieces));
      run_.accept();
      if (run_.failed()) return fail_by_fault();
    }
    return true;
  }
  /// Computes what accepted memory reads, at a time in the last step of the solver.
  void look_within(const Solver& solver, double time) {
    between_.resize(size_t(plan_.states));
    if (time < solver.t()) solver.interpolate(time, between_.data());
    run_.look_at(time, time < solver.t() ? between_.data() : solver.x().data());
    run_.evaluate_held();
  }
  /// If a crossing had the other sign at only one sample, others have probably been missed: reports this.
  void tell_narrow_passages(const Solver& solver, double maximum_step) {
    constexpr int64_t few = 2;
    constexpr double share = 0.05;  // of its events: rare cases say little about the steps
    for (size_t i = 0; i < plan_.crossings.size(); ++i) {
      const int64_t seen = solver.narrow_passages()[i];
      if (seen < few || double(seen) < share * double(chattering_.events(i))) continue;
      result_.warnings.push_back(fmt::format(
          "\"{}\" went through zero and back within one step of the solver, {} times that were noticed: "
          "others may have been missed; give \"solver\" a \"maximum_step\"{} below the time between its "
          "passages",
          chattering_.name(i), seen,
          std::isfinite(maximum_step) ? fmt::format(" shorter than {:.3g} s,", maximum_step) : ""));
    }
  }
  /// Records rows inside the last step, from the dense output of the solver. A row at an event or a known
  /// discontinuity that ends the step is left to record_at_event.
  bool record_between(Solver& solver, int64_t next, bool with_end) {
    const double end = solver.t();
    for (; next_row_ < next; next_row_ += plan_.record_ticks) {
      const double time = plan_.clock.time(next_row_);
      if (time > end || (!with_end && is_same_instant(time, end))) break;
      if (time < solver.step_begin()) continue;
      between_.resize(size_t(plan_.states));
      solver.interpolate(time, between_.data());
      bool is_finite = true;
      run_.look_between(time, between_.data(), [&] {
        recorder_.record(run_);
        is_finite = check_finite();
      });
      if (!is_finite) return false;
    }
    return true;
  }
  /// As at a tick, a row at a discontinuity has the signals after it.
  bool record_at_event(int64_t next) {
    const double time = plan_.clock.time(next_row_), now = run_.now().time;
    if (next_row_ >= next || !is_same_instant(time, now)) return true;
    run_.set_time(time);
    recorder_.record(run_);
    run_.set_time(now);
    next_row_ += plan_.record_ticks;
    return check_finite();
  }
  static bool is_same_instant(double row, double event) {
    return std::fabs(row - event) <= EventFinder::width(event);
  }
  void copy_states() { x_.assign(run_.states().begin(), run_.states().end()); }

  // ---- common ----
  void look_at_poles() {
    run_.evaluate(run_.due(), true);
    if (run_.failed()) {
      fail_by_fault();
      return;
    }
    const FastestPole pole = fastest_pole(run_);
    result_.statistics.largest_pole = pole.magnitude;
    for (const std::string& warning : {step_warning(plan_, pole), aliasing_warning(run_)})
      if (!warning.empty()) result_.warnings.push_back(warning);
    run_.reset(identity_);
  }
  void plan_next_checkpoint(double now) {
    const double since_start = now - plan_.clock.time(plan_.start_tick);
    next_checkpoint_ = plan_.clock.time(plan_.start_tick) +
                       (std::floor(since_start / checkpoint_every_ + 1e-9) + 1) * checkpoint_every_;
  }
  /// `solver`: null for a fixed-step method.
  void checkpoint(Solver* solver) {
    StateArchive state;
    archive(state, solver);
    write_checkpoint(options_.checkpoint_file, run_, identity_, state.bytes(), recorder_);
    plan_next_checkpoint(run_.now().time);
  }
  /// Checkpoint between ticks. It changes nothing: if the solver cannot be archived here, the checkpoint is
  /// written later.
  void checkpoint_inside(Solver& solver) {
    if (solver.t() < next_checkpoint_ || !solver.can_be_archived()) return;
    run_.set_time(solver.t());
    is_between_ticks_ = true;
    checkpoint(&solver);
    is_between_ticks_ = false;
  }
  void restore(Solver* solver) {
    StateArchive state(solver_bytes_);
    archive(state, solver);
    if (state.is_whole()) return;
    Problems problems;
    problems.error({}, "", "", options_.resume_file + ": the checkpoint is damaged").hint =
        "start the run anew";
    throw InputError(std::move(problems));
  }
  void archive(StateArchive& a, Solver* solver) {
    a.members(result_.statistics.steps, next_row_, is_between_ticks_);
    chattering_.archive(a);
    if (solver) solver->archive(a);
  }
  bool go_on() {
    if (options_.interrupt && options_.interrupt->load(std::memory_order_relaxed)) {
      result_.status = RunStatus::interrupted;
      result_.message = fmt::format("interrupted at t = {:g} s", run_.now().time);
      return false;
    }
    if (options_.progress && (++since_progress_ & 1023) == 0)
      options_.progress(run_.now().time, plan_.clock.time(plan_.stop_tick));
    return true;
  }
  std::string block_of_state(int state) const {
    return state < 0 ? "the diagram" : plan_.blocks[size_t(plan_.block_of_state[size_t(state)])].path;
  }
  bool fail(std::string message) {
    result_.status = RunStatus::failed;
    result_.message = std::move(message);
    return false;
  }
  bool fail_by_fault() { return fail(fault_text(plan_, run_.fault(), run_.now().time)); }
  bool fail_by_solver(const Solver& solver, const Advance& step) {
    if (step.status == SolverStatus::block_fault && run_.fault().block >= 0) return fail_by_fault();
    run_.set_time(step.t);
    return fail(fmt::format("{} stopped at t = {:g} s: {}; the largest error stood in \"{}\"",
                            to_name(plan_.method), step.t, to_text(step.status),
                            block_of_state(solver.worst_state())));
  }
  bool fail_by_chattering(double t) {
    run_.set_time(t);
    return fail(
        fmt::format("chattering: \"{}\" went through zero {} times within {:.3g} s at t = {:g} s; give the "
                    "block hysteresis, smooth the switch, or give it a sample_time",
                    chattering_.name(chattering_.worst()), Chattering::most, chattering_.span(), t));
  }
  /// Every logged signal and state must be finite; otherwise the first block in order with a non-finite value
  /// is named.
  bool check_finite() {
    bool finite = recorder_.first_non_finite() < 0;
    for (double x : run_.states()) finite &= std::isfinite(x);
    if (finite) return true;
    std::string culprit;
    for (const Plan::Entry& entry : plan_.order) {
      if (entry.kind != Plan::Entry::Kind::outputs || !culprit.empty()) continue;
      const Plan::Block& block = plan_.blocks[size_t(entry.block)];
      for (size_t o = 0; o < block.outputs.size(); ++o)
        if (!std::isfinite(run_.number(block.outputs[o])))
          culprit = fmt::format("{}.{}", block.path, block.type->info.outputs[o].name);
    }
    for (int i = 0; i < plan_.states && culprit.empty(); ++i)
      if (!std::isfinite(run_.states()[size_t(i)])) culprit = block_of_state(i);
    if (culprit.empty()) culprit = plan_.log[size_t(recorder_.first_non_finite())].name;
    return fail(
        fmt::format("the run diverged: \"{}\" became non-finite at t = {:g} s", culprit, run_.now().time));
  }
  void add_facts() {
    auto& facts = result_.recording.facts;
    facts.emplace_back("title", plan_.title);
    for (auto& fact : plan_.identity.facts()) facts.push_back(std::move(fact));
    facts.emplace_back("seed", fmt::format("{}", identity_.seed));
    if (identity_.run) facts.emplace_back("run", fmt::format("{}", identity_.run));
    if (result_.status != RunStatus::finished) facts.emplace_back("incomplete", result_.message);
    for (const auto& [name, value] : plan_.parameters) facts.emplace_back("parameter " + name, value);
  }

  const Plan& plan_;
  const RunOptions& options_;
  Run<double> run_;
  Recorder recorder_;
  Chattering chattering_;
  HistoryPoints history_points_;
  RunIdentity identity_;
  RunResult result_;
  std::vector<Crossing> directions_;
  std::vector<double> x_, between_;
  std::string solver_bytes_;                                  // from the checkpoint to resume
  double checkpoint_every_ = 0, next_checkpoint_ = infinity;  // s
  int64_t next_row_ = 0;
  bool is_between_ticks_ = false;  // at the time of the checkpoint
  int stiffest_state_ = -1;        // at the first detection of stiffness; -1: none
  uint32_t since_progress_ = 0;
};

}  // namespace

RunResult simulate(const Plan& plan, const RunOptions& options) {
  return Simulation(plan, options).simulate();
}

}  // namespace loopwright
