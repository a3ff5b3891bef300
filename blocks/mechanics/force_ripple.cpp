/// F = u (1 + Σ dₙ sin(2πn x/τ + φₙ))
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct ForceRipple {
  struct Harmonic {
    int order = 1;
    Real depth, phase = 0.0;
    static constexpr auto describe() {
      return fields(parameter(&Harmonic::order, "order", "", "How often the term repeats in a pole pitch")
                        .at_least(1)
                        .optional(),
                    parameter(&Harmonic::depth, "depth", "", "Peak deviation as a fraction of the command"),
                    parameter(&Harmonic::phase, "phase", "rad", "Phase at position zero").optional());
    }
  };
  Real pole_pitch;
  std::vector<Harmonic> harmonics;
  Real wave_number;
  struct In {
    Real command, position;
  };
  struct Out {
    Real force;
  };
  static constexpr auto describe() {
    return block("A motor whose force constant varies with position.",
                 parameter(&ForceRipple::pole_pitch, "pole_pitch", "$position",
                           "Distance after which the ripple repeats")
                     .positive(),
                 parameter(&ForceRipple::harmonics, "harmonics", "", "Terms of the Fourier series"),
                 input(&In::command, "command", "$force", "Force that is asked for"),
                 input(&In::position, "position", "$position", "Position of the moving part"),
                 output(&Out::force, "force", "$force", "Force that the motor gives"));
  }
  void prepare(double) { wave_number = 2 * pi / pole_pitch; }
  void outputs(const In& in, Out& out) const {
    const Real angle = wave_number * in.position;
    Real factor = 1.0;
    for (const Harmonic& h : harmonics) factor += h.depth * sine(double(h.order) * angle + h.phase);
    out.force = in.command * factor;
  }
};
LOOPWRIGHT_BLOCK(ForceRipple)

}  // namespace loopwright::blocks
