/// A LaneRun on one scalar: compiled for double into the program, for lanes into each module.
#pragma once
#include <bit>
#include <cstring>
#include "engine/lanes/lane_run.h"
#include "engine/run/fixed_step.h"

namespace loopwright {

template <class Real> class LaneRunOf final : public LaneRun {
 public:
  LaneRunOf(const Plan& plan, int arenas)
      : plan_(plan),
        run_(plan, arenas),
        arenas_(arenas),
        all_(~uint64_t(0) >> (most_lanes - arenas * width)),
        failures_(size_t(arenas * width)) {}

  int lanes() const override { return arenas_ * width; }
  bool is_lane_wise(int block) const override { return run_.is_lane_wise(block); }
  double* parameter(std::string_view path, int lane) override { return run_.parameter(path, lane); }
  void reset(const RunIdentity& identity) override {
    run_.reset(identity);
    failed_ = not_finite_ = 0;
  }
  void run(const std::function<bool(double)>& row) override {
    note_faults();
    if (failed_ == all_) return;
    bool wanted = true;
    const bool reached_stop = run_fixed_steps(
        run_, run_.now().tick,
        [&] {
          if (row) wanted = row(run_.now().time);
          for (int r = 0; r < arenas_; ++r) look_for_non_finite(r, log_of(r));
        },
        [&](bool was_row) {
          note_faults();
          if (was_row) note_divergence();
          return wanted && failed_ != all_;
        });
    if (reached_stop) note_faults(), note_divergence();
  }
  double time() const override { return run_.now().time; }
  void evaluate(double at) override {
    run_.set_time(at);
    const uint64_t due = run_.due();
    run_.evaluate(due, true);
    run_.accept();
    run_.update(due);
    note_faults();
  }
  int64_t integrate(int64_t ticks) override {
    const int64_t passed = plan_.states > 0 ? std::min(plan_.step_ticks, ticks) : ticks;
    run_.integrate(passed);
    note_faults();
    return passed;
  }
  void read(std::span<const Number> numbers, double* to) const override {
    for (const Number n : numbers)
      for (int r = 0; r < arenas_; ++r, to += width) std::memcpy(to, &run_.number(n, r), sizeof(Real));
  }
  void accepted_memory(int lane_number, std::vector<double>& to) const override {
    for (size_t b = 0; b < plan_.blocks.size(); ++b)
      for (const int word : plan_.blocks[b].type->info.memory_numbers)
        to.push_back(lane(static_cast<const Real*>(run_.call(int(b)).memory)[word], lane_number));
  }
  uint64_t failed() const override { return failed_; }
  LaneFailure failure(int lane) const override {
    return failed_ >> lane & 1 ? failures_[size_t(lane)] : LaneFailure{};
  }

 private:
  static constexpr int width = lanes_of<Real>;

  /// 0·x, summed over numbers, is NaN if any of them is non-finite.
  Real log_of(int r) const {
    Real sum = 0.0;
    for (const Plan::Logged& logged : plan_.log) sum = sum + 0.0 * run_.number(logged.number, r);
    return sum;
  }
  Real states_of(int r) const {
    Real sum = 0.0;
    for (int i = 0; i < plan_.states; ++i) sum = sum + 0.0 * run_.number(plan_.signals + i, r);
    return sum;
  }
  void look_for_non_finite(int r, const Real& sum) {
    const auto bad = !is_finite(sum);
    if (!any(bad)) return;
    for (int l = 0; l < width; ++l) not_finite_ |= uint64_t(lane(bad, l)) << (r * width + l);
  }
  bool is_finite_in(Number n, int lane_number) const {
    return lane(is_finite(run_.number(n, lane_number / width)), lane_number % width);
  }

  void fail(int lane, const LaneFailure& failure) {
    failures_[size_t(lane)] = failure;
    failed_ |= uint64_t(1) << lane;
  }
  void note_faults() {
    for (uint64_t fresh = run_.failed() & ~failed_; fresh; fresh &= fresh - 1) {
      const int lane = std::countr_zero(fresh);
      fail(lane, {run_.now().time, run_.fault(lane).block, -1, run_.fault(lane).reason});
    }
  }
  /// As for one run: after a step that began with a row.
  void note_divergence() {
    for (int r = 0; r < arenas_; ++r) look_for_non_finite(r, states_of(r));
    for (uint64_t fresh = not_finite_ & ~failed_; fresh; fresh &= fresh - 1) {
      const int lane = std::countr_zero(fresh);
      fail(lane, culprit(lane));
    }
  }
  /// The first output in order that is non-finite, or else the first state.
  LaneFailure culprit(int lane) const {
    const double now = run_.now().time;
    for (const Plan::Entry& entry : plan_.order) {
      if (entry.kind != Plan::Entry::Kind::outputs) continue;
      for (const Number output : plan_.blocks[size_t(entry.block)].outputs)
        if (!is_finite_in(output, lane)) return {now, entry.block, output, nullptr};
    }
    for (int i = 0; i < plan_.states; ++i)
      if (!is_finite_in(plan_.signals + i, lane)) return {now, plan_.block_of_state[size_t(i)], -1, nullptr};
    return {now, -1, -1, nullptr};
  }

  const Plan& plan_;
  Run<Real> run_;
  const int arenas_;
  const uint64_t all_;
  uint64_t failed_ = 0, not_finite_ = 0;
  std::vector<LaneFailure> failures_;
};

}  // namespace loopwright
