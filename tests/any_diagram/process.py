"""Motors with their windings, heat, tanks, valves, oil and circuits."""

import math

from mechanical import distortions, friction, state
from plant import Place, Plant, formula, gain, integral, mass, quantity, source, steps, tones, total, viscous


def dc_motor():
    p = {"resistance": (1.2, "Ohm"), "inductance": (2e-3, "H"), "constant": (0.05, "V*s/rad"), "inertia": (2e-5, "N*m*s^2/rad"),
         "damping": (1e-5, "N*m*s/rad")}
    blocks = {
        "none": source("V"), "amplifier": gain(1, "none.y"), "resistor": gain("=resistance", "current.y"),
        "emf": gain("=constant", "rotor.velocity"), "voltages": total("+--", "amplifier.y", "resistor.y", "emf.y"),
        "winding": gain("=1/inductance", "voltages.sum"), "current": integral("winding.y"),
        "torque": gain(quantity(0.05, "N*m/A"), "current.y"), "viscous": viscous("=damping", "rotor.velocity"),
        "torques": total("+-", "torque.y", "viscous.force"), "rotor": mass("=inertia", "torques.sum")}

    def rate(x, u, p, at):
        volts = at("voltages.sum", at("amplifier.u", u[0]) - p["resistance"] * x[0] - p["constant"] * x[2])
        return [volts / p["inductance"], x[2], at("torques.sum", 0.05 * x[0] - p["damping"] * x[2]) / p["inertia"]]

    def drive(random):
        level, wave = steps(random, 0.06, 6), tones(random, 1, 60, 2)
        return lambda t, y: [level(t) + wave(t)]

    places = (*friction("torques.sum", "rotor.velocity", 2), Place("periodic", ("torques.sum",), ("rotor.position",), state(1), 0),
              Place("constant", ("torques.sum",), (), lambda x, u: 1.0, 0),
              Place("soft_sign", ("voltages.sum",), ("current.y",), state(0)),
              Place("signed_square", ("voltages.sum",), ("current.y",), state(0)),
              Place("bump", ("voltages.sum",), ("current.y",), state(0), 0), *distortions("amplifier.u"))
    return Plant("dc_motor", p, blocks, (("amplifier.u", "V"),), (("current.y", "A", 0), ("rotor.position", "rad", 1)), (0.0,) * 3, rate, drive,
                 1e-3, places, {"voltages.sum": 0.005, "torques.sum": 0.005}, (1e-3, 1e-6), rows=3000, substeps=10, fixed=("constant",))


def thermal():
    p = {"first_loss": (0.5, "W/K"), "second_loss": (0.3, "W/K"), "coupling": (0.8, "W/K"), "heat1_per_kelvin": (50.0, "J/K"),
         "heat2_per_kelvin": (100.0, "J/K")}
    blocks = {
        "none": source("W"), "heater": gain(1, "none.y"), "ambient": {"type": "Constant", "value": quantity(293, "K")},
        "over1": total("+-", "body1.y", "ambient.y"), "over2": total("+-", "body2.y", "ambient.y"), "between": total("+-", "body1.y", "body2.y"),
        "loss1": gain("=first_loss", "over1.sum"), "loss2": gain("=second_loss", "over2.sum"), "flow": gain("=coupling", "between.sum"),
        "heat1": total("+--", "heater.y", "loss1.y", "flow.y"), "heat2": total("+-", "flow.y", "loss2.y"),
        "rise1": gain("=1/heat1_per_kelvin", "heat1.sum"), "rise2": gain("=1/heat2_per_kelvin", "heat2.sum"),
        "body1": integral("rise1.y", "K", 293), "body2": integral("rise2.y", "K", 293)}

    def rate(x, u, p, at):
        flow = at("flow.y", p["coupling"] * (x[0] - x[1]))
        return [at("heat1.sum", at("heater.u", u[0]) - p["first_loss"] * (x[0] - 293) - flow) / p["heat1_per_kelvin"],
                at("heat2.sum", flow - p["second_loss"] * (x[1] - 293)) / p["heat2_per_kelvin"]]

    def drive(random):
        level = steps(random, 120, 120, 120)
        return lambda t, y: [level(t)]

    places = ()
    for i in (0, 1):
        site, body, over = f"heat{i + 1}.sum", f"body{i + 1}.y", f"over{i + 1}.sum"
        places += (Place("radiation", (site,), (body,), state(i)),
                   Place("convection", (site,), (over, f"loss{i + 1}.y"), lambda x, u, i=i: x[i] - 293),
                   Place("constant", (site, *(("heater.u",) if i == 0 else ())), (), lambda x, u: 1.0),
                   Place("bump", (site,), (body, over), state(i)))
    return Plant("thermal", p, blocks, (("heater.u", "W"),), (("body1.y", "K", 0), ("body2.y", "K", 1)), (293.0, 293.0), rate, drive, 2.0,
                 places, {"heat1.sum": 0.01, "heat2.sum": 0.01}, (2e-4, 2e-4))


