/// L_d di_d/dt = u_d - R i_d + p ω L_q i_q,  L_q di_q/dt = u_q - R i_q - p ω (L_d i_d + ψ),
/// M = 3/2 p (ψ i_q + (L_d - L_q) i_d i_q)
///
/// A permanent-magnet synchronous motor in the coordinates of its rotor: d along the magnets, q ahead of it
/// by a right angle, of amplitudes (not of power), as ParkTransform gives them. ω is the velocity of the
/// shaft, p ω that of the field. ψ is the amplitude of the flux of the magnets in a phase: 2/3 of the torque
/// for each ampere, divided by p, or the amplitude of the phase voltage at idle divided by p ω. No
/// saturation, no iron loss, no harmonics. P. C. Krause, O. Wasynczuk, S. D. Sudhoff, Analysis of Electric
/// Machinery (2013), chapter 4.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Pmsm {
  Real resistance, inductance_d, inductance_q, flux;
  int pole_pairs = 1;
  Real per_d, per_q;
  struct In {
    Real voltage_d, voltage_q, velocity;
  };
  struct State {
    Real current_d, current_q;
  };
  struct Out {
    Real torque, heat;
  };
  static constexpr auto describe() {
    return block(
        "The windings of a permanent-magnet synchronous motor, in rotor coordinates.",
        parameter(&Pmsm::resistance, "resistance", "V/A", "Resistance of a phase").not_negative(),
        parameter(&Pmsm::inductance_d, "inductance_d", "V*s/A", "Inductance along the magnets").positive(),
        parameter(&Pmsm::inductance_q, "inductance_q", "V*s/A", "Inductance across the magnets").positive(),
        parameter(&Pmsm::flux, "flux", "V*s", "Amplitude of the magnets' flux in a phase").not_negative(),
        parameter(&Pmsm::pole_pairs, "pole_pairs", "", "Turns of the field for one turn of the shaft")
            .at_least(1),
        input(&In::voltage_d, "voltage_d", "V", "Voltage along the magnets"),
        input(&In::voltage_q, "voltage_q", "V", "Voltage across the magnets"),
        input(&In::velocity, "velocity", "rad/s", "Velocity of the shaft"),
        output(&State::current_d, "current_d", "A", "Current along the magnets"),
        output(&State::current_q, "current_q", "A", "Current across the magnets"),
        output(&Out::torque, "torque", "N*m", "Torque on the rotor").from_memory(),
        output(&Out::heat, "heat", "W", "Loss in the windings").from_memory());
  }
  void prepare(double) { per_d = 1.0 / inductance_d, per_q = 1.0 / inductance_q; }
  void outputs(const State& state, Out& out) const {
    const Real d = state.current_d, q = state.current_q;
    out.torque = 1.5 * double(pole_pairs) * (flux * q + (inductance_d - inductance_q) * d * q);
    out.heat = 1.5 * resistance * (d * d + q * q);
  }
  void derivatives(const In& in, const State& state, State& rate) const {
    const Real d = state.current_d, q = state.current_q, field = double(pole_pairs) * in.velocity;
    rate.current_d = (in.voltage_d - resistance * d + field * inductance_q * q) * per_d;
    rate.current_q = (in.voltage_q - resistance * q - field * (inductance_d * d + flux)) * per_q;
  }
};
LOOPWRIGHT_BLOCK(Pmsm)

}  // namespace loopwright::blocks
