/// Many runs of one plan side by side on SIMD lanes: sweeps, fits and ensembles. Each lane has its own
/// parameters and noise, and gives the bits that a scalar run gives.
///
/// Lanes live in modules, one an instruction set, that are loaded when the machine has it: no code for a wide
/// machine is ever linked into the program itself. Plain structs and blocks from libraries of blocks run lane
/// by lane.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include "engine/run/run.h"

namespace loopwright {

/// Why a lane stopped.
struct LaneFailure {
  double time = 0;               ///< s
  int block = -1;                ///< that faulted, or holds the number that is not finite
  Number number = -1;            ///< that is not finite; -1: it was a fault, or a state that is no output
  const char* reason = nullptr;  ///< of a fault; null: the run diverged
};

class LaneRun {
 public:
  virtual ~LaneRun() = default;
  virtual int lanes() const = 0;
  /// Whether a block of the plan runs on SIMD lanes; else it runs lane by lane.
  virtual bool is_lane_wise(int block) const = 0;
  /// A tunable number of one lane by path, "stage.cogging.harmonics.0.amplitude", to be written before reset;
  /// null: no such, or structural. It stays where it is as long as the run lives.
  virtual double* parameter(std::string_view path, int lane) = 0;
  /// Back to the start with the present parameters. Lane l is run number `identity.run` + l.
  virtual void reset(const RunIdentity& identity) = 0;
  /// From the present time to the stop. `row(time)`, if given, is called at every row of the recording, and
  /// may end the run by answering false. Ends early when all lanes have failed.
  virtual void run(const std::function<bool(double time)>& row = {}) = 0;
  virtual double time() const = 0;  ///< s
  // The step in parts, for a program that feeds the signals itself.
  /// Decisions, outputs and sampled updates at the present tick, as if the time were `at` [s].
  virtual void evaluate(double at) = 0;
  /// The states advance by a solver step, at most by `ticks`; returns the ticks that have passed.
  virtual int64_t integrate(int64_t ticks) = 0;
  /// Signals and states as they are now: to[i · lanes() + lane]. Without meaning in a lane that has failed.
  virtual void read(std::span<const Number> numbers, double* to) const = 0;
  /// Lanes that have failed, a bit each; the others go on.
  virtual uint64_t failed() const = 0;
  virtual LaneFailure failure(int lane) const = 0;
};

enum class InstructionSet { scalar, avx2, avx512 };
inline constexpr std::array all_instruction_sets{InstructionSet::scalar, InstructionSet::avx2,
                                                 InstructionSet::avx512};
/// Runs in one arena, which every block computes at once: on several registers, so that the units of
/// arithmetic always have an operation that waits for no other.
constexpr int lanes_in_arena(InstructionSet set) { return set == InstructionSet::scalar ? 1 : 32; }
constexpr std::string_view to_name(InstructionSet set) {
  return set == InstructionSet::avx512 ? "avx512" : set == InstructionSet::avx2 ? "avx2" : "scalar";
}

/// Most lanes that one run may have: a bit each in a mask of lanes.
inline constexpr int most_lanes = 64;

/// Why the plan cannot run side by side with a fixed step: which block or setting needs runs one by one.
/// Empty: it can.
std::string lanes_forbidden_by(const Plan& plan);

/// Why lanes of this set cannot run here: the processor lacks it, or the module is not there. Empty: they
/// can.
std::string lanes_unavailable(InstructionSet set);

/// The set with the most lanes that runs here.
InstructionSet widest_instruction_set();

/// Room for lanes_in_arena · arenas runs; the plan must outlive it. A scalar run has one. Throws
/// std::runtime_error with the reason where the plan forbids lanes, they are unavailable, or too many.
std::unique_ptr<LaneRun> make_lane_run(const Plan& plan, InstructionSet set, int arenas);

/// "coulomb" stopped the run at t = 0.2 s: …
std::string to_text(const LaneFailure& failure, const Plan& plan);

}  // namespace loopwright
