/// A block of the plan in one run: its parameters for every lane, and its methods for the scalar of the run.
#pragma once
#include <memory>
#include "engine/plan/plan.h"
#include "engine/file/hash.h"

namespace loopwright {

/// Key of the random streams of a block.
inline uint64_t hash_of_path(std::string_view path) { return ContentHash().add(path).value(); }

template <class Real> class BlockInstance;

template <class Real>
uint64_t start_by(const Kernels<Real>& kernels, void* block, const Call<Real>& call, const Setup& setup) {
  const Fault unprepared = kernels.prepare(block, setup);
  Fault fault = joined(unprepared, kernels.start(block, call.state, call.memory, call.buffers, call.mode));
  fault.lanes <<= call.first_lane;
  return fault.lanes ? report_fault(call.report, call.index, fault) : 0;
}

/// One simulation: the block itself.
template <> class BlockInstance<double> {
 public:
  explicit BlockInstance(const Plan::Block& block)
      : kernels_(&block.type->kernels),
        memory_(static_cast<char*>(::operator new(kernels_->size, std::align_val_t(64))),
                Destroy{kernels_->destroy}) {
    kernels_->construct(memory_.get());
    kernels_->copy(memory_.get(), block.value.get());
  }
  void* block() { return memory_.get(); }
  bool is_lane_wise() const { return true; }
  size_t memory_bytes() const { return kernels_->memory_size; }
  size_t mode_bytes() const { return kernels_->mode_size; }
  double* tunable(std::string_view path, int) { return kernels_->tunable(memory_.get(), path); }
  /// Prepares and starts the block; returns the lanes that faulted.
  uint64_t start(const Call<double>& call, const Setup& setup) {
    return start_by(*kernels_, memory_.get(), call, setup);
  }
  Step<double> outputs(int group) const { return kernels_->outputs[group]; }
  Step<double> decide() const { return kernels_->decide; }
  Step<double> derivatives() const { return kernels_->derivatives; }
  Step<double> to_next_stage() const { return kernels_->to_next_stage; }
  Step<double> to_next_step() const { return kernels_->to_next_step; }
  Step<double> update() const { return kernels_->update; }
  Step<double> accept() const { return kernels_->accept; }
  Step<double> jump() const { return kernels_->jump; }
  Step<double> crossings() const { return kernels_->crossings; }

 private:
  struct Destroy {
    void (*destroy)(void*);
    void operator()(char* p) const {
      destroy(p);
      ::operator delete(p, std::align_val_t(64));
    }
  };
  const Kernels<double>* kernels_;
  std::unique_ptr<char, Destroy> memory_;
};

}  // namespace loopwright
