/// Plants of several kinds: what they may lack is a function that the caller gives.
#pragma once
#include "tests/tools/diagnose/plant.h"

namespace loopwright {

using Law = std::function<double(double, double)>;
inline double nothing(double, double) { return 0; }

/// A DC motor; current and angle are measured.
struct Motor {
  double resistance = 1.2, inductance = 2e-3, constant = 0.05, inertia = 2e-5, damping = 1e-5;
  Law voltage_drop = nothing;  ///< of current and speed
  Law torque = nothing;        ///< that resists, of speed and angle
};
inline Plant motor(const Motor& m, uint64_t seed) {
  Plant plant;
  plant.diagram = R"json({"loopwright": 1, "title": "A DC motor",
  "parameters": {"resistance": {"value": 1.2, "unit": "Ohm"}, "inductance": {"value": 2e-3, "unit": "H"},
                 "constant": {"value": 0.05, "unit": "V*s/rad"}, "inertia": {"value": 2e-5, "unit": "N*m*s^2/rad"},
                 "damping": {"value": 1e-5, "unit": "N*m*s/rad"}},
  "solver": {"method": "rk4", "step": 0.0001, "stop": 1},
  "blocks": {
    "zero":      {"type": "Constant", "value": {"value": 0, "unit": "V"}},
    "amplifier": {"type": "Gain", "gain": 1, "in": {"u": "zero.y"}},
    "resistor":  {"type": "Gain", "gain": "=resistance", "in": {"u": "current.y"}},
    "emf":       {"type": "Gain", "gain": "=constant", "in": {"u": "rotor.velocity"}},
    "voltages":  {"type": "Sum", "signs": "+--", "in": {"terms": ["amplifier.y", "resistor.y", "emf.y"]}},
    "winding":   {"type": "Gain", "gain": "=1/inductance", "in": {"u": "voltages.sum"}},
    "current":   {"type": "Integrator", "in": {"u": "winding.y"}},
    "torque":    {"type": "Gain", "gain": {"value": 0.05, "unit": "N*m/A"}, "in": {"u": "current.y"}},
    "viscous":   {"type": "ViscousFriction", "damping": "=damping", "in": {"velocity": "rotor.velocity"}},
    "torques":   {"type": "Sum", "signs": "+-", "in": {"terms": ["torque.y", "viscous.force"]}},
    "rotor":     {"type": "Mass", "mass": "=inertia", "in": {"force": "torques.sum"}}
  }})json";
  plant.drive = R"("amplifier.u": {"column": "u", "unit": "V"})";
  plant.compare =
      R"("current.y": {"column": "y0", "unit": "A"}, "rotor.position": {"column": "y1", "unit": "rad"})";
  plant.rate = [m](const Numbers& x, double u, const Numbers& w) {
    const double i = x[0], angle = x[1], speed = x[2];
    return Numbers{
        (u + w[0] - m.resistance * i - m.constant * speed - m.voltage_drop(i, speed)) / m.inductance, speed,
        (m.constant * i + w[1] - m.damping * speed - m.torque(speed, angle)) / m.inertia};
  };
  plant.outputs = [](const Numbers& x) { return Numbers{x[0], x[1]}; };
  plant.input = [steps = random_steps(0.06, seed)](double t) { return 6 * steps(t); };
  plant.initial = {0, 0, 0}, plant.process_noise = {0.02, 2e-4}, plant.measurement_noise = {2e-3, 2e-4};
  plant.sample_time = 1e-3, plant.seed = seed;
  return plant;
}

/// Behind an amplifier that follows its command with a lag: one more state.
inline Plant lagging_motor(double time_constant, uint64_t seed) {
  Plant plant = motor({}, seed);
  plant.rate = [rate = plant.rate, time_constant](const Numbers& x, double u, const Numbers& w) {
    Numbers slope = rate({x[0], x[1], x[2]}, x[3], w);
    slope.push_back((u - x[3]) / time_constant);
    return slope;
  };
  plant.initial.push_back(0), plant.rows = 1200;
  return plant;
}

