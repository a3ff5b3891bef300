"""Machines that move."""

import math

from plant import Place, Plant, formula, gain, integral, mass, source, steps, tones, total, viscous


def state(i):
    return lambda x, u: x[i]


def friction(site, velocity, i):
    """What resists a motion at a sum of forces."""
    return (Place("sign", (site,), (velocity,), state(i)), Place("signed_square", (site,), (velocity,), state(i)))


def spring(site, position, i):
    return (Place("cube", (site,), (position,), state(i)),)


def distortions(port):
    return (Place("saturation", (port,), (port,), None, +1), Place("dead_zone", (port,), (port,), None, +1))


def gantry():
    p = {"mass_x": (8.0, "kg"), "mass_y": (3.0, "kg"), "damping_x": (20.0, "N*s/m"), "damping_y": (8.0, "N*s/m")}
    blocks = {"none": source("N")}
    for axis in "xy":
        blocks |= {f"motor_{axis}": gain(1, "none.y"), f"viscous_{axis}": viscous(f"=damping_{axis}", f"axis_{axis}.velocity"),
                   f"net_{axis}": total("+-", f"motor_{axis}.y", f"viscous_{axis}.force"),
                   f"axis_{axis}": mass(f"=mass_{axis}", f"net_{axis}.sum")}

    def rate(x, u, p, at):
        return [x[1], at("net_x.sum", at("motor_x.u", u[0]) - p["damping_x"] * x[1]) / p["mass_x"],
                x[3], at("net_y.sum", at("motor_y.u", u[1]) - p["damping_y"] * x[3]) / p["mass_y"]]

    def drive(random):
        along_x, along_y = tones(random, 0.3, 4, 0.05), tones(random, 0.3, 4, 0.04)
        seen = [0.0, 0.0]

        def control(t, y):
            speed = [(y[i] - seen[i]) / 2e-3 for i in (0, 1)]
            seen[:] = y[:2]
            return [8000 * (along_x(t) - y[0]) - 250 * speed[0], 3000 * (along_y(t) - y[1]) - 90 * speed[1]]
        return control

    places = ()
    for i, axis in enumerate("xy"):
        net, block = f"net_{axis}.sum", f"axis_{axis}"
        places += (*friction(net, f"{block}.velocity", 2 * i + 1), *spring(net, f"{block}.position", 2 * i),
                   Place("periodic", (net,), (f"{block}.position",), state(2 * i), 0),
                   Place("constant", (net, f"motor_{axis}.u"), (), lambda x, u: 1.0, 0),
                   Place("bump", (net,), (f"{block}.position",), state(2 * i), 0))
    return Plant("gantry", p, blocks, (("motor_x.u", "N"), ("motor_y.u", "N")), (("axis_x.position", "m", 0), ("axis_y.position", "m", 2)),
                 (0.0,) * 4, rate, drive, 2e-3, places, {"net_x.sum": 0.01, "net_y.sum": 0.01}, (2e-5, 2e-5), rows=3000)


def two_mass():
    p = {"motor_inertia": (1e-3, "N*m*s^2/rad"), "load_inertia": (2e-3, "N*m*s^2/rad"), "stiffness": (30.0, "N*m/rad"),
         "shaft_damping": (4e-3, "N*m*s/rad"), "motor_drag": (2e-3, "N*m*s/rad"), "load_drag": (2e-3, "N*m*s/rad")}
    blocks = {
        "none": source("N*m"), "torque": gain(1, "none.y"),
        "shaft": {"type": "ElasticCoupling", "stiffness": "=stiffness", "damping": "=shaft_damping",
                  "in": {"motor_position": "motor.position", "motor_velocity": "motor.velocity",
                         "load_position": "load.position", "load_velocity": "load.velocity"}},
        "bearing": viscous("=motor_drag", "motor.velocity"), "far_bearing": viscous("=load_drag", "load.velocity"),
        "on_motor": total("+--", "torque.y", "shaft.force", "bearing.force"), "on_load": total("+-", "shaft.force", "far_bearing.force"),
        "motor": mass("=motor_inertia", "on_motor.sum"), "load": mass("=load_inertia", "on_load.sum")}

    def rate(x, u, p, at):
        twist, slip = x[0] - x[2], x[1] - x[3]
        shaft = at("shaft.force", p["stiffness"] * twist + p["shaft_damping"] * slip)
        return [x[1], at("on_motor.sum", at("torque.u", u[0]) - shaft - p["motor_drag"] * x[1]) / p["motor_inertia"],
                x[3], at("on_load.sum", shaft - p["load_drag"] * x[3]) / p["load_inertia"]]

    def drive(random):
        level, wave = steps(random, 0.11, 0.4), tones(random, 0.5, 40, 0.2)
        return lambda t, y: [level(t) + wave(t)]

    places = (*friction("on_motor.sum", "motor.velocity", 1), *friction("on_load.sum", "load.velocity", 3),
              Place("cube", ("shaft.force",), ("motor.position - load.position",), lambda x, u: x[0] - x[2], +1),
              Place("periodic", ("on_motor.sum",), ("motor.position",), state(0), 0),
              Place("bump", ("on_load.sum",), ("load.velocity",), state(3), 0))
    return Plant("two_mass", p, blocks, (("torque.u", "N*m"),), (("motor.position", "rad", 0),), (0.0,) * 4, rate, drive, 2e-3, places,
                 {"on_motor.sum": 0.005, "on_load.sum": 0.005}, (2e-6,), rows=3000, fixed=("motor_drag", "load_drag", "shaft_damping"))


