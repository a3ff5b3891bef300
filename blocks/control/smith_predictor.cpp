/// prediction[k] = y[k] + (m[k] - m[k-n]),  M(z) = B(z)/A(z) U(z)
///
/// For a plant with dead time: the controller reads the prediction in the place of the measurement, and sees
/// the plant without its dead time, as far as the model is right. m is the output of the model without dead
/// time, which has the same hold as the plant; n samples of dead time are `delay`. What the plant does beyond
/// the model, y[k] - m[k-n], is passed on. A plant that is not stable by itself cannot be controlled in this
/// way: the model would diverge from it.
///
/// O. J. M. Smith, Chemical Engineering Progress 53 (1957); K. J. Åström, T. Hägglund, Advanced PID Control
/// (2006), section 8.3.
#include <algorithm>
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct SmithPredictor {
  std::vector<Real> numerator, denominator, b, a;
  int delay = 1;
  struct In {
    Real command, measured;
  };
  struct Out {
    Real prediction;
  };
  struct Memory {
    Vector<Real> s, line;  // of the model; its last outputs, the oldest first
  };
  static constexpr auto describe() {
    using B = SmithPredictor;
    return block("Predicts what a plant with dead time will measure, for its controller; sampled.",
                 parameter(&B::numerator, "numerator", "$measured/$command",
                           "Model without dead time: coefficients of 1, 1/z, 1/z² …, the first one 0")
                     .factor(),
                 parameter(&B::denominator, "denominator", "", "Coefficients of 1, 1/z, 1/z² …"),
                 parameter(&B::delay, "delay", "", "Dead time of the plant in samples").between(1, 1000),
                 input(&In::command, "command", "$command", "What the plant is given"),
                 input(&In::measured, "measured", "$measured", "What it gives"),
                 output(&Out::prediction, "prediction", "$measured", "What it would give without dead time")
                     .from(&In::measured),
                 buffer(&Memory::s, &B::order), buffer(&Memory::line, &B::delay));
  }
  int order() const { return std::max(1, int(std::max(numerator.size(), denominator.size())) - 1); }
  void check(const Checker& checker) const {
    if (numerator.size() < 2 || any(numerator[0] != 0.0)) {
      auto& p = checker.error("numerator", "the model acts at once");
      p.expected = "two coefficients or more, the first one 0";
      p.hint = "behind a hold a plant answers one sample later";
    }
    if (denominator.empty() || !any(denominator[0] != 0.0))
      checker.error("denominator", "the output itself has no coefficient").expected =
          "a first coefficient that is not zero";
  }
  void prepare(double) {
    b.assign(size_t(order()) + 1, Real(0.0)), a = b;
    for (size_t i = 0; i < numerator.size(); ++i) b[i] = numerator[i] / denominator[0];
    for (size_t i = 0; i < denominator.size(); ++i) a[i] = denominator[i] / denominator[0];
  }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    out.prediction = in.measured + (memory.s[0] - memory.line[0]);
  }
  void update(const In& in, Memory& memory) const {
    const Real m = memory.s[0];
    std::move(memory.line.begin() + 1, memory.line.end(), memory.line.begin());
    memory.line.back() = m;
    const size_t n = memory.s.size();
    for (size_t i = 0; i + 1 < n; ++i) memory.s[i] = memory.s[i + 1] + b[i + 1] * in.command - a[i + 1] * m;
    memory.s[n - 1] = b[n] * in.command - a[n] * m;
  }
};
LOOPWRIGHT_BLOCK(SmithPredictor)

}  // namespace loopwright::blocks