/// Two bodies that exchange heat; both temperatures are measured.
struct Thermal {
  double first_loss = 0.5, second_loss = 0.3, coupling = 0.8;
  Law first_heat = nothing, second_heat = nothing;  ///< lost, of both temperatures
};
inline Plant thermal(const Thermal& m, uint64_t seed) {
  Plant plant;
  plant.diagram = R"json({"loopwright": 1, "title": "Two bodies",
  "parameters": {"first_loss": {"value": 0.5, "unit": "W/K"}, "second_loss": {"value": 0.3, "unit": "W/K"},
                 "coupling": {"value": 0.8, "unit": "W/K"}},
  "solver": {"method": "rk4", "step": 0.1, "stop": 1},
  "blocks": {
    "off":     {"type": "Constant", "value": {"value": 0, "unit": "W"}},
    "heater":  {"type": "Gain", "gain": 1, "in": {"u": "off.y"}},
    "ambient": {"type": "Constant", "value": {"value": 293, "unit": "K"}},
    "over1":   {"type": "Sum", "signs": "+-", "in": {"terms": ["body1.y", "ambient.y"]}},
    "over2":   {"type": "Sum", "signs": "+-", "in": {"terms": ["body2.y", "ambient.y"]}},
    "between": {"type": "Sum", "signs": "+-", "in": {"terms": ["body1.y", "body2.y"]}},
    "loss1":   {"type": "Gain", "gain": "=first_loss", "in": {"u": "over1.sum"}},
    "loss2":   {"type": "Gain", "gain": "=second_loss", "in": {"u": "over2.sum"}},
    "flow":    {"type": "Gain", "gain": "=coupling", "in": {"u": "between.sum"}},
    "heat1":   {"type": "Sum", "signs": "+--", "in": {"terms": ["heater.y", "loss1.y", "flow.y"]}},
    "heat2":   {"type": "Sum", "signs": "+-", "in": {"terms": ["flow.y", "loss2.y"]}},
    "rise1":   {"type": "Gain", "gain": {"value": 0.02, "unit": "K/J"}, "in": {"u": "heat1.sum"}},
    "rise2":   {"type": "Gain", "gain": {"value": 0.01, "unit": "K/J"}, "in": {"u": "heat2.sum"}},
    "body1":   {"type": "Integrator", "initial": {"value": 293, "unit": "K"}, "in": {"u": "rise1.y"}},
    "body2":   {"type": "Integrator", "initial": {"value": 293, "unit": "K"}, "in": {"u": "rise2.y"}}
  }})json";
  plant.drive = R"("heater.u": {"column": "u", "unit": "W"})";
  plant.compare = R"("body1.y": {"column": "y0", "unit": "K"}, "body2.y": {"column": "y1", "unit": "K"})";
  plant.rate = [m](const Numbers& x, double u, const Numbers& w) {
    const double a = x[0], b = x[1], flow = m.coupling * (a - b);
    return Numbers{0.02 * (u + w[0] - m.first_loss * (a - 293) - flow - m.first_heat(a, b)),
                   0.01 * (flow + w[1] - m.second_loss * (b - 293) - m.second_heat(a, b))};
  };
  plant.outputs = [](const Numbers& x) { return x; };
  plant.input = [steps = random_steps(120, seed)](double t) { return 120 + 120 * steps(t); };
  plant.initial = {293, 293}, plant.process_noise = {0.5, 0.5}, plant.measurement_noise = {0.02, 0.02};
  plant.sample_time = 2, plant.seed = seed;
  return plant;
}