def pendulum():
    p = {"cart_mass": (1.2, "kg"), "cart_drag": (2.0, "N*s/m"), "pivot_drag": (0.01, "N*m*s/rad"), "ball": (0.3, "kg"),
         "length": (0.4, "m"), "gravity": (9.81, "m/s^2")}
    push = "(f + ball*length*w^2*sin(q) + ball*gravity*sin(q)*cos(q) - cos(q)*tau/length)"
    names = {"f": "on_cart.sum", "tau": "on_pivot.sum", "q": "angle.y", "w": "spin.y"}
    blocks = {
        "none": source("N"), "motor": gain(1, "none.y"), "drag": gain("=cart_drag", "speed.y"), "grease": gain("=pivot_drag", "spin.y"),
        "zero": {"type": "Constant", "value": {"value": 0, "unit": "N*m"}},
        "on_cart": total("+-", "motor.y", "drag.y"), "on_pivot": total("+-", "zero.y", "grease.y"),
        "cart_acceleration": formula(f"{push}/(cart_mass + ball*sin(q)^2)", **names),
        "spin_rate": formula("tau/(ball*length^2) - (cos(q)*a + gravity*sin(q))/length", tau="on_pivot.sum", a="cart_acceleration.y",
                             q="angle.y"),
        "speed": integral("cart_acceleration.y", "m/s"), "cart": integral("speed.y", "m"),
        "spin": integral("spin_rate.y", "rad/s"), "angle": integral("spin.y", "rad")}

    def rate(x, u, p, at):
        s, c, ball, length = math.sin(x[2]), math.cos(x[2]), p["ball"], p["length"]
        f, tau = at("on_cart.sum", at("motor.u", u[0]) - p["cart_drag"] * x[1]), at("on_pivot.sum", -p["pivot_drag"] * x[3])
        a = (f + ball * length * x[3] ** 2 * s + ball * p["gravity"] * s * c - c * tau / length) / (p["cart_mass"] + ball * s * s)
        return [x[1], a, x[3], tau / (ball * length**2) - (c * a + p["gravity"] * s) / length]

    def drive(random):
        reference, seen = tones(random, 0.2, 2, 0.15), [0.0]

        def control(t, y):
            speed = (y[0] - seen[0]) / 5e-3
            seen[0] = y[0]
            return [150 * (reference(t) - y[0]) - 20 * speed]
        return control

    places = (*friction("on_cart.sum", "speed.y", 1), *friction("on_pivot.sum", "spin.y", 3), *spring("on_cart.sum", "cart.y", 0),
              Place("constant", ("on_cart.sum", "motor.u"), (), lambda x, u: 1.0, 0),
              Place("bump", ("on_cart.sum",), ("cart.y",), state(0), 0))
    return Plant("pendulum", p, blocks, (("motor.u", "N"),), (("cart.y", "m", 0), ("angle.y", "rad", 2)), (0.0, 0.0, 0.3, 0.0), rate, drive,
                 5e-3, places, {"on_cart.sum": 0.005, "on_pivot.sum": 0.005}, (2e-5, 2e-5), rows=2500, fixed=("gravity", "ball", "length", "pivot_drag"))