def tanks():
    p = {"area1": (0.1, "m^2"), "area2": (0.12, "m^2"), "outlet1": (0.006, "m^2.5/s"), "outlet2": (0.005, "m^2.5/s"),
         "pump_constant": (1e-3, "m^3/(V*s)")}
    blocks = {
        "none": source("V"), "pump": gain("=pump_constant", "none.y"),
        "head1": formula("sqrt(abs(h))", h="level1.y"), "head2": formula("sqrt(abs(h))", h="level2.y"),
        "out1": gain("=outlet1", "head1.y"), "out2": gain("=outlet2", "head2.y"),
        "balance1": total("+-", "pump.y", "out1.y"), "balance2": total("+-", "out1.y", "out2.y"),
        "rise1": gain("=1/area1", "balance1.sum"), "rise2": gain("=1/area2", "balance2.sum"),
        "level1": integral("rise1.y", "m", 0.3), "level2": integral("rise2.y", "m", 0.3)}

    def rate(x, u, p, at):
        out = at("out1.y", p["outlet1"] * math.sqrt(abs(x[0])))
        return [at("balance1.sum", p["pump_constant"] * at("pump.u", u[0]) - out) / p["area1"],
                at("balance2.sum", out - p["outlet2"] * math.sqrt(abs(x[1]))) / p["area2"]]

    def drive(random):
        level = steps(random, 60, 2.5, 4)
        return lambda t, y: [level(t)]

    places = ()
    for i in (0, 1):
        site, level = f"balance{i + 1}.sum", f"level{i + 1}.y"
        places += (Place("overflow", (site,), (level,), state(i)), Place("linear", (site,), (level,), state(i)),
                   Place("constant", (site, *(("pump.u",) if i == 0 else ())), (), lambda x, u: 1.0))
    places += (Place("overflow", ("out1.y",), ("level1.y",), state(0), +1), Place("bump", ("balance2.sum",), ("level2.y",), state(1)),
               *distortions("pump.u"))
    return Plant("tanks", p, blocks, (("pump.u", "V"),), (("level1.y", "m", 0), ("level2.y", "m", 1)), (0.3, 0.3), rate, drive, 2.0, places,
                 {"balance1.sum": 0.01, "balance2.sum": 0.01}, (1e-3, 1e-3), anchor=("pump_constant",))


def valve():
    """A valve with a lag; its position is not measured."""
    p = {"valve_rate": (8.0, "1/s"), "plant_rate": (1.5, "1/s"), "plant_gain": (2.0, "1/s")}
    blocks = {
        "none": source("1"), "command": gain(1, "none.y"), "lift": total("+-", "command.y", "valve.y"), "moved": gain("=valve_rate", "lift.sum"),
        "valve": integral("moved.y", "1", 0), "supply": gain("=plant_gain", "valve.y"), "decay": gain("=plant_rate", "tank.y"),
        "net": total("+-", "supply.y", "decay.y"), "tank": integral("net.sum", "1", 0)}

    def rate(x, u, p, at):
        return [p["valve_rate"] * at("lift.sum", at("command.u", u[0]) - x[0]),
                at("net.sum", p["plant_gain"] * at("valve.y", x[0]) - p["plant_rate"] * x[1])]

    def drive(random):
        level, wave = steps(random, 0.7, 1), tones(random, 0.1, 3, 0.4)
        return lambda t, y: [level(t) + wave(t)]

    places = (*distortions("command.u"), Place("cube", ("net.sum",), ("tank.y",), state(1)),
              Place("signed_square", ("net.sum",), ("tank.y",), state(1)),
              Place("constant", ("net.sum", "lift.sum", "command.u", "valve.y"), (), lambda x, u: 1.0, 0),
              Place("bump", ("net.sum",), ("tank.y",), state(1), 0))
    return Plant("valve", p, blocks, (("command.u", "1"),), (("tank.y", "1", 1),), (0.0, 0.0), rate, drive, 0.05, places,
                 {"lift.sum": 0.003, "net.sum": 0.003}, (3e-4,), rows=3000)


