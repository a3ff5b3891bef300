/// F(x, v) = max(0, 1 - slope |v|) (1 + depth sin(2πx/period + phase)) Σ Aₙ sin(2πn x/τ + φₙ)
#include "engine/block.h"

namespace loopwright::blocks {

/// The attraction between magnets and teeth of an iron-core motor. Slope and modulation are optional. The
/// slope changes the amplitude with speed. The modulation varies it slowly along the track, from magnet to
/// magnet.
template <class Real> struct CoggingForce {
  struct Harmonic {
    int order = 1;
    Real amplitude, phase = 0.0;
    Real wave_number;
    static constexpr auto describe() {
      return fields(parameter(&Harmonic::order, "order", "", "How often the term repeats in a pole pitch")
                        .at_least(1)
                        .optional(),
                    parameter(&Harmonic::amplitude, "amplitude", "$force", "Peak force at rest"),
                    parameter(&Harmonic::phase, "phase", "rad", "Phase at position zero").optional());
    }
  };
  struct Modulation {
    Real depth = 0.0, period = 1.0, phase = 0.0;
    static constexpr auto describe() {
      return fields(
          parameter(&Modulation::depth, "depth", "", "Fraction by which the amplitude varies"),
          parameter(&Modulation::period, "period", "$position", "Distance after which it repeats").positive(),
          parameter(&Modulation::phase, "phase", "rad", "Phase at position zero").optional());
    }
  };
  Real pole_pitch, velocity_slope = 0.0;
  std::vector<Harmonic> harmonics;
  Modulation modulation;
  Real modulation_wave_number;
  bool is_sloped = false, is_modulated = false;  // in any lane
  struct In {
    Real position, velocity;
  };
  struct Out {
    Real force;
  };
  static constexpr auto describe() {
    return block(
        "Attraction between magnets and teeth, periodic in position; subtract it in the sum of forces.",
        parameter(&CoggingForce::pole_pitch, "pole_pitch", "$position",
                  "Distance after which the force repeats")
            .positive(),
        parameter(&CoggingForce::harmonics, "harmonics", "", "Terms of the Fourier series"),
        parameter(&CoggingForce::velocity_slope, "velocity_slope", "s/$position",
                  "Fraction of the amplitude lost per speed; the amplitude stays at 0 from there on")
            .optional(),
        parameter(&CoggingForce::modulation, "modulation", "",
                  "Slow variation of the amplitude along the track")
            .optional(),
        input(&In::position, "position", "$position", "Position of the moving part"),
        input(&In::velocity, "velocity", "$position/s", "Its velocity; needed for a velocity slope")
            .otherwise(0.0),
        output(&Out::force, "force", "$force", "Cogging force: to be subtracted"));
  }
  void prepare(double) {
    for (Harmonic& h : harmonics) h.wave_number = double(h.order) * 2 * pi / pole_pitch;
    modulation_wave_number = 2 * pi / modulation.period;
    is_sloped = any(velocity_slope != 0.0), is_modulated = any(modulation.depth != 0.0);
  }
  void outputs(const In& in, Out& out) const {
    if (harmonics.size() == 1 && !is_sloped && !is_modulated)
      out.force = term(harmonics.front(), in.position);
    else  // copies: otherwise the case of a single harmonic would store both inputs for this call too
      out.force = series(in.position, in.velocity);
  }

 private:
  LW_INLINE Real term(const Harmonic& h, const Real& position) const {
    return h.amplitude * sine(h.wave_number * position + h.phase);
  }
  /// Not inlined, as it would use the registers of the single harmonic.
  [[gnu::noinline]] Real series(Real position, Real velocity) const {
    Real sum = 0.0;
    for (const Harmonic& h : harmonics) sum += term(h, position);
    Real scale = 1.0;
    if (is_sloped) scale = maximum(1.0 - velocity_slope * absolute(velocity), Real(0.0));
    if (is_modulated)
      scale *= 1.0 + modulation.depth * sine(modulation_wave_number * position + modulation.phase);
    return scale * sum;
  }
};
LOOPWRIGHT_BLOCK(CoggingForce)

}  // namespace loopwright::blocks