def quarter_car():
    p = {"body_mass": (300.0, "kg"), "wheel_mass": (40.0, "kg"), "suspension": (16e3, "N/m"), "damper": (1000.0, "N*s/m"),
         "tyre": (160e3, "N/m")}
    blocks = {
        "none": source("m"), "road": gain(1, "none.y"), "deflection": total("+-", "road.y", "wheel.position"),
        "tyre_force": gain("=tyre", "deflection.sum"),
        "strut": {"type": "ElasticCoupling", "stiffness": "=suspension", "damping": "=damper",
                  "in": {"motor_position": "wheel.position", "motor_velocity": "wheel.velocity",
                         "load_position": "body.position", "load_velocity": "body.velocity"}},
        "on_wheel": total("+-", "tyre_force.y", "strut.force"), "on_body": total("+", "strut.force"),
        "wheel": mass("=wheel_mass", "on_wheel.sum"), "body": mass("=body_mass", "on_body.sum")}

    def rate(x, u, p, at):
        strut = at("strut.force", p["suspension"] * (x[0] - x[2]) + p["damper"] * (x[1] - x[3]))
        road = at("road.u", u[0])
        return [x[1], at("on_wheel.sum", p["tyre"] * (road - x[0]) - strut) / p["wheel_mass"], x[3], at("on_body.sum", strut) / p["body_mass"]]

    def drive(random):
        wave, level = tones(random, 0.3, 15, 0.02), steps(random, 0.4, 0.01)
        return lambda t, y: [wave(t) + level(t)]

    bend, slip = (lambda x, u: x[0] - x[2]), (lambda x, u: x[1] - x[3])
    bends, slips = ("wheel.position - body.position",), ("wheel.velocity - body.velocity",)
    places = (Place("cube", ("strut.force",), bends, bend, +1), Place("sign", ("strut.force",), slips, slip, +1),
              Place("signed_square", ("strut.force",), slips, slip, +1),
              Place("constant", ("on_body.sum",), (), lambda x, u: 1.0, 0), Place("sign", ("on_body.sum",), ("body.velocity",), state(3)),
              Place("bump", ("strut.force",), bends, bend, 0))
    return Plant("quarter_car", p, blocks, (("road.u", "m"),), (("wheel.position", "m", 0), ("body.position", "m", 2)), (0.0,) * 4, rate,
                 drive, 5e-3, places, {"on_wheel.sum": 0.005, "on_body.sum": 0.005}, (3e-5, 3e-5), rows=2500, substeps=10, anchor=("body_mass",))


def oscillator_blocks(unit="N"):
    return {"none": source(unit), "shaker": gain(1, "none.y"), "damper": viscous("=damping", "mass.velocity"),
            "spring": {"type": "Spring", "stiffness": "=stiffness", "in": {"position": "mass.position"}},
            "net": total("+--", "shaker.y", "damper.force", "spring.force"), "mass": mass("=mass", "net.sum")}


def oscillating(x, u, p, at):
    return [x[1], at("net.sum", at("shaker.u", u[0]) - p["damping"] * x[1] - p["stiffness"] * x[0]) / p["mass"]]


OSCILLATOR = {"mass": (2.0, "kg"), "damping": (10.0, "N*s/m"), "stiffness": (5e4, "N/m")}


def hysteretic():
    """Eight samples a period of the resonance at 25 Hz."""
    def drive(random):
        wave = tones(random, 3, 45, 60)
        return lambda t, y: [wave(t)]

    places = (Place("hysteresis", ("net.sum",), ("mass.velocity", "mass.position"), state(1)), *spring("net.sum", "mass.position", 0),
              Place("sign", ("net.sum",), ("mass.velocity",), state(1)),
              Place("signed_square", ("net.sum",), ("mass.velocity",), state(1)))
    return Plant("hysteretic", OSCILLATOR, oscillator_blocks(), (("shaker.u", "N"),), (("mass.position", "m", 0),), (0.0, 0.0), oscillating,
                 drive, 5e-3, places, {"net.sum": 0.003}, (1e-4,), rows=3000, substeps=10)


def duffing():
    def drive(random):
        wave = tones(random, 2, 40, 60)
        return lambda t, y: [wave(t)]

    places = (Place("cube", ("net.sum",), ("mass.position",), state(0)), Place("square", ("net.sum",), ("mass.position",), state(0), 0),
              Place("constant", ("net.sum", "shaker.u"), (), lambda x, u: 1.0, 0),
              Place("signed_square", ("net.sum",), ("mass.velocity",), state(1)),
              Place("bump", ("net.sum",), ("mass.position",), state(0), 0))
    return Plant("duffing", OSCILLATOR, oscillator_blocks(), (("shaker.u", "N"),), (("mass.position", "m", 0),), (0.0, 0.0), oscillating, drive,
                 2e-3, places, {"net.sum": 0.003}, (2e-4,), rows=3000)


PLANTS = (gantry, two_mass, pendulum, quarter_car, hysteretic, duffing)
