/// r[k] = q₁ r[k-N+1] + q₀ r[k-N] + q₁ r[k-N-1] + gain · e[k-N+lead],  q₀ = 1 - 2 q₁
///
/// Learns the command that cancels an error of the period N: add r to the command, or to the reference, of a
/// stable loop. With S the loop's response from r to -e, the learning converges if |Q (1 - gain z^lead S)| <
/// 1 at all frequencies; `lead` makes up for the delay of S, and the smoothing Q, which has no phase, gives
/// up the highest frequencies, where S is not known. While `enable` is false, r is 0 and what was learned is
/// kept.
///
/// M. Tomizuka, T.-C. Tsao, K.-K. Chew, ASME Journal of Dynamic Systems, Measurement and Control 111 (1989).
#include <algorithm>
#include "blocks/logic/truth.h"

namespace loopwright::blocks {

template <class Real> struct RepetitiveController {
  int period = 2, lead = 0;
  Real gain, smoothing = 0.25, centre;
  struct In {
    Real error, enable;
  };
  struct Out {
    Real correction;
  };
  struct Memory {
    Vector<Real> corrections, errors;  // r[k-N-1] … r[k-1]; e[k-N+lead] … e[k-1]; the oldest first
  };
  static constexpr auto describe() {
    using B = RepetitiveController;
    return block(
        "Learns to cancel an error that returns with a known period; sampled.",
        parameter(&B::period, "period", "", "Samples in a period").between(2, 100000),
        parameter(&B::lead, "lead", "", "Samples by which the learned error is advanced")
            .at_least(0)
            .optional(),
        parameter(&B::gain, "gain", "$correction/$error", "Share of the error that is learned in a period"),
        parameter(&B::smoothing, "smoothing", "", "Weight of each neighbour in time")
            .between(0, 0.25)
            .optional(),
        input(&In::error, "error", "$error", "What is left: reference minus measurement"),
        input(&In::enable, "enable", "", "Logic value: it learns and acts while it is true").otherwise(1),
        output(&Out::correction, "correction", "$correction", "To be added to the command").from(&In::enable),
        buffer(&Memory::corrections, &B::kept_corrections), buffer(&Memory::errors, &B::kept_errors));
  }
  int kept_corrections() const { return period + 1; }
  int kept_errors() const { return std::max(1, period - lead); }
  void check(const Checker& checker) const {
    if (lead < period) return;
    auto& p = checker.error("lead", "the error cannot be advanced by a period or more");
    p.expected = "less than " + std::to_string(period), p.found = std::to_string(lead);
  }
  void prepare(double) { centre = 1.0 - 2.0 * smoothing; }
  Fault outputs(const In& in, const Memory& memory, Out& out) const {
    out.correction = select(is_true(in.enable), next(memory), Real(0.0));
    return fault_unless_logic(in.enable);
  }
  void update(const In& in, Memory& memory) const {
    const Real now = next(memory);
    const auto on = is_true(in.enable);
    push(now, on, memory.corrections);
    push(in.error, on, memory.errors);
  }

 private:
  Real next(const Memory& memory) const {
    const Vector<Real>& r = memory.corrections;
    return smoothing * (r[0] + r[2]) + centre * r[1] + gain * memory.errors[0];
  }
  static void push(const Real& value, const MaskOf<Real>& on, Vector<Real>& line) {
    for (size_t i = 0; i + 1 < line.size(); ++i) line[i] = select(on, line[i + 1], line[i]);
    line.back() = select(on, value, line.back());
  }
};
LOOPWRIGHT_BLOCK(RepetitiveController)

}  // namespace loopwright::blocks
