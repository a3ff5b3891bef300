/// y = q round((x + x₀ + Σ Aₙ sin(2πn x/L + φₙ)) / q)
#include "blocks/math/sides.h"

namespace loopwright::blocks {

/// A position encoder with counts of width q (rounded half to even), an offset, and an error that is periodic
/// in the grating. Use resolution 0 for a sensor without counts. Noise is a separate block. The encoder is
/// read at samples: give it the sample_time of the controller. Without one, every count is an event for a
/// variable-step solver, and the count is held within a fixed step.
template <class Real> struct Encoder {
  struct Harmonic {
    int order = 1;
    Real amplitude, phase = 0.0;
    static constexpr auto describe() {
      return fields(parameter(&Harmonic::order, "order", "", "How often the error repeats in a pitch")
                        .at_least(1)
                        .optional(),
                    parameter(&Harmonic::amplitude, "amplitude", "$position", "Peak error").difference(),
                    parameter(&Harmonic::phase, "phase", "rad", "Phase at position zero").optional());
    }
  };
  Real resolution, offset = 0.0, pitch = 0.0;
  std::vector<Harmonic> periodic_error;
  Real per_count, wave_number;
  struct In {
    Real position;
  };
  struct Out {
    Real position;
  };
  struct Mode {
    Real count;
  };
  struct Crossings {
    Real count;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block(
        "Measures a position in counts, with offset and periodic error.",
        parameter(&Encoder::resolution, "resolution", "$position", "Width of a count; 0: continuous")
            .difference()
            .not_negative(),
        parameter(&Encoder::offset, "offset", "$position", "Error of the zero").difference().optional(),
        parameter(&Encoder::pitch, "pitch", "$position", "Distance after which the periodic error repeats")
            .not_negative()
            .optional(),
        parameter(&Encoder::periodic_error, "periodic_error", "", "Terms of the Fourier series of the error")
            .optional(),
        input(&In::position, "position", "$position", "True position"),
        output(&Out::position, "position", "$position", "Measured position"),
        crossing(&Crossings::count, "count"));
  }
  void check(const Checker& checker) const {
    if (periodic_error.empty() || pitch > 0) return;
    checker.error("pitch", "a periodic error needs the pitch after which it repeats").expected =
        "a pitch above 0";
  }
  void prepare(double) {
    per_count = select(resolution > 0.0, 1.0 / resolution, Real(0.0));
    wave_number = select(pitch > 0.0, 2 * pi / pitch, Real(0.0));
  }
  Real seen(const Real& position) const {
    Real sum = position + offset;
    for (const Harmonic& h : periodic_error)
      sum += h.amplitude * sine(double(h.order) * wave_number * position + h.phase);
    return sum;
  }
  void decide(const In& in, Mode& mode) const { mode.count = round_even(seen(in.position) * per_count); }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    out.position = select(resolution > 0.0, resolution * mode.count, seen(in.position));
  }
  bool may_cross() const { return any(resolution > 0.0); }
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    const Real from_centre = absolute(seen(in.position) * per_count - mode.count);
    value.count = not_below_zero(Real(0.5 - from_centre));
  }
};
LOOPWRIGHT_BLOCK(Encoder)

}  // namespace loopwright::blocks