/// A heated plate. The experiment drives its port: no Sum stands before it.
inline Plant heated_plate(const Law& lost, uint64_t seed) {
  Plant plant;
  plant.diagram = R"json({"loopwright": 1, "title": "A plate",
  "parameters": {"loss": {"value": 0.5, "unit": "W/K"}},
  "solver": {"method": "rk4", "step": 0.1, "stop": 1},
  "blocks": {
    "heater": {"type": "Constant", "value": {"value": 0, "unit": "W"}},
    "plate":  {"type": "ThermalNode", "capacity": {"value": 220, "unit": "J/K"}, "conductance": "=loss",
               "in": {"heat": "heater.y"}}
  }})json";
  plant.drive = R"("plate.heat": {"column": "u", "unit": "W"})";
  plant.compare = R"("plate.temperature": {"column": "y0", "unit": "K"})";
  plant.rate = [lost](const Numbers& x, double u, const Numbers& w) {
    return Numbers{(u + w[0] - 0.5 * (x[0] - 293.15) - lost(x[0], 0)) / 220};
  };
  plant.outputs = [](const Numbers& x) { return x; };
  plant.input = [steps = random_steps(180, seed)](double t) { return 60 + 60 * steps(t); };
  plant.initial = {293.15}, plant.process_noise = {0.2}, plant.measurement_noise = {0.02};
  plant.sample_time = 2, plant.rows = 1800, plant.seed = seed;
  return plant;
}

/// Two tanks, one above the other; both levels are measured.
struct Tanks {
  double first_outlet = 0.006, second_outlet = 0.005;
  Law lost = nothing;     ///< from the first tank, of both levels
  Law spilled = nothing;  ///< from the first tank into the second
};
inline Plant tanks(const Tanks& m, uint64_t seed) {
  Plant plant;
  plant.diagram = R"json({"loopwright": 1, "title": "Two tanks",
  "parameters": {"first_outlet": {"value": 0.006, "unit": "m^2.5/s"}, "second_outlet": {"value": 0.005, "unit": "m^2.5/s"},
                 "area": {"value": 0.1, "unit": "m^2"}, "pump": {"value": 1e-3, "unit": "m^3/(V*s)"}},
  "solver": {"method": "rk4", "step": 0.1, "stop": 1},
  "blocks": {
    "off":      {"type": "Constant", "value": {"value": 0, "unit": "V"}},
    "pump":     {"type": "Gain", "gain": "=pump", "in": {"u": "off.y"}},
    "head1":    {"type": "Expression", "formula": "sqrt(abs(h))", "names": ["h"], "in": {"arguments": ["level1.y"]}},
    "head2":    {"type": "Expression", "formula": "sqrt(abs(h))", "names": ["h"], "in": {"arguments": ["level2.y"]}},
    "outlet1":  {"type": "Gain", "gain": "=first_outlet", "in": {"u": "head1.y"}},
    "outlet2":  {"type": "Gain", "gain": "=second_outlet", "in": {"u": "head2.y"}},
    "balance1": {"type": "Sum", "signs": "+-", "in": {"terms": ["pump.y", "outlet1.y"]}},
    "balance2": {"type": "Sum", "signs": "+-", "in": {"terms": ["outlet1.y", "outlet2.y"]}},
    "rise1":    {"type": "Gain", "gain": "=1/area", "in": {"u": "balance1.sum"}},
    "rise2":    {"type": "Gain", "gain": "=1/area", "in": {"u": "balance2.sum"}},
    "level1":   {"type": "Integrator", "initial": {"value": 0.3, "unit": "m"}, "in": {"u": "rise1.y"}},
    "level2":   {"type": "Integrator", "initial": {"value": 0.3, "unit": "m"}, "in": {"u": "rise2.y"}}
  }})json";
  plant.drive = R"("pump.u": {"column": "u", "unit": "V"})";
  plant.compare = R"("level1.y": {"column": "y0", "unit": "m"}, "level2.y": {"column": "y1", "unit": "m"})";
  plant.rate = [m](const Numbers& x, double u, const Numbers& w) {
    const double out = m.first_outlet * std::sqrt(std::abs(x[0])), spilled = m.spilled(x[0], x[1]);
    return Numbers{(1e-3 * u + w[0] - out - spilled - m.lost(x[0], x[1])) / 0.1,
                   (out + spilled + w[1] - m.second_outlet * std::sqrt(std::abs(x[1]))) / 0.1};
  };
  plant.outputs = [](const Numbers& x) { return x; };
  plant.input = [steps = random_steps(60, seed)](double t) { return 4 + 2.5 * steps(t); };
  plant.initial = {0.3, 0.3}, plant.process_noise = {2e-5, 2e-5}, plant.measurement_noise = {1e-3, 1e-3};
  plant.sample_time = 2, plant.seed = seed;
  return plant;
}