def hydraulic():
    p = {"area": (1e-3, "m^2"), "stiffness": (2e11, "Pa/m^3"), "leak": (4e-12, "m^3/(s*Pa)"), "mass": (40.0, "kg"), "drag": (900.0, "N*s/m"),
         "flow_gain": (2e-4, "m^3/(s*V)")}
    blocks = {
        "none": source("V"), "servo": gain("=flow_gain", "none.y"), "displaced": gain("=area", "speed.y"), "seep": gain("=leak", "pressure.y"),
        "flows": total("+--", "servo.y", "displaced.y", "seep.y"), "compress": gain("=stiffness", "flows.sum"),
        "pressure": integral("compress.y", "Pa", 0), "push": gain("=area", "pressure.y"), "drag": gain("=drag", "speed.y"),
        "forces": total("+-", "push.y", "drag.y"), "inertia": gain("=1/mass", "forces.sum"),
        "speed": integral("inertia.y", "m/s", 0), "piston": integral("speed.y", "m", 0)}

    def rate(x, u, p, at):
        flow = at("flows.sum", p["flow_gain"] * at("servo.u", u[0]) - p["area"] * x[1] - p["leak"] * x[2])
        return [x[1], at("forces.sum", p["area"] * x[2] - p["drag"] * x[1]) / p["mass"], p["stiffness"] * flow]

    def drive(random):
        level, wave = steps(random, 0.25, 0.6), tones(random, 0.3, 12, 0.4)
        return lambda t, y: [level(t) + wave(t)]

    places = (*friction("forces.sum", "speed.y", 1), Place("constant", ("forces.sum",), (), lambda x, u: 1.0, 0),
              Place("constant", ("flows.sum", "servo.u"), (), lambda x, u: 1.0, 0),
              Place("bump", ("forces.sum",), ("speed.y",), state(1), 0), *distortions("servo.u"))
    return Plant("hydraulic", p, blocks, (("servo.u", "V"),), (("piston.y", "m", 0), ("pressure.y", "Pa", 2)), (0.0,) * 3, rate, drive, 2e-3,
                 places, {"flows.sum": 0.005, "forces.sum": 0.005}, (1e-6, 1e-3), rows=3000, substeps=20, anchor=("flow_gain",))


def rc_ladder():
    """Two capacitors; a known diode leads from the second to ground."""
    p = {"resistor1": (1e3, "Ohm"), "resistor2": (2e3, "Ohm"), "capacitor1": (1e-5, "F"), "capacitor2": (2e-5, "F"), "saturation": (2e-6, "A")}
    blocks = {
        "none": source("V"), "supply": gain(1, "none.y"), "drop1": total("+-", "supply.y", "node1.y"), "drop2": total("+-", "node1.y", "node2.y"),
        "branch1": gain("=1/resistor1", "drop1.sum"), "branch2": gain("=1/resistor2", "drop2.sum"),
        "curve": formula("exp(min(v/vt, 60)) - 1", v="node2.y"), "diode": gain("=saturation", "curve.y"),
        "currents1": total("+-", "branch1.y", "branch2.y"), "currents2": total("+-", "branch2.y", "diode.y"),
        "charge1": gain("=1/capacitor1", "currents1.sum"), "charge2": gain("=1/capacitor2", "currents2.sum"),
        "node1": integral("charge1.y", "V", 0), "node2": integral("charge2.y", "V", 0)}

    def rate(x, u, p, at):
        through = at("branch2.y", (x[0] - x[1]) / p["resistor2"])
        diode = p["saturation"] * (math.exp(min(x[1] / 0.2, 60)) - 1)
        return [at("currents1.sum", (at("supply.u", u[0]) - x[0]) / p["resistor1"] - through) / p["capacitor1"],
                at("currents2.sum", through - diode) / p["capacitor2"]]

    def drive(random):
        level, wave = steps(random, 0.04, 3), tones(random, 1, 60, 1)
        return lambda t, y: [level(t) + wave(t)]

    places = ()
    for i in (0, 1):
        site, node = f"currents{i + 1}.sum", f"node{i + 1}.y"
        places += (Place("signed_square", (site,), (node,), state(i)), Place("cube", (site,), (node,), state(i)),
                   Place("constant", (site, *(("supply.u", "drop1.sum") if i == 0 else ())), (), lambda x, u: 1.0, 0))
    places += (Place("linear", ("currents1.sum",), ("node1.y",), state(0)), Place("bump", ("currents2.sum",), ("node2.y",), state(1), 0),
               *distortions("supply.u"))
    return Plant("rc_ladder", p | {"vt": (0.2, "V")}, blocks, (("supply.u", "V"),), (("node1.y", "V", 0), ("node2.y", "V", 1)), (0.0, 0.0), rate,
                 drive, 1e-3, places, {"currents1.sum": 0.005, "currents2.sum": 0.005}, (1e-4, 1e-4), rows=3000, fixed=("vt", "saturation"), anchor=("resistor1",))


PLANTS = (dc_motor, thermal, tanks, valve, hydraulic, rc_ladder)
