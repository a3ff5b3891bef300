/// Calls of blocks in subdiagrams that do not always run (engine/plan/gates.h).
///
/// Such a call wraps the call of the block, and makes it only where a signal of the gate is true. Blocks
/// outside such subdiagrams are called as if there were none. On lanes the blocks inside run lane by lane.
#pragma once
#include <algorithm>
#include "engine/run/block_instance.h"
#include "engine/run/lane_instance.h"

namespace loopwright {

/// The lanes in which a logic signal is true.
inline uint64_t true_lanes(const double& signal) { return signal > 0.5; }
template <int N, int R> uint64_t true_lanes(const Lanes<N, R>& signal) {
  uint64_t lanes = 0;
  for (int l = 0; l < lanes_of<Lanes<N, R>>; ++l) lanes |= uint64_t(lane(signal, l) > 0.5) << l;
  return lanes;
}

inline void set_number(double& number, int, double value) { number = value; }
template <int N, int R> void set_number(Lanes<N, R>& number, int l, double value) {
  set_lane(number, l, value);
}

/// The step of a call in the selected lanes.
inline uint64_t call_lanes(const Call<double>& call, uint64_t lanes) { return lanes ? call.step(call) : 0; }
template <class Real> uint64_t call_lanes(const Call<Real>& call, uint64_t lanes) {
  return lanes ? LaneByLane<Real>::only(call, lanes) : 0;
}

/// States, memory and modes as at the start of the run.
inline uint64_t start_anew(const Call<double>& call, const Kernels<double>& kernels, size_t buffers,
                           uint64_t) {
  std::fill_n(call.state, call.states, 0.0);
  for (size_t b = 0; b < buffers; ++b) std::fill_n(call.buffers[b].data, call.buffers[b].length, 0.0);
  const Fault fault = kernels.start(call.block, call.state, call.memory, call.buffers, call.mode);
  return fault.lanes ? report_fault(call.report, call.index, fault) : 0;
}
template <class Real>
uint64_t start_anew(const Call<Real>& call, const Kernels<double>&, size_t, uint64_t lanes) {
  return LaneByLane<Real>::start_anew(call, lanes);
}

/// The outputs of an Enable block. Where it is switched on, the blocks inside may start anew.
template <class Real> class GateCall {
 public:
  struct Member {
    Call<Real> call;
    const Kernels<double>* kernels;
    size_t buffers;
    Real* on;  ///< of an Enable block, which is then off until it decides again; otherwise null
  };
  GateCall(const Call<Real>& call, const Real* on, std::vector<Member> members)
      : call_(call), on_(on), members_(std::move(members)) {}

  uint64_t on() const { return true_lanes(*on_); }
  /// The lanes in which it was switched off at this instant.
  uint64_t off_at(double time) const { return off_time_ == time ? off_ : 0; }
  void forget() { off_ = 0; }

  static uint64_t step(const Call<Real>& c) {
    const GateCall& self = *static_cast<const GateCall*>(c.block);
    const uint64_t before = self.on();
    uint64_t bad = self.call_.step(self.call_);
    const uint64_t now = self.on();
    if (before == now) [[likely]]
      return bad;
    self.note_off(before & ~now, c.now->time);
    if (now & ~before)
      for (const Member& member : self.members_) bad |= start(member, now & ~before);
    return bad;
  }

 private:
  void note_off(uint64_t lanes, double time) const {
    off_ = lanes | off_at(time);
    off_time_ = time;
  }
  static uint64_t start(const Member& member, uint64_t lanes) {
    if (member.on)
      for (int l = 0; l < lanes_of<Real>; ++l)
        if (lanes >> l & 1) set_number(*member.on, l, 0.0);
    return start_anew(member.call, *member.kernels, member.buffers, lanes);
  }

  Call<Real> call_;
  const Real* on_;
  std::vector<Member> members_;
  // Of the present instant only: no part of the state of the run.
  mutable uint64_t off_ = 0;
  mutable double off_time_ = 0;
};

template <class Real> class ConditionalCall {
 public:
  enum class Kind { compute, slope, crossing };
  using Gates = std::vector<const GateCall<Real>*>;
  /// `gates`: of the subdiagram and of those around it. `is_last`: it is also made at the instant at which it
  /// is switched off. `numbers`: of slopes or crossings, which must be known even while the block does not
  /// run.
  ConditionalCall(const Call<Real>& call, Gates gates, bool is_last, Kind kind, int numbers)
      : call_(call), gates_(std::move(gates)), is_last_(is_last), kind_(kind), numbers_(numbers) {}

  static uint64_t step(const Call<Real>& c) {
    const ConditionalCall& self = *static_cast<const ConditionalCall*>(c.block);
    uint64_t lanes = ~uint64_t(0);
    for (const GateCall<Real>* gate : self.gates_)
      lanes &= gate->on() | (self.is_last_ ? gate->off_at(c.now->time) : 0);
    if (self.kind_ == Kind::slope)
      self.hold_states();
    else if (self.kind_ == Kind::crossing)
      std::fill_n(self.call_.crossing, self.numbers_, Real(1.0));  // no zero, hence no event
    return call_lanes(self.call_, lanes);
  }

 private:
  /// The slope of states that are held is zero. A block that runs overwrites it.
  void hold_states() const {
    std::fill_n(call_.rate, numbers_, Real(0.0));
    if (!call_.stage) return;
    const Stage<Real>& stage = *call_.stage;
    for (int i = 0; i < numbers_; ++i) stage.next[i] = stage.start[i] + Real(*stage.weight) * Real(0.0);
  }

  Call<Real> call_;
  Gates gates_;
  bool is_last_;
  Kind kind_;
  int numbers_;
};

}  // namespace loopwright