/// A mass on a spring; position measured.
struct Oscillator {
  double mass = 0.5, damping = 1.5, stiffness = 200;
  Law force = nothing;  ///< that resists, of position and velocity
};
inline Plant oscillator(const Oscillator& m, uint64_t seed) {
  Plant plant;
  plant.diagram = R"json({"loopwright": 1, "title": "A mass on a spring",
  "parameters": {"mass": {"value": 0.5, "unit": "kg"}, "damping": {"value": 1.5, "unit": "N*s/m"},
                 "stiffness": {"value": 200, "unit": "N/m"}},
  "solver": {"method": "rk4", "step": 0.001, "stop": 1},
  "blocks": {
    "zero":    {"type": "Constant", "value": {"value": 0, "unit": "N"}},
    "shaker":  {"type": "Gain", "gain": 1, "in": {"u": "zero.y"}},
    "damper":  {"type": "ViscousFriction", "damping": "=damping", "in": {"velocity": "mass.velocity"}},
    "spring":  {"type": "Spring", "stiffness": "=stiffness", "in": {"position": "mass.position"}},
    "net":     {"type": "Sum", "signs": "+--", "in": {"terms": ["shaker.y", "damper.force", "spring.force"]}},
    "mass":    {"type": "Mass", "mass": "=mass", "in": {"force": "net.sum"}}
  }})json";
  plant.drive = R"("shaker.u": {"column": "u", "unit": "N"})";
  plant.compare = R"("mass.position": {"column": "y0", "unit": "m"})";
  plant.rate = [m](const Numbers& x, double u, const Numbers& w) {
    return Numbers{x[1], (u + w[0] - m.damping * x[1] - m.stiffness * x[0] - m.force(x[0], x[1])) / m.mass};
  };
  plant.outputs = [](const Numbers& x) { return Numbers{x[0]}; };
  plant.input = [steps = random_steps(0.13, seed)](double t) { return 20 * steps(t); };
  plant.initial = {0, 0}, plant.process_noise = {0.05}, plant.measurement_noise = {2e-5};
  plant.sample_time = 0.01, plant.seed = seed;
  return plant;
}

/// Two inertias on an elastic shaft; only the angle of the motor is measured.
struct DriveTrain {
  double motor = 1e-3, load = 2e-3, stiffness = 30, shaft_damping = 2e-3;
  Law on_motor = nothing, on_load = nothing;  ///< resisting torques, of speed and angle
};
inline Plant drive_train(const DriveTrain& m, uint64_t seed) {
  Plant plant;
  plant.diagram = R"json({"loopwright": 1, "title": "A motor and a load on an elastic shaft",
  "parameters": {"motor_inertia": {"value": 1e-3, "unit": "N*m*s^2/rad"}, "load_inertia": {"value": 2e-3, "unit": "N*m*s^2/rad"},
                 "stiffness": {"value": 30, "unit": "N*m/rad"}, "shaft_damping": {"value": 2e-3, "unit": "N*m*s/rad"}},
  "solver": {"method": "rk4", "step": 0.0001, "stop": 1},
  "blocks": {
    "zero":   {"type": "Constant", "value": {"value": 0, "unit": "N*m"}},
    "torque": {"type": "Gain", "gain": 1, "in": {"u": "zero.y"}},
    "shaft":  {"type": "ElasticCoupling", "stiffness": "=stiffness", "damping": "=shaft_damping",
               "in": {"motor_position": "motor.position", "motor_velocity": "motor.velocity",
                      "load_position": "load.position", "load_velocity": "load.velocity"}},
    "bearing":     {"type": "ViscousFriction", "damping": {"value": 2e-3, "unit": "N*m*s/rad"}, "in": {"velocity": "motor.velocity"}},
    "far_bearing": {"type": "ViscousFriction", "damping": {"value": 2e-3, "unit": "N*m*s/rad"}, "in": {"velocity": "load.velocity"}},
    "on_motor": {"type": "Sum", "signs": "+--", "in": {"terms": ["torque.y", "shaft.force", "bearing.force"]}},
    "on_load":  {"type": "Sum", "signs": "+-", "in": {"terms": ["shaft.force", "far_bearing.force"]}},
    "motor":  {"type": "Mass", "mass": "=motor_inertia", "in": {"force": "on_motor.sum"}},
    "load":   {"type": "Mass", "mass": "=load_inertia", "in": {"force": "on_load.sum"}}
  }})json";
  plant.drive = R"("torque.u": {"column": "u", "unit": "N*m"})";
  plant.compare = R"("motor.position": {"column": "y0", "unit": "rad"})";
  plant.rate = [m](const Numbers& x, double u, const Numbers& w) {
    const double shaft = m.stiffness * (x[0] - x[2]) + m.shaft_damping * (x[1] - x[3]);
    return Numbers{x[1], (u + w[0] - shaft - 2e-3 * x[1] - m.on_motor(x[1], x[0])) / m.motor, x[3],
                   (shaft + w[1] - 2e-3 * x[3] - m.on_load(x[3], x[2])) / m.load};
  };
  plant.outputs = [](const Numbers& x) { return Numbers{x[0]}; };
  plant.input = [steps = random_steps(0.11, seed)](double t) { return 0.4 * steps(t); };
  plant.initial = {0, 0, 0, 0}, plant.process_noise = {2e-3, 2e-3}, plant.measurement_noise = {2e-5};
  plant.sample_time = 2e-3, plant.seed = seed;
  return plant;
}

