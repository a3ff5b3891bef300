/// Many runs of one plan in parallel on SIMD lanes, for sweeps, fits and ensembles. Each lane has its own
/// parameters and noise, and gives the same bits as a scalar run.
///
/// Lanes are implemented in modules, one for each instruction set, loaded only if the machine supports it:
/// code for wide vectors is never linked into the program itself. Plain structs and blocks from libraries run
/// lane by lane.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include "engine/run/run.h"

namespace loopwright {

/// The reason why a lane stopped.
struct LaneFailure {
  double time = 0;               ///< s
  int block = -1;                ///< that faulted, or that holds the non-finite number
  Number number = -1;            ///< that is non-finite; -1: a fault, or a state that is no output
  const char* reason = nullptr;  ///< of a fault; null: a number became non-finite
};

class LaneRun {
 public:
  virtual ~LaneRun() = default;
  virtual int lanes() const = 0;
  /// Whether a block of the plan runs on SIMD lanes; otherwise it runs lane by lane.
  virtual bool is_lane_wise(int block) const = 0;
  /// A tunable number of one lane by path, "stage.cogging.harmonics.0.amplitude", to be set before reset;
  /// null if there is none or it is structural. The pointer is valid for the lifetime of the run.
  virtual double* parameter(std::string_view path, int lane) = 0;
  /// Returns to the start with the present parameters. Lane l is run number `identity.run` + l.
  virtual void reset(const RunIdentity& identity) = 0;
  /// Runs from the present time to the stop time. `row(time)`, if given, is called at every row of the
  /// recording and may end the run by returning false. The run ends early if all lanes have failed.
  virtual void run(const std::function<bool(double time)>& row = {}) = 0;
  virtual double time() const = 0;  ///< s
  // The parts of a step, for a program that sets the signals itself.
  /// Decisions, outputs and sampled updates at the present tick, as if the time were `at` [s].
  virtual void evaluate(double at) = 0;
  /// Advances the states by a solver step of at most `ticks`; returns the number of ticks advanced.
  virtual int64_t integrate(int64_t ticks) = 0;
  /// The present signals and states: to[i · lanes() + lane]. Undefined in a lane that has failed.
  virtual void read(std::span<const Number> numbers, double* to) const = 0;
  /// Appends what a lane of the first arena remembers in accepted memory: the numbers of its blocks in order.
  /// Only of plans whose blocks with memory all run on SIMD lanes.
  virtual void accepted_memory(int lane, std::vector<double>& to) const = 0;
  /// Lanes that have failed, one bit each; the others continue.
  virtual uint64_t failed() const = 0;
  virtual LaneFailure failure(int lane) const = 0;
};

enum class InstructionSet { scalar, avx2, avx512 };
inline constexpr std::array all_instruction_sets{InstructionSet::scalar, InstructionSet::avx2,
                                                 InstructionSet::avx512};
/// The number of runs in one arena, which every block computes together: on several registers, so that the
/// arithmetic units always have independent operations.
constexpr int lanes_in_arena(InstructionSet set) { return set == InstructionSet::scalar ? 1 : 32; }
constexpr std::string_view to_name(InstructionSet set) {
  return set == InstructionSet::avx512 ? "avx512" : set == InstructionSet::avx2 ? "avx2" : "scalar";
}

/// The maximum number of lanes of one run: one bit each in a mask.
inline constexpr int most_lanes = 64;

/// The reason why the plan cannot run in parallel with a fixed step: the block or setting that requires
/// separate runs. Empty: it can.
std::string lanes_forbidden_by(const Plan& plan);

/// The reason why lanes of this set cannot run here: the processor does not support it, or the module is
/// missing. Empty: they can.
std::string lanes_unavailable(InstructionSet set);

/// The set with the most lanes that this machine can run.
InstructionSet widest_instruction_set();

/// A run with lanes_in_arena · arenas lanes; the plan must outlive it. A scalar run has one lane. Throws
/// std::runtime_error with the reason if the plan does not allow lanes, if they are unavailable, or if they
/// are too many.
std::unique_ptr<LaneRun> make_lane_run(const Plan& plan, InstructionSet set, int arenas);

/// "coulomb" stopped the run at t = 0.2 s: …
std::string to_text(const LaneFailure& failure, const Plan& plan);

}  // namespace loopwright
