/// L di/dt = U - R i - k_e ω,  M = k_t i
///
/// In SI the torque constant k_t (N·m/A) and the back-EMF constant k_e (V·s/rad) of a motor are the same
/// number; either may be given, in the unit of its data sheet, such as mN·m/A or V/rpm. Give both if they
/// were measured and differ. The rotor is an `Inertia` or, with its friction, a subdiagram.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct DcMotor {
  Real resistance, inductance, torque_constant = 0.0, back_emf_constant = 0.0, initial_current = 0.0;
  Real k_t, k_e, per_inductance;
  struct In {
    Real voltage, velocity;
  };
  struct State {
    Real current;
  };
  struct Out {
    Real torque, back_emf, heat;
  };
  static constexpr auto describe() {
    return block(
        "The winding of a direct-current motor, with its torque and its back-EMF.",
        parameter(&DcMotor::resistance, "resistance", "V/A", "Resistance of the winding").not_negative(),
        parameter(&DcMotor::inductance, "inductance", "V*s/A", "Inductance of the winding").positive(),
        parameter(&DcMotor::torque_constant, "torque_constant", "N*m/A",
                  "Torque for each current; when left out that of the back-EMF")
            .not_negative()
            .optional(),
        parameter(&DcMotor::back_emf_constant, "back_emf_constant", "V*s/rad",
                  "Voltage for each velocity; when left out that of the torque")
            .not_negative()
            .optional(),
        parameter(&DcMotor::initial_current, "initial_current", "A", "Current at the start").optional(),
        input(&In::voltage, "voltage", "V", "Voltage at the terminals"),
        input(&In::velocity, "velocity", "rad/s", "Velocity of the rotor"),
        output(&State::current, "current", "A", "Current of the winding"),
        output(&Out::torque, "torque", "N*m", "Torque on the rotor").from_memory(),
        output(&Out::back_emf, "back_emf", "V", "Voltage that the motion induces").from(&In::velocity),
        output(&Out::heat, "heat", "W", "Loss in the winding").from_memory());
  }
  void check(const Checker& checker) const {
    if (torque_constant > 0 || back_emf_constant > 0) return;
    checker.error("torque_constant", "the motor has no constant").expected =
        "torque_constant in N*m/A, or back_emf_constant in V*s/rad";
  }
  void prepare(double) {
    k_t = select(torque_constant > 0.0, torque_constant, back_emf_constant);
    k_e = select(back_emf_constant > 0.0, back_emf_constant, torque_constant);
    per_inductance = 1.0 / inductance;
  }
  void start(State& state) const { state.current = initial_current; }
  void outputs(const In& in, const State& state, Out& out) const {
    out.torque = k_t * state.current;
    out.back_emf = k_e * in.velocity;
    out.heat = resistance * state.current * state.current;
  }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.current = (in.voltage - resistance * state.current - k_e * in.velocity) * per_inductance;
  }
};
LOOPWRIGHT_BLOCK(DcMotor)

}  // namespace loopwright::blocks
