/// A run: all mutable numbers of one simulation in one arena. Run<double> is one simulation, Run<Lanes<8>> is
/// eight in parallel.
///
/// The step at tick k (docs/architecture.md, tests/engine/run/order_test.cpp):
///   1. for every rate due at k, and everything continuous: decisions and outputs, in order
///   2. jumps of states from frozen inputs; if a state changed, 1 again, at most ten times
///   3. accepted memory of continuous blocks; a row of the recording, if one is due
///   4. updates of the rates due, from frozen inputs
///   5. the continuous states advance to the next tick that is due, or by one solver step, with sampled
///      signals held
#pragma once
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include "engine/plan/plan.h"
#include "engine/run/block_instance.h"
#include "engine/run/calls_by_rate.h"
#include "engine/run/algebraic_loop.h"
#include "engine/run/conditional_call.h"
#include "engine/solve/ode.h"

namespace loopwright {

/// Distinguishes the runs of a plan.
struct RunIdentity {
  uint64_t seed = 1;
  int64_t run = 0;  ///< of the first lane
};

template <class Real> class Run {
 public:
  static constexpr int width = lanes_of<Real>;  ///< simulations per register

  /// The plan must outlive the run. There are `arenas` arenas, each with `width` simulations.
  explicit Run(const Plan& plan, int arenas = 1);
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  /// Returns to the start with the present parameters. Signals whose first sample is later are computed from
  /// the initial values of their inputs.
  void reset(const RunIdentity& identity);
  /// A tunable number of one lane by path, "stage.cogging.harmonics.0.amplitude"; null if there is none or it
  /// is structural. A change takes effect at reset.
  double* parameter(std::string_view path, int lane = 0);

  // The parts of a step; for a fixed-step method `step_fixed` executes all of them.
  /// The rates that are due now, as a bit mask over Plan::rates.
  uint64_t due() const;
  /// Parts 1 and 2. `everything`: includes continuous outputs that only a recording reads.
  void evaluate(uint64_t due_rates, bool everything);
  /// evaluate(due_rates, true) with identical results, calling `after(block)` after each output, to measure
  /// the time of each block.
  template <class After> void evaluate_watched(uint64_t due_rates, After&& after) {
    const auto& calls = outputs_.at(due_rates);
    for (const Call<Real>& c : calls) failed_ |= c.step(c), after(c.index);
    if (!jumps_.empty()) repeat_after_jumps(calls);
  }
  void accept() { run(accepts_); }
  void update(uint64_t due_rates) { run(updates_.at(due_rates)); }
  /// The next tick after now at which a rate is due.
  int64_t next_due();
  /// Part 5 with the fixed-step method of the plan.
  void integrate(int64_t ticks);
  void move_to(int64_t tick) {
    if (tick < now_.tick) none_due_before_ = INT64_MIN;
    now_ = {plan_.clock.time(tick), tick};
  }

  /// Parts 1 to 4 of a step up to at most `limit`. If `everything`, `record()` is called in part 3. Returns
  /// the tick to which part 5 must integrate. If nothing happens between samples, the step extends to the
  /// next sample.
  template <class Record> int64_t begin_step(int64_t limit, bool everything, Record&& record) {
    const uint64_t due_rates = due();
    evaluate(due_rates, everything || due_rates != 0);
    accept();
    if (everything) record();
    update(due_rates);
    int64_t next = plan_.steps_between_samples ? std::min(limit, now_.tick + plan_.step_ticks) : limit;
    if (!plan_.rates.empty()) next = std::min(next, next_due());
    return next;
  }
  /// One whole step.
  template <class Record> void step_fixed(int64_t limit, bool everything, Record&& record) {
    const int64_t next = begin_step(limit, everything, record);
    integrate(next - now_.tick);
  }
  /// Calls `record()` with time, states and signals at a tick inside the present step, as computed by a
  /// shorter step with decisions and samples held. Afterwards the previous state is restored.
  template <class Record> void look_ahead(int64_t tick, Record&& record);
  /// Must be called before the first look_ahead; allocates its memory.
  void allow_look_ahead() { ahead_.resize(number_count() * base_.size()); }

  // For variable-step solvers: the system between discontinuities. Only for scalar runs.
  bool derivatives_at(double time, const double* x, double* rate);
  /// To be called after evaluate(): the signals are those of the present time and states. If the next call of
  /// derivatives_at is for these, it does not compute them again.
  void reuse_signals() { signals_are_current_ = accepts_.empty() && algebraic_loops_.empty(); }
  /// From here on derivatives_at and evaluate(0, false) do not call these blocks, one flag for each block of
  /// the plan: what reads them reads the values that their outputs have or are set to.
  /// No block of an algebraic loop may be among them.
  void leave_out(const std::vector<bool>& blocks);
  bool crossings_at(double time, const double* x, double* value);
  /// Sets states and time; signals are not yet computed.
  void look_at(double time, const double* x);
  /// Calls `record()` with all signals at a time inside a solver step, with modes held. Does not affect later
  /// steps.
  template <class Record> void look_between(double time, const double* x, Record&& record);
  /// Computes the continuous outputs that accepted memory reads, with modes held, as inside a solver step.
  void evaluate_held() { run(for_events_); }
  bool has_accepted_memory() const { return !accepts_.empty(); }
  void set_time(double time) { now_.time = time; }
  /// The next discontinuity in time declared by a block, strictly after `time`.
  double next_stop(double time) const;

  const Real& number(Number n, int arena = 0) const { return numbers_[n + arena * stride_]; }
  /// Locations of the parameters, ports, states, memory and mode of a block in the first arena; its `step`
  /// is null.
  const Call<Real>& call(int block) const { return base_[0][size_t(block)]; }
  std::span<Real> states() { return {numbers_ + plan_.signals, size_t(plan_.states)}; }
  const Instant& now() const { return now_; }
  const Plan& plan() const { return plan_; }
  /// Whether a block runs on all lanes of Real together, not lane by lane.
  bool is_lane_wise(int block) const { return instances_[0][size_t(block)].is_lane_wise(); }
  uint64_t failed() const { return failed_; }  ///< lanes in which a block faulted
  const FaultReport& fault(int lane = 0) const { return reports_[size_t(lane)]; }
  /// All mutable numbers. Copying them makes or restores a snapshot or checkpoint.
  std::span<char> arena() { return {arena_.get(), bytes_}; }
  /// Must be called after the arena was overwritten by a snapshot taken at this instant.
  void restored(const Instant& now) {
    now_ = now;
    none_due_before_ = INT64_MIN;
    forget_faults();
  }

 private:
  struct FreeArena {
    void operator()(char* p) const { ::operator delete(p, std::align_val_t(64)); }
  };

  /// The ports of blocks; calls point to them.
  struct Wires {
    std::vector<Port<Real>> ports;
    std::vector<const Real*> many;
  };

  void lay_out();
  template <class Wanted>
  std::vector<Call<Real>> connect(size_t arena, Wires& wires, Real* states, Wanted&& wanted);
  void schedule();
  void schedule_arena(const std::vector<Call<Real>>& base);
  template <class T> void take_turns(std::vector<T>& calls) const;
  void schedule_stages();
  void schedule_stage(size_t stage, size_t stages, std::vector<Call<Real>> base);
  std::vector<bool> blocks_in_stages() const;
  Call<Real> slope_call(Call<Real> call, size_t stage, bool is_last);
  void forget_faults() {
    for (const auto& gates : gates_)
      for (const auto& gate : gates) gate->forget();
    failed_ = 0;
    std::fill(reports_.begin(), reports_.end(), FaultReport{});
  }
  /// Saves or restores signals and states in all arenas.
  size_t number_count() const { return size_t(plan_.signals + plan_.states); }
  void keep_numbers();
  void put_numbers_back();
  /// Whether a call is made at the start although its rate is not due then.
  bool is_evaluated_early(const Plan::Entry& entry) const;
  bool reads_nothing(const Plan::Entry& entry) const;
  /// A fault of a block during a trial step of the solver has not stopped the run.
  void forget_trials() {
    if (!failed_ && reports_[0].block >= 0) reports_[0] = {};
  }
  /// Recomputes the signals in lanes whose states have jumped; the other lanes keep theirs.
  void repeat_after_jumps(const std::vector<Call<Real>>& calls);
  void evaluate_again(uint64_t jumped, const std::vector<Call<Real>>& calls);
  Call<Real> call_of(const Plan::Entry& entry, const std::vector<Call<Real>>& base);
  enum class At { decision, step };  ///< with new decisions, or inside a step
  Call<Real> conditional(const Plan::Entry& entry, Call<Real> call, At at);
  using Conditional = ConditionalCall<Real>;
  Call<Real> conditional(Call<Real> call, typename Conditional::Kind kind = Conditional::Kind::compute,
                         int numbers = 0, bool is_last = false);
  Call<Real> gate_call(size_t gate, Call<Real> call);
  uint64_t mask_of(const Rate& rate) const;
  LW_INLINE void run(const std::vector<Call<Real>>& calls) {
    uint64_t bad = 0;
    for (const Call<Real>& c : calls) bad |= c.step(c);
    failed_ |= bad;
  }
  template <class F> LW_INLINE void each_state(F&& f) {
    for (int a = 0; a < arenas_; ++a)
      for (int i = 0; i < plan_.states; ++i) f(a * stride_ + i);
  }
  Instant after(double h) const { return {now_.time + h, now_.tick}; }
  void euler(double h);
  void heun(double h);
  void rk4(double h);

  const Plan& plan_;
  const int arenas_;
  ptrdiff_t stride_ = 0;
  size_t bytes_ = 0;
  std::unique_ptr<char, FreeArena> arena_;
  Real *numbers_ = nullptr, *x_ = nullptr, *crossing_ = nullptr, *buffers_ = nullptr;
  std::vector<size_t> memory_at_, mode_at_;  // bytes from the start of the arena
  size_t evaluated_ = 0;                     // Reals from the start of the arena that evaluation may write
  std::vector<double> kept_;                 // the values of lanes that did not jump
  std::vector<std::vector<BlockInstance<Real>>> instances_;  // for each arena, as in all members below
  std::vector<Wires> wires_;
  std::vector<std::vector<Call<Real>>> base_;  // one for each block, without a step
  bool signals_are_current_ = false;           ///< by reuse_signals()
  std::vector<std::unique_ptr<AlgebraicLoopSolver<Real>>> algebraic_loops_;
  std::vector<std::unique_ptr<Conditional>> conditional_;  // calls point to these
  std::vector<std::vector<std::unique_ptr<GateCall<Real>>>> gates_;
  std::vector<Call<Real>> constants_, early_, between_, stage_, for_events_, held_, accepts_, jumps_,
      crossings_, slopes_;
  std::vector<Call<Real>> whole_between_, whole_stage_;  // with what is left out
  // For fixed-step methods, for each stage; see run_stages.h.
  std::array<Real*, 4> slope_{};    // kept until the end of the step: summing them earlier would cost more
  std::array<Real*, 2> stage_x_{};  // states of the second and fourth stage, and of the third
  std::vector<std::array<Wires, 2>> stage_wires_;
  std::array<double, 4> weight_{};  // [s] step length along the slope
  std::array<Instant, 4> stage_now_;
  std::vector<Stage<Real>> stage_of_;
  std::vector<Call<Real>> stages_;
  CallsByRate<Real> outputs_, updates_;
  std::vector<std::pair<const void*, double (*)(const void*, double)>> stops_;
  Instant now_;
  int64_t none_due_before_ = INT64_MIN;  // a later tick: before it due() is 0
  uint64_t failed_ = 0, jumped_ = 0;
  std::vector<FaultReport> reports_;  // one for each lane
  std::vector<Real> ahead_;           // saved signals and states while a recording needs values inside a step
};

}  // namespace loopwright

#include "engine/run/run_conditions.h"
#include "engine/run/run_construction.h"
#include "engine/run/run_stages.h"
#include "engine/run/run_step.h"
