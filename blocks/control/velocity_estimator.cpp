/// filtered_derivative: V/X = ω s/(s+ω), by Tustin's rule;  backward_difference: v[k] = (x[k] - x[k-n]) / (n
/// T)
///
/// The backward difference is the mean velocity over the last n samples. It lags by n T/2, and an encoder
/// step of δ appears as δ/(n T). The filter lags by 1/ω. Both start at rest at `initial`.
#include "engine/block.h"
#include "models/signal/first_order.h"

namespace loopwright::blocks {

enum class VelocityMethod { filtered_derivative, backward_difference };
constexpr auto names_of(VelocityMethod) {
  return std::array<std::string_view, 2>{"filtered_derivative", "backward_difference"};
}

template <class Real> struct VelocityEstimator {
  VelocityMethod method = VelocityMethod::filtered_derivative;
  Real cutoff = 0.0, initial = 0.0;
  int samples = 1;
  TustinDerivative<Real> filter;
  double per_window = 0;  // 1/(n T), 1/s
  struct In {
    Real position;
  };
  struct Out {
    Real velocity;
  };
  struct Memory {
    Vector<Real> positions;
    Real velocity;
    int64_t oldest;
  };
  static constexpr auto describe() {
    using B = VelocityEstimator;
    return block("Velocity from sampled positions.",
                 parameter(&B::method, "method", "", "How it is formed").optional(),
                 parameter(&B::cutoff, "cutoff", "rad/s", "Bandwidth of the filtered derivative")
                     .not_negative()
                     .optional(),
                 parameter(&B::samples, "samples", "", "Samples that the backward difference spans")
                     .between(1, 1000000)
                     .optional(),
                 parameter(&B::initial, "initial", "$position", "Position before the start").optional(),
                 input(&In::position, "position", "$position", "Measured position"),
                 output(&Out::velocity, "velocity", "$position/s", "Estimated velocity"),
                 buffer(&Memory::positions, &B::length));
  }
  int length() const { return method == VelocityMethod::backward_difference ? samples : 1; }
  void check(const Checker& checker) const {
    const bool filters = method == VelocityMethod::filtered_derivative;
    if (filters && !(cutoff > 0.0)) {
      checker.error("cutoff", "the filtered derivative needs a bandwidth").expected =
          "a number above 0, in rad/s";
    }
    if (filters && samples != 1)
      checker.error("samples", "the filtered derivative uses the last sample alone").expected = "1";
  }
  void prepare(double sample_time) {
    filter = TustinDerivative<Real>::of(cutoff, sample_time);
    per_window = 1.0 / (samples * sample_time);
  }
  void start(Memory& memory) const {
    for (Real& position : memory.positions) position = initial;
  }
  Real velocity(const In& in, const Memory& memory) const {
    const Real before = memory.positions[size_t(memory.oldest)];
    if (method == VelocityMethod::backward_difference) return (in.position - before) * per_window;
    return filter.next(in.position, before, memory.velocity);
  }
  void outputs(const In& in, const Memory& memory, Out& out) const { out.velocity = velocity(in, memory); }
  void update(const In& in, Memory& memory) const {
    memory.velocity = velocity(in, memory);
    memory.positions[size_t(memory.oldest)] = in.position;
    memory.oldest = memory.oldest + 1 < length() ? memory.oldest + 1 : 0;
  }
};
LOOPWRIGHT_BLOCK(VelocityEstimator)

}  // namespace loopwright::blocks
