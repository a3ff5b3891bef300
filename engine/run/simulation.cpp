#include "engine/run/simulation.h"
#include <fmt/format.h>
#include <chrono>
#include <cmath>
#include "engine/run/chattering.h"
#include "engine/run/checkpoint.h"
#include "engine/run/fixed_step.h"
#include "engine/run/recorder.h"
#include "engine/run/pole_check.h"
#include "engine/solve/solver.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

using Clock = std::chrono::steady_clock;

class Simulation {
 public:
  Simulation(const Plan& plan, const RunOptions& options)
      : plan_(plan), options_(options), run_(plan), recorder_(plan), chattering_(plan) {
    identity_ = {plan.seed, options.run};
    run_.reset(identity_);
    for (const Plan::Crossing& crossing : plan.crossings) directions_.push_back(crossing.direction);
    if (options.checkpoint_every > 0)
      checkpoint_ticks_ =
          whole_between<int64_t>(std::round(options.checkpoint_every / plan.clock.base.value()), 1, INT64_MAX / 2);
    if (!options.resume_file.empty()) read_checkpoint(options.resume_file, run_, identity_, recorder_);
  }

  RunResult simulate() {
    const auto started = Clock::now();
    if (run_.failed())
      fail_by_fault();
    else if (options_.resume_file.empty())
      look_at_poles();
    if (result_.status == RunStatus::finished)
      is_fixed_step(plan_.method) || plan_.states == 0 ? run_fixed() : run_variable();
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
    int64_t next_checkpoint = next_multiple(checkpoint_ticks_);
    const bool reached_stop = run_fixed_steps(
        run_, first_row(), [&] { return next_checkpoint; }, [&] { recorder_.record(run_); },
        [&](bool was_row) {
          ++result_.statistics.steps;
          if (run_.failed()) return fail_by_fault();
          if (was_row && !check_finite()) return false;
          if (run_.now().tick == next_checkpoint) checkpoint(), next_checkpoint += checkpoint_ticks_;
          return go_on();
        });
    if (reached_stop) run_.failed() ? fail_by_fault() : check_finite();
  }
  int64_t next_multiple(int64_t ticks) const {
    if (ticks <= 0) return INT64_MAX;
    return (run_.now().tick / ticks + 1) * ticks;
  }
  /// The first tick, now or later, that has a row: rows are counted from the start. A checkpoint holds no row
  /// of its tick.
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
    options.maximum_step = plan_.maximum_step;
    const OdeSystem system{&run_, plan_.states, int(plan_.crossings.size()),
                           [](void* self, double t, const double* x, double* rate) {
                             return static_cast<Run<double>*>(self)->derivatives_at(t, x, rate);
                           },
                           [](void* self, double t, const double* x, double* value) {
                             return static_cast<Run<double>*>(self)->crossings_at(t, x, value);
                           }};
    Solver solver(options, system);
    int64_t next_checkpoint = next_multiple(checkpoint_ticks_);
    next_row_ = first_row();
    bool fresh = true;
    for (;;) {
      const int64_t tick = run_.now().tick;
      if (tick == next_checkpoint) {
        checkpoint();
        next_checkpoint += checkpoint_ticks_;
        fresh = true;  // so that a run resumed here takes the very same steps
      }
      const uint64_t due = run_.due();
      run_.evaluate(due, true);
      run_.accept();
      if (tick >= next_row_ || tick == plan_.stop_tick) {
        recorder_.record(run_);
        next_row_ = tick + plan_.record_ticks;
        if (!check_finite()) break;
      }
      if (run_.failed()) {
        fail_by_fault();
        break;
      }
      if (tick == plan_.stop_tick) break;
      run_.update(due);
      if (run_.failed()) {
        fail_by_fault();
        break;
      }
      const int64_t next =
          std::min({plan_.stop_tick, next_checkpoint, plan_.rates.empty() ? INT64_MAX : run_.next_due()});
      copy_states();
      if (fresh)
        count(solver.statistics()), solver.start(run_.now().time, x_.data());
      else
        solver.restart(run_.now().time, x_.data());
      fresh = false;
      if (!advance(solver, next) || !go_on()) break;
    }
    count(solver.statistics());
    if (stiffest_state_ >= 0)
      result_.warnings.push_back(
          fmt::format("\"{}\" makes the diagram stiff: stability, not accuracy, sets the step of {}; "
                      "\"cvode-bdf\" would take longer steps",
                      block_of_state(stiffest_state_), to_name(plan_.method)));
  }
  /// Adds what a solver did since its start, which forgets it.
  void count(const SolverStatistics& s) {
    result_.statistics.steps += s.steps,
        result_.statistics.rejected_steps += s.error_test_failures + s.convergence_failures;
    result_.statistics.derivative_evaluations += s.derivative_evaluations,
        result_.statistics.restarts += s.restarts;
    if (s.stiff && stiffest_state_ < 0) stiffest_state_ = s.stiffest_state;
  }

  /// From the present tick to the next at which something is due, over events and known discontinuities.
  bool advance(Solver& solver, int64_t next) {
    const double end = plan_.clock.time(next);
    while (solver.t() < end) {
      const double stop = std::min(end, run_.next_stop(solver.t()));
      const Advance step = solver.step(stop, directions_.empty() ? nullptr : directions_.data());
      if (!succeeded(step.status)) return fail_by_solver(solver, step);
      if (!record_between(solver, next)) return false;
      if (!accept_at(solver)) return false;  // before a jump too: a delay keeps both sides of it
      if (step.status == SolverStatus::stepped) {
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
      if (!go_on()) return false;
    }
    run_.look_at(end, solver.x().data());
    run_.move_to(next);
    return true;
  }
  /// Signals at an event or a known discontinuity: decisions, jumps, and the solver starts anew from there.
  void handle_event(Solver& solver) {
    run_.look_at(solver.t(), solver.x().data());
    run_.evaluate(0, true);
    run_.accept();
    copy_states();
    solver.restart(solver.t(), x_.data());
  }
  bool accept_at(Solver& solver) {
    if (!run_.has_accepted_memory()) return true;
    run_.look_at(solver.t(), solver.x().data());
    run_.evaluate_held(false);
    run_.accept();
    return !run_.failed() || fail_by_fault();
  }
  /// Rows that fall inside the last step, from the solver's dense output.
  bool record_between(Solver& solver, int64_t next) {
    for (; next_row_ < next && plan_.clock.time(next_row_) <= solver.t(); next_row_ += plan_.record_ticks) {
      const double time = plan_.clock.time(next_row_);
      if (time < solver.step_begin()) continue;
      between_.resize(size_t(plan_.states));
      solver.interpolate(time, between_.data());
      run_.look_at(time, between_.data());
      run_.evaluate_held(true);
      recorder_.record(run_);
      if (!check_finite()) return false;
    }
    return true;
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
    if (const std::string warning = step_warning(plan_, pole); !warning.empty())
      result_.warnings.push_back(warning);
    run_.reset(identity_);
  }
  void checkpoint() {
    if (!options_.checkpoint_file.empty())
      write_checkpoint(options_.checkpoint_file, run_, identity_, recorder_);
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
  bool fail_by_fault() {
    const FaultReport& fault = run_.fault();
    return fail(fmt::format("\"{}\" stopped the run at t = {:g} s: {}",
                            fault.block < 0 ? "?" : plan_.blocks[size_t(fault.block)].path, run_.now().time,
                            fault.reason));
  }
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
  /// Every logged signal and state must be a number; if not, the first block in order that is to blame is
  /// named.
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
    return fail(fmt::format("the run diverged: \"{}\" is no finite number any more at t = {:g} s", culprit,
                            run_.now().time));
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
  RunIdentity identity_;
  RunResult result_;
  std::vector<Crossing> directions_;
  std::vector<double> x_, between_;
  int64_t checkpoint_ticks_ = 0, next_row_ = 0;
  int stiffest_state_ = -1;  // the first that made the solver stiff; -1: none
  uint32_t since_progress_ = 0;
};

}  // namespace

RunResult simulate(const Plan& plan, const RunOptions& options) {
  return Simulation(plan, options).simulate();
}

}  // namespace loopwright
