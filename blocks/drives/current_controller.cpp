/// v_d = α L_d e_d + I_d - p ω L_q i_q
/// v_q = α L_q e_q + I_q + p ω (L_d i_d + ψ)
/// u = v · min(1, limit / |v|),  I[k+1] = I[k] + α R T (e + (u - v) / (α L))
///
/// Field-oriented control of both currents of a synchronous motor, in the coordinates of its rotor, as Pmsm
/// and ParkTransform have them. e is the reference less the current and α the bandwidth: with the true
/// parameters, a short sample time T and enough voltage each current follows its reference with the time
/// constant 1/α. The terms with the speed of the field p ω cancel the coupling of both currents and the
/// voltage that the magnets induce. Where the voltage is limited, its direction is kept, and the integrals
/// follow the error that the limited voltage could have served. L. Harnefors, H.-P. Nee, Model-based current
/// control of AC machines using the internal model control method, IEEE Transactions on Industry Applications
/// 34 (1998).
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct CurrentController {
  Real resistance, inductance_d, inductance_q, flux = 0.0, bandwidth, voltage_limit = infinity;
  int pole_pairs = 1;
  Real gain_d, gain_q, integral_gain;  // α L [V/A]; α R T [V/A]
  struct In {
    Real reference_d, reference_q, current_d, current_q, velocity;
  };
  struct Out {
    Real voltage_d, voltage_q;
  };
  struct Memory {
    Real integral_d, integral_q;
  };
  static constexpr auto describe() {
    return block(
        "Controls both currents of a synchronous motor in rotor coordinates, sampled.",
        parameter(&CurrentController::resistance, "resistance", "V/A", "Resistance of a phase")
            .not_negative(),
        parameter(&CurrentController::inductance_d, "inductance_d", "V*s/A", "Inductance along the magnets")
            .positive(),
        parameter(&CurrentController::inductance_q, "inductance_q", "V*s/A", "Inductance across the magnets")
            .positive(),
        parameter(&CurrentController::flux, "flux", "V*s", "Amplitude of the magnets' flux in a phase")
            .not_negative()
            .optional(),
        parameter(&CurrentController::pole_pairs, "pole_pairs", "",
                  "Turns of the field for one turn of the shaft")
            .at_least(1)
            .optional(),
        parameter(&CurrentController::bandwidth, "bandwidth", "rad/s",
                  "How fast a current follows its reference")
            .positive(),
        parameter(
            &CurrentController::voltage_limit, "voltage_limit", "V",
            "Greatest amplitude of the phase voltage; the direct-current supply divided by the root of 3")
            .positive()
            .optional(),
        input(&In::reference_d, "reference_d", "A", "Wanted current along the magnets").otherwise(0.0),
        input(&In::reference_q, "reference_q", "A", "Wanted current across the magnets"),
        input(&In::current_d, "current_d", "A", "Measured current along the magnets"),
        input(&In::current_q, "current_q", "A", "Measured current across the magnets"),
        input(&In::velocity, "velocity", "rad/s", "Velocity of the shaft; decouples both currents")
            .otherwise(0.0),
        output(&Out::voltage_d, "voltage_d", "V", "Voltage along the magnets"),
        output(&Out::voltage_q, "voltage_q", "V", "Voltage across the magnets"));
  }
  void prepare(double sample_time) {
    gain_d = bandwidth * inductance_d, gain_q = bandwidth * inductance_q;
    integral_gain = bandwidth * resistance * sample_time;
  }
  Out unlimited(const In& in, const Memory& memory) const {
    const Real field = double(pole_pairs) * in.velocity;
    return {
        gain_d * (in.reference_d - in.current_d) + memory.integral_d - field * inductance_q * in.current_q,
        gain_q * (in.reference_q - in.current_q) + memory.integral_q +
            field * (inductance_d * in.current_d + flux)};
  }
  /// The fraction of the voltage that the supply gives.
  Real share(const Out& v) const {
    return minimum(Real(1.0),
                   voltage_limit / square_root(v.voltage_d * v.voltage_d + v.voltage_q * v.voltage_q));
  }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    out = unlimited(in, memory);
    const Real given = share(out);
    out = {given * out.voltage_d, given * out.voltage_q};
  }
  void update(const In& in, Memory& memory) const {
    const Out v = unlimited(in, memory);
    const Real lacking = share(v) - 1.0;
    memory.integral_d =
        memory.integral_d + integral_gain * (in.reference_d - in.current_d + lacking * v.voltage_d / gain_d);
    memory.integral_q =
        memory.integral_q + integral_gain * (in.reference_q - in.current_q + lacking * v.voltage_q / gain_q);
  }
};
LOOPWRIGHT_BLOCK(CurrentController)

}  // namespace loopwright::blocks