/// A valve with a lag before a vessel; only the vessel is measured.
struct Valve {
  double dead_zone = 0, limit = 1e3;  ///< of the command
  Law lost = nothing;                 ///< from the vessel, of its content and the valve
};
inline Plant valve(const Valve& m, uint64_t seed) {
  Plant plant;
  plant.diagram = R"json({"loopwright": 1, "title": "A valve and a vessel",
  "parameters": {"valve_rate": {"value": 8, "unit": "1/s"}, "rate": {"value": 1.5, "unit": "1/s"}, "gain": {"value": 2, "unit": "1/s"}},
  "solver": {"method": "rk4", "step": 0.01, "stop": 1},
  "blocks": {
    "none":    {"type": "Constant", "value": {"value": 0, "unit": "1"}},
    "command": {"type": "Gain", "gain": 1, "in": {"u": "none.y"}},
    "lift":    {"type": "Sum", "signs": "+-", "in": {"terms": ["command.y", "valve.y"]}},
    "moved":   {"type": "Gain", "gain": "=valve_rate", "in": {"u": "lift.sum"}},
    "valve":   {"type": "Integrator", "initial": {"value": 0, "unit": "1"}, "in": {"u": "moved.y"}},
    "supply":  {"type": "Gain", "gain": "=gain", "in": {"u": "valve.y"}},
    "decay":   {"type": "Gain", "gain": "=rate", "in": {"u": "vessel.y"}},
    "net":     {"type": "Sum", "signs": "+-", "in": {"terms": ["supply.y", "decay.y"]}},
    "vessel":  {"type": "Integrator", "initial": {"value": 0, "unit": "1"}, "in": {"u": "net.sum"}}
  }})json";
  plant.drive = R"("command.u": {"column": "u", "unit": "1"})";
  plant.compare = R"("vessel.y": {"column": "y0", "unit": "1"})";
  plant.rate = [m](const Numbers& x, double u, const Numbers& w) {
    const double passed = std::clamp(u - std::clamp(u, -m.dead_zone, m.dead_zone), -m.limit, m.limit);
    return Numbers{8 * (passed + w[0] - x[0]), 2 * x[0] + w[1] - 1.5 * x[1] - m.lost(x[1], x[0])};
  };
  plant.outputs = [](const Numbers& x) { return Numbers{x[1]}; };
  plant.input = [steps = random_steps(0.7, seed), more = random_steps(0.15, seed + 1)](double t) {
    return steps(t) + 0.4 * more(t);
  };
  plant.initial = {0, 0}, plant.process_noise = {2e-3, 2e-3}, plant.measurement_noise = {3e-4};
  plant.sample_time = 0.05, plant.seed = seed, plant.rows = 1600;
  return plant;
}

}  // namespace loopwright
