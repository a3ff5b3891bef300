/// What a step calls: plain function pointers, and the locations of their numbers in the arena of a run.
#pragma once
#include "engine/block/parameters.h"

namespace loopwright {

/// The location of a port's numbers in the arena of the run.
template <class Real> struct Port {
  union {
    Real* data;
    const Real* const* many;
  };
  int length = 1;
};

/// First fault of a lane: the block that stopped it and the reason.
struct FaultReport {
  int block = -1;
  const char* reason = "";
};

/// A stage of a Runge-Kutta step, for the states of one block.
template <class Real> struct Stage {
  const Real* start;       ///< states at the start of the step
  Real* next;              ///< states of the next stage or of the next step
  const Real* earlier[3];  ///< slopes of the stages before
  const double* weight;    ///< [s] step length along the slope
};

/// One call of one method of one block, in one arena.
template <class Real> struct Call {
  uint64_t (*step)(const Call&) = nullptr;  ///< returns the lanes that faulted
  const void* block = nullptr;
  const Port<Real>*in = nullptr, *out = nullptr;
  Real *state = nullptr, *rate = nullptr, *crossing = nullptr;
  void *memory = nullptr, *mode = nullptr;
  const Port<Real>* buffers = nullptr;
  const Stage<Real>* stage = nullptr;
  const Instant* now = nullptr;
  FaultReport* report = nullptr;  ///< of the first lane of the run, followed by the others
  uint64_t* jumped = nullptr;     ///< receives the lanes whose states a jump changed
  int index = 0, states = 0;
  int first_lane = 0;  ///< of this arena
};
template <class Real> using Step = uint64_t (*)(const Call<Real>&);

/// The methods of a block type for one scalar type; null where the block has no such method.
template <class Real> struct Kernels {
  size_t size, align, memory_size, memory_align, mode_size;
  bool memory_has_gaps;  ///< memory or mode has bytes that belong to no member and are undetermined
  void (*construct)(void* block);
  void (*destroy)(void* block);
  void (*copy)(void* to, const void* scalar_block);  ///< copies the parameters to every lane
  Real* (*tunable)(void* block, std::string_view path);
  Fault (*prepare)(void* block, const Setup& setup);
  Fault (*start)(const void* block, Real* state, void* memory, const Port<Real>* buffers, void* mode);
  Step<Real> outputs[8];
  Step<Real> derivatives, to_next_stage, to_next_step, update, accept, decide, jump, crossings;
};

// Ways to use the slope of the i-th state of a block.

/// Only stores the slope.
struct KeepSlope {
  template <class Real> LW_INLINE static void take(const Call<Real>& c, int i, const Real& slope) {
    c.rate[i] = slope;
  }
};
/// x = x₀ + weight · slope.
struct ToNextStage {
  template <class Real> LW_INLINE static void take(const Call<Real>& c, int i, const Real& slope) {
    const Stage<Real>& stage = *c.stage;
    c.rate[i] = slope;
    stage.next[i] = stage.start[i] + Real(*stage.weight) * slope;
  }
};
/// x = x₀ + weight · (k₁ + 2 k₂ + 2 k₃ + slope).
struct ToNextStep {
  template <class Real> LW_INLINE static void take(const Call<Real>& c, int i, const Real& slope) {
    const Stage<Real>& stage = *c.stage;
    const auto& k = stage.earlier;
    stage.next[i] = stage.start[i] +
                    Real(*stage.weight) * (((k[0][i] + Real(2.0) * k[1][i]) + Real(2.0) * k[2][i]) + slope);
  }
};

}  // namespace loopwright
