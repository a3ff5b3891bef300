/// y[k] = mean + standard_deviation · n[k],  n white, normal (Box-Muller) or uniform
///
/// The k-th number is a function only of the seed of the diagram, the run, the path of the block and k. It is
/// the same on every machine, at every vector width, for any order of runs, and after a restart from a
/// checkpoint. Noise of one-sided density S (unit²/Hz) up to half the sample rate has the standard deviation
/// √(S / (2 · sample_time)).
#include "engine/block.h"
#include "models/random/philox.h"

namespace loopwright::blocks {

enum class Distribution { normal, uniform };
constexpr auto names_of(Distribution) { return std::array<std::string_view, 2>{"normal", "uniform"}; }

template <class Real> struct Noise {
  Real standard_deviation, mean = 0.0;
  Distribution distribution = Distribution::normal;
  int stream = 0;
  uint64_t key = 0, first_run = 0;
  struct Out {
    Real y;
  };
  struct Memory {
    uint64_t sample;
  };
  static constexpr auto describe() {
    return block(
        "White noise, a new number at every sample.",
        parameter(&Noise::standard_deviation, "standard_deviation", "$y", "Root mean square about the mean")
            .difference()
            .not_negative(),
        parameter(&Noise::mean, "mean", "$y", "Mean value").optional(),
        parameter(&Noise::distribution, "distribution", "", "How the numbers are spread").optional(),
        parameter(&Noise::stream, "stream", "", "Another number gives other noise from the same seed")
            .not_negative()
            .optional(),
        output(&Out::y, "y", "$y", "The noise").from_memory());
  }
  void prepare(const Setup& setup) {
    // Multiplication by an odd number is invertible. It keeps seeds 1, 2, 3 from coinciding with neighboring
    // paths.
    key = (setup.seed * 0x9E3779B97F4A7C15) ^ setup.block_key ^ (uint64_t(stream) << 32);
    first_run = uint64_t(setup.run);
  }
  void outputs(const Memory& memory, Out& out) const {
    Real first, second;
    for (int l = 0; l < lanes_of<Real>; ++l) {
      const UniformPair pair = uniform_pair(key, first_run + uint64_t(l), memory.sample);
      set_lane(first, l, pair.first), set_lane(second, l, pair.second);
    }
    const Real unit =
        distribution == Distribution::uniform
            ? Real((2.0 * first - 1.0) * std::numbers::sqrt3)
            : square_root(Real(-2.0 * natural_logarithm(first))) * cosine(Real(2.0 * pi * second));
    out.y = mean + standard_deviation * unit;
  }
  void update(Memory& memory) const { ++memory.sample; }
};
LOOPWRIGHT_BLOCK(Noise)

}  // namespace loopwright::blocks
