/// y = bias + Σ Aᵢ sin(2π fᵢ t + φᵢ)
///
/// Components are given individually, or as a band of equal amplitudes at equal spacing, or both. A band uses
/// Schroeder's phases φₖ = -π k (k - 1) / n, k = 1 … n, which give low peaks (M. R. Schroeder, IEEE Trans.
/// Inf. Theory 16, 1970). The signal is periodic if all frequencies are multiples of one frequency.
#include "blocks/sources/turns.h"

namespace loopwright::blocks {

template <class Real> struct Multisine {
  struct Component {
    Real amplitude, frequency, phase = 0.0;
    static constexpr auto describe() {
      return fields(
          parameter(&Component::amplitude, "amplitude", "$y", "Half of the distance from trough to crest")
              .difference(),
          parameter(&Component::frequency, "frequency", "Hz", "Periods per second").not_negative(),
          parameter(&Component::phase, "phase", "rad", "Phase at time 0").optional());
    }
  };
  struct Band {
    Real lowest = 0.0, highest = 0.0, amplitude = 0.0;
    int count = 0;
    static constexpr auto describe() {
      return fields(
          parameter(&Band::lowest, "from", "Hz", "Lowest frequency").not_negative(),
          parameter(&Band::highest, "to", "Hz", "Highest frequency").not_negative(),
          parameter(&Band::count, "count", "", "Number of components").between(1, 10000),
          parameter(&Band::amplitude, "amplitude", "$y", "Amplitude of each component").difference());
    }
  };
  std::vector<Component> components;
  Band band;
  Real bias = 0.0;
  std::vector<Component> tones;  // components and the band
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block("A sum of sine waves.",
                 parameter(&Multisine::components, "components", "", "Sine waves, one by one").optional(),
                 parameter(&Multisine::band, "band", "", "Sine waves at equal spacing with Schroeder phases")
                     .optional(),
                 parameter(&Multisine::bias, "bias", "$y", "Mean value").optional(),
                 output(&Out::y, "y", "$y", "The sum"));
  }
  void check(const Checker& checker) const {
    if (components.empty() && band.count == 0)
      checker.error("components", "there is nothing to add up").hint =
          "give \"components\", \"band\" or both";
    if (band.count > 1 && !(band.lowest < band.highest))
      checker.error("band", "the band is empty").expected = "from < to";
  }
  void prepare(double) {
    tones = components;
    for (int k = 1; k <= band.count; ++k) {
      const double share = band.count == 1 ? 0.0 : double(k - 1) / double(band.count - 1);
      const double half_turns = std::fmod(double(k) * double(k - 1) / band.count, 2.0);
      tones.push_back(
          {band.amplitude, band.lowest + (band.highest - band.lowest) * share, Real(-pi * half_turns)});
    }
  }
  void outputs(const Instant& now, Out& out) const {
    Real sum = bias;
    for (const Component& tone : tones)
      sum = sum + tone.amplitude * sine_of_turns(Real(tone.frequency * now.time), tone.phase);
    out.y = sum;
  }
  double shortest_period() const {
    double fastest = 0.0;
    for (const Component& tone : tones)
      if (lane(tone.amplitude, 0) != 0.0) fastest = std::max(fastest, lane(tone.frequency, 0));
    return fastest > 0.0 ? 1.0 / fastest : infinity;
  }
};
LOOPWRIGHT_BLOCK(Multisine)

}  // namespace loopwright::blocks
