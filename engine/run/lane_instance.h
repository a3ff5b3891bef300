/// A block in a run of many lanes: with its lane kernels if the module has them, otherwise lane by lane.
#pragma once
#include <algorithm>
#include <array>
#include <memory>
#include <vector>
#include "engine/run/block_instance.h"

namespace loopwright {

/// A block without lane kernels (a plain struct, or a block from a library): a scalar copy for every lane,
/// called one after the other. Signals, states and modes are passed through scalar ports. Memory and buffers
/// are used in place, as each lane has its own part of the arena for them.
template <class Real> class LaneByLane {
 public:
  static constexpr int width = lanes_of<Real>;

  explicit LaneByLane(const Plan::Block& block)
      : info_(block.type->info),
        kernels_(block.type->kernels),
        memory_stride_(whole(kernels_.memory_size, 64)),
        state_(size_t(block.states)),
        rate_(state_.size()),
        mode_(whole(kernels_.mode_size, sizeof(double)) / sizeof(double)) {
    mode_.reserve(1);  // a block without modes also binds a reference to this storage
    for (int l = 0; l < width; ++l) lanes_.push_back(std::make_unique<BlockInstance<double>>(block));
    for (const auto& wires : block.inputs) {
      const auto& values = in_values_.emplace_back(std::make_unique<double[]>(wires.size()));
      auto& places = in_places_.emplace_back();
      for (size_t i = 0; i < wires.size(); ++i) places.push_back(values.get() + i);
      Port<double> port{};
      if (is_many(in_.size()))
        port.many = places.data();
      else
        port.data = values.get();
      port.length = int(wires.size());
      in_.push_back(port);
    }
    for (const int length : block.output_lengths) {
      Port<double> port{};
      port.data = out_values_.emplace_back(std::make_unique<double[]>(size_t(length))).get();
      port.length = length;
      out_.push_back(port);
    }
    buffers_.resize(block.buffer_lengths.size());
  }

  size_t memory_bytes() const { return size_t(width) * memory_stride_; }
  size_t mode_bytes() const { return mode_.size() * sizeof(Real); }
  double* tunable(std::string_view path, int lane) { return lanes_[size_t(lane)]->tunable(path, 0); }

  uint64_t start(const Call<Real>& call, const Setup& setup) {
    uint64_t faults = 0;
    for (int lane = 0; lane < width; ++lane) {
      Setup own = setup;
      own.run += lane;
      const uint64_t fault = lanes_[size_t(lane)]->start(scalar_call(call, lane), own);
      faults |= uint64_t(fault != 0) << (call.first_lane + lane);
      put(call, lane);
    }
    return faults;
  }

  /// The step of a call in these lanes only, counted from the first lane of its arena.
  static uint64_t only(const Call<Real>& call, uint64_t lanes) {
    LaneByLane& self = of(call);
    self.selected_ = lanes;
    const uint64_t faults = call.step(call);
    self.selected_ = ~uint64_t(0);
    return faults;
  }
  /// States, memory and modes of these lanes as at the start of the run.
  static uint64_t start_anew(const Call<Real>& call, uint64_t lanes) {
    LaneByLane& self = of(call);
    uint64_t faults = 0;
    for (int lane = 0; lane < width; ++lane) {
      if (!(lanes >> lane & 1)) continue;
      self.take(call, lane);
      const Call<double> scalar = self.scalar_call(call, lane);
      std::ranges::fill(self.state_, 0.0);
      for (const Port<double>& buffer : self.buffers_) std::fill_n(buffer.data, buffer.length, 0.0);
      Fault fault =
          self.kernels_.start(scalar.block, scalar.state, scalar.memory, scalar.buffers, scalar.mode);
      fault.lanes <<= call.first_lane + lane;
      if (fault.lanes) faults |= report_fault(call.report, call.index, fault);
      self.put(call, lane);
    }
    return faults;
  }

  template <Step<double> Kernels<double>::*method> bool has() const { return kernels_.*method != nullptr; }
  /// A method of the scalar block in every lane. Returns the faults, one bit for each lane.
  template <Step<double> Kernels<double>::*method> static uint64_t step(const Call<Real>& call) {
    return of(call).each_lane(call, of(call).kernels_.*method);
  }
  template <int group> static uint64_t step_outputs(const Call<Real>& call) {
    return of(call).each_lane(call, of(call).kernels_.outputs[group]);
  }
  template <class After> static uint64_t step_derivatives(const Call<Real>& call) {
    const uint64_t faults = step<&Kernels<double>::derivatives>(call);
    for (int i = 0; i < call.states; ++i) After::take(call, i, call.rate[i]);
    return faults;
  }

 private:
  static size_t whole(size_t bytes, size_t unit) { return (bytes + unit - 1) / unit * unit; }
  static LaneByLane& of(const Call<Real>& call) {
    return *const_cast<LaneByLane*>(static_cast<const LaneByLane*>(call.block));
  }
  bool is_many(size_t input) const { return info_.inputs[input].shape == PortInfo::Shape::many; }

  uint64_t each_lane(const Call<Real>& call, Step<double> method) {
    uint64_t answer = 0;
    for (int lane = 0; lane < width; ++lane) {
      if (call.report[call.first_lane + lane].block >= 0 || !(selected_ >> lane & 1))
        continue;  // the results of a lane that has failed are not used
      take(call, lane);
      jumped_ = 0;
      answer |= uint64_t(method(scalar_call(call, lane)) != 0) << (call.first_lane + lane);
      if (jumped_) *call.jumped |= uint64_t(1) << (call.first_lane + lane);
      put(call, lane);
    }
    return answer;
  }
  Call<double> scalar_call(const Call<Real>& call, int lane) {
    for (size_t b = 0; b < buffers_.size(); ++b) {
      buffers_[b].length = call.buffers[b].length;
      buffers_[b].data = reinterpret_cast<double*>(call.buffers[b].data) + lane * buffers_[b].length;
    }
    Call<double> scalar;
    scalar.block = lanes_[size_t(lane)]->block(), scalar.index = call.index, scalar.now = call.now;
    scalar.report = call.report + call.first_lane + lane, scalar.jumped = &jumped_;
    scalar.in = in_.data(), scalar.out = out_.data(), scalar.buffers = buffers_.data();
    scalar.state = state_.data(), scalar.rate = rate_.data(), scalar.mode = mode_.data();
    scalar.memory = static_cast<char*>(call.memory) + lane * ptrdiff_t(memory_stride_);
    return scalar;
  }

  /// Copies the inputs of the scalar block from the lane.
  void take(const Call<Real>& call, int l) {
    for (size_t p = 0; p < in_.size(); ++p)
      for (int i = 0; i < in_[p].length; ++i)
        in_values_[p][size_t(i)] = lane(is_many(p) ? *call.in[p].many[i] : call.in[p].data[i], l);
    for (size_t i = 0; i < state_.size(); ++i) state_[i] = lane(call.state[i], l);
    for (size_t i = 0; i < mode_.size(); ++i) mode_[i] = lane(static_cast<const Real*>(call.mode)[i], l);
    each_computed(call, [&](double& mine, Real& theirs) { mine = lane(theirs, l); });
  }
  /// Copies the values that the block may have written to the lane.
  void put(const Call<Real>& call, int l) {
    for (size_t i = 0; i < state_.size(); ++i) set_lane(call.state[i], l, state_[i]);
    for (size_t i = 0; i < mode_.size(); ++i) set_lane(static_cast<Real*>(call.mode)[i], l, mode_[i]);
    each_computed(call, [&](double& mine, Real& theirs) { set_lane(theirs, l, mine); });
  }
  /// Outputs that are not states, and rates: values written by one method must be available to the others.
  template <class F> void each_computed(const Call<Real>& call, F&& f) {
    for (size_t p = 0; p < out_.size(); ++p)
      for (int i = 0; i < out_[p].length && info_.outputs[p].group >= 0; ++i)
        f(out_values_[p][size_t(i)], call.out[p].data[i]);
    for (size_t i = 0; i < rate_.size(); ++i) f(rate_[i], call.rate[i]);
  }

  const BlockInfo& info_;
  const Kernels<double>& kernels_;
  const size_t memory_stride_;  // bytes
  std::vector<std::unique_ptr<BlockInstance<double>>> lanes_;
  std::vector<std::unique_ptr<double[]>> in_values_, out_values_;
  std::vector<std::vector<const double*>> in_places_;
  std::vector<Port<double>> in_, out_, buffers_;
  std::vector<double> state_, rate_;
  std::vector<double> mode_;          // its bytes, stored as doubles; not used for computation
  uint64_t jumped_ = 0;               // of the present lane
  uint64_t selected_ = ~uint64_t(0);  // lanes in which the block runs
};

/// A block that depends only on time, such as a reference. As long as no parameter of a single lane has been
/// requested, the scalar block computes its outputs once for all lanes.
template <class Real> class OnceForAll {
 public:
  static bool suits(const Plan::Block& block) {
    const Kernels<double>& kernels = block.type->kernels;
    return block.type->info.inputs.empty() && block.states == 0 && kernels.memory_size == 0 && !kernels.jump;
  }
  OnceForAll(const Plan::Block& block, const Kernels<Real>& lane_kernels, const void* lanes)
      : kernels_(block.type->kernels),
        lane_kernels_(lane_kernels),
        lanes_(lanes),
        scalar_(block),
        mode_(kernels_.mode_size / sizeof(double) + 1) {
    for (const int length : block.output_lengths) {
      Port<double> port{};
      port.data = values_.emplace_back(std::make_unique<double[]>(size_t(length))).get();
      port.length = length;
      out_.push_back(port);
    }
  }
  /// After this, every lane has its own parameters, starting with the next start.
  void part() { lanes_part_ = true; }
  void start(const Call<Real>& call, const Setup& setup) {
    is_once_ = !lanes_part_;
    FaultReport none;
    scalar_.start(scalar_call(call, none), setup);
  }
  static uint64_t decide(const Call<Real>& call) {
    return of(call).step(call, of(call).kernels_.decide, of(call).lane_kernels_.decide);
  }
  template <int group> static uint64_t outputs(const Call<Real>& call) {
    return of(call).step(call, of(call).kernels_.outputs[group], of(call).lane_kernels_.outputs[group]);
  }

 private:
  static OnceForAll& of(const Call<Real>& call) {
    return *const_cast<OnceForAll*>(static_cast<const OnceForAll*>(call.block));
  }
  Call<double> scalar_call(const Call<Real>& call, FaultReport& report) {
    Call<double> scalar;
    scalar.block = scalar_.block(), scalar.index = call.index, scalar.now = call.now;
    scalar.report = &report, scalar.out = out_.data(), scalar.mode = mode_.data();
    scalar.memory = mode_.data();  // bound to an empty struct, as kernels bind unused arguments
    return scalar;
  }
  uint64_t step(const Call<Real>& call, Step<double> once, Step<Real> in_lanes) {
    if (!is_once_) {
      Call<Real> own = call;
      own.block = lanes_;
      return in_lanes(own);
    }
    FaultReport report;
    const uint64_t fault = once(scalar_call(call, report));
    for (size_t p = 0; p < out_.size(); ++p)
      for (int i = 0; i < out_[p].length; ++i) call.out[p].data[i] = out_[p].data[i];
    if (!fault) [[likely]]
      return 0;
    const uint64_t all = (~uint64_t(0) >> (64 - lanes_of<Real>)) << call.first_lane;
    return report_fault(call.report, call.index, {all, report.reason});
  }

  const Kernels<double>& kernels_;
  const Kernels<Real>& lane_kernels_;
  const void* lanes_;  // the blocks of the lane kernels
  BlockInstance<double> scalar_;
  std::vector<std::unique_ptr<double[]>> values_;
  std::vector<Port<double>> out_;
  std::vector<double> mode_;  // its bytes; not used for computation
  bool lanes_part_ = false, is_once_ = false;
};

/// A block of the plan for the lanes of an arena.
template <class Real> class BlockInstance {
 public:
  static constexpr int width = lanes_of<Real>;

  explicit BlockInstance(const Plan::Block& block) {
    const auto found = lane_kernels<Real>().find(block.type->info.type);
    if (found == lane_kernels<Real>().end() || block.gate >= 0) {
      lane_by_lane_ = std::make_unique<LaneByLane<Real>>(block);
      return;
    }
    kernels_ = &found->second;
    block_ = {static_cast<char*>(::operator new(kernels_->size, std::align_val_t(64))),
              Destroy{kernels_->destroy}};
    kernels_->construct(block_.get());
    kernels_->copy(block_.get(), block.value.get());
    if (OnceForAll<Real>::suits(block))
      once_for_all_ = std::make_unique<OnceForAll<Real>>(block, *kernels_, block_.get());
  }
  void* block() {
    if (once_for_all_) return once_for_all_.get();
    return kernels_ ? static_cast<void*>(block_.get()) : lane_by_lane_.get();
  }
  bool is_lane_wise() const { return kernels_ != nullptr; }
  size_t memory_bytes() const { return kernels_ ? kernels_->memory_size : lane_by_lane_->memory_bytes(); }
  size_t mode_bytes() const { return kernels_ ? kernels_->mode_size : lane_by_lane_->mode_bytes(); }
  /// A tunable number of one lane; null if there is none or it is structural.
  double* tunable(std::string_view path, int lane) {
    if (!kernels_) return lane_by_lane_->tunable(path, lane);
    Real* found = kernels_->tunable(block_.get(), path);
    if (found && once_for_all_) once_for_all_->part();
    return found ? reinterpret_cast<double*>(found) + lane : nullptr;
  }
  /// Prepares and starts the block; returns the lanes that faulted.
  uint64_t start(const Call<Real>& call, const Setup& setup) {
    if (!kernels_) return lane_by_lane_->start(call, setup);
    if (once_for_all_) once_for_all_->start(call, setup);
    return start_by(*kernels_, block_.get(), call, setup);
  }
  Step<Real> outputs(int group) const {
    static constexpr auto by_group = []<int... g>(std::integer_sequence<int, g...>) {
      return std::array<std::pair<Step<Real>, Step<Real>>, sizeof...(g)>{
          std::pair{&LaneByLane<Real>::template step_outputs<g>, &OnceForAll<Real>::template outputs<g>}...};
    }
    (std::make_integer_sequence<int, 8>{});
    const auto& [lane_by_lane, once_for_all] = by_group[size_t(group)];
    return once_for_all_ ? once_for_all : kernels_ ? kernels_->outputs[group] : lane_by_lane;
  }
  Step<Real> decide() const {
    if (once_for_all_) return kernels_->decide ? &OnceForAll<Real>::decide : nullptr;
    return step<&Kernels<Real>::decide, &Kernels<double>::decide>();
  }
  Step<Real> derivatives() const {
    return step<&Kernels<Real>::derivatives, &Kernels<double>::derivatives>();
  }
  Step<Real> to_next_stage() const { return slope_step<&Kernels<Real>::to_next_stage, ToNextStage>(); }
  Step<Real> to_next_step() const { return slope_step<&Kernels<Real>::to_next_step, ToNextStep>(); }
  Step<Real> update() const { return step<&Kernels<Real>::update, &Kernels<double>::update>(); }
  Step<Real> accept() const { return step<&Kernels<Real>::accept, &Kernels<double>::accept>(); }
  Step<Real> jump() const { return step<&Kernels<Real>::jump, &Kernels<double>::jump>(); }
  /// None: only variable-step methods locate events, and these run scalar.
  Step<Real> crossings() const { return nullptr; }

 private:
  template <Step<Real> Kernels<Real>::*own, Step<double> Kernels<double>::*scalar> Step<Real> step() const {
    if (kernels_) return kernels_->*own;
    return lane_by_lane_->template has<scalar>() ? &LaneByLane<Real>::template step<scalar> : nullptr;
  }
  template <Step<Real> Kernels<Real>::*own, class After> Step<Real> slope_step() const {
    if (kernels_) return kernels_->*own;
    return derivatives() ? &LaneByLane<Real>::template step_derivatives<After> : nullptr;
  }
  struct Destroy {
    void (*destroy)(void*) = nullptr;
    void operator()(char* p) const {
      destroy(p);
      ::operator delete(p, std::align_val_t(64));
    }
  };
  const Kernels<Real>* kernels_ = nullptr;  // null: lane by lane
  std::unique_ptr<char, Destroy> block_;
  std::unique_ptr<LaneByLane<Real>> lane_by_lane_;
  std::unique_ptr<OnceForAll<Real>> once_for_all_;  // in addition to the lane kernels
};

}  // namespace loopwright
