"""Motors and transmissions, compared with SciPy's integration of their equations.

    /usr/bin/python3 tests/reference/drives_test.py build/release/bin/loopwright
"""

import math
import sys
import unittest

import numpy
import scipy.integrate
import scipy.linalg

import diagrams
from diagrams import constant, run, tight, variable_step

diagrams.program = sys.argv[1]


def with_unit(value, unit):
    return {"value": value, "unit": unit}


def integrated(rates, start, times, **more):
    found = scipy.integrate.solve_ivp(rates, (0, times[-1]), start, t_eval=times, rtol=1e-11, atol=1e-13, **more)
    return found.y


class Motors(unittest.TestCase):
    def test_a_dc_motor_starts(self):
        """Two linear equations: the matrix exponential."""
        R, L, k, J, c, U = 2.5, 0.6e-3, 0.038, 7e-6, 1e-5, 24.0
        blocks = {"u": constant(U, "V"),
                  "motor": {"type": "DcMotor", "resistance": R, "inductance": L, "torque_constant": with_unit(1e3 * k, "mN*m/A"),
                            "in": {"voltage": "u.y", "velocity": "rotor.velocity"}},
                  "drag": {"type": "ViscousFriction", "damping": with_unit(c, "N*m*s/rad"), "in": {"velocity": "rotor.velocity"}},
                  "net": {"type": "Sum", "signs": "+-", "in": {"terms": ["motor.torque", "drag.force"]}},
                  "rotor": {"type": "Inertia", "inertia": with_unit(J * 1e6, "kg*mm^2"), "in": {"torque": "net.sum"}}}
        out = run(blocks, variable_step("dopri5", 0.05, 0.001, **tight), ["motor.current", "rotor.velocity"])
        A, b = numpy.array([[-R / L, -k / L], [k / J, -c / J]]), numpy.array([U / L, 0])
        for row, time in enumerate(out["time"]):
            expected = numpy.linalg.solve(A, (scipy.linalg.expm(A * time) - numpy.eye(2)) @ b)
            numpy.testing.assert_allclose([out["motor.current"][row], out["rotor.velocity"][row]], expected, rtol=1e-7, atol=1e-7)

    def test_a_synchronous_motor_runs_up(self):
        """Constant voltages in rotor coordinates: SciPy, with phases of its own by Park's formula as cosines of thirds of a turn."""
        R, Ld, Lq, flux, p, J, c = 0.8, 3e-3, 5e-3, 0.06, 4, 3e-4, 0.01
        u_d, u_q = -4.0, 20.0

        def rates(t, x):
            d, q, velocity, angle = x
            field = p * velocity
            torque = 1.5 * p * (flux * q + (Ld - Lq) * d * q)
            return [(u_d - R * d + field * Lq * q) / Ld, (u_q - R * q - field * (Ld * d + flux)) / Lq, (torque - c * velocity) / J, velocity]

        blocks = {"d": constant(u_d, "V"), "q": constant(u_q, "V"),
                  "motor": {"type": "Pmsm", "resistance": R, "inductance_d": Ld, "inductance_q": Lq, "flux": flux, "pole_pairs": p,
                            "in": {"voltage_d": "d.y", "voltage_q": "q.y", "velocity": "rotor.velocity"}},
                  "drag": {"type": "ViscousFriction", "damping": with_unit(c, "N*m*s/rad"), "in": {"velocity": "rotor.velocity"}},
                  "net": {"type": "Sum", "signs": "+-", "in": {"terms": ["motor.torque", "drag.force"]}},
                  "rotor": {"type": "Inertia", "inertia": J, "in": {"torque": "net.sum"}},
                  "field": {"type": "Gain", "gain": p, "in": {"u": "rotor.angle"}},
                  "phases": {"type": "InverseParkTransform", "in": {"d": "motor.current_d", "q": "motor.current_q", "angle": "field.y"}}}
        log = ["motor.current_d", "motor.current_q", "rotor.velocity", "rotor.angle"]
        out = run(blocks, variable_step("dopri5", 0.1, 0.001, **tight), log + ["phases.a", "phases.b", "phases.c"])
        expected = integrated(rates, [0, 0, 0, 0], out["time"], method="DOP853")
        for name, column in zip(log, expected):
            numpy.testing.assert_allclose(out[name], column, rtol=1e-6, atol=1e-7)
        for k, name in enumerate("abc"):
            angle = p * expected[3] - 2 * math.pi * k / 3
            phase = expected[0] * numpy.cos(angle) - expected[1] * numpy.sin(angle)
            numpy.testing.assert_allclose(out[f"phases.{name}"], phase, atol=1e-5)

    def test_a_switched_bridge_and_its_mean(self):
        """The current of a winding over whole periods: the switched one has the mean of the averaged one, and its ripple."""
        R, L, bus, f, dead, u = 1.0, 2e-3, 48.0, 10e3, 2e-6, 6.0
        blocks = {"u": constant(u, "V"), "still": constant(0, "rad/s")}
        for kind in ("switched", "averaged"):
            blocks[kind] = {"type": "Pwm", "kind": kind, "bus": bus, "frequency": f, "dead_time": dead, "current_width": 0.05,
                            "in": {"command": "u.y", "current": f"{kind}_winding.current"}}
            blocks[f"{kind}_winding"] = {"type": "DcMotor", "resistance": R, "inductance": L, "torque_constant": 0.01, "initial_current": 5,
                                         "in": {"voltage": f"{kind}.voltage", "velocity": "still.y"}}
        out = run(blocks, variable_step("dopri5", 0.03, 1e-6, **tight), ["switched_winding.current", "averaged_winding.current"])
        last = out["time"] > 0.0295 - 1e-9
        mean = u - bus * dead * f  # the current flows out all the time
        self.assertAlmostEqual(out["averaged_winding.current"][-1], mean / R, delta=1e-5)
        switched = out["switched_winding.current"][last][:-1]
        self.assertAlmostEqual(switched.mean(), mean / R, delta=2e-3)
        duty = 0.5 + mean / bus
        # Rows every microsecond miss the corners, by up to 15 mA at a slope of 48 V / 2 mH · duty.
        self.assertAlmostEqual(switched.max() - switched.min(), bus * duty * (1 - duty) / (L * f), delta=15e-3)


class Transmissions(unittest.TestCase):
    def test_a_gear_with_play_and_losses(self):
        """To and fro through the play: SciPy in pieces, with an event for each contact and each separation."""
        n, k, c, gap, efficiency, backwards, width = 20.0, 800.0, 0.5, 4e-3, 0.85, 0.7, 0.05
        J1, J2, drag, amplitude = 4e-5, 0.03, 0.02, 0.05

        def pressing(x, side):
            d, v = x[0] / n - x[2], x[1] / n - x[3]
            return k * (side * d - gap / 2) + c * side * v

        def rates(side):
            def flow(t, x):
                force = side * max(pressing(x, side), 0.0) if side else 0.0
                loss = 0.5 * (1 / efficiency + backwards) * force + 0.5 * (1 / efficiency - backwards) * abs(force) * math.tanh(x[3] / width)
                return [x[1], (amplitude * math.sin(12 * t) - loss / n) / J1, x[3], (force - drag * x[3]) / J2]
            return flow

        def reaches(side):
            def event(t, x):
                return side * (x[0] / n - x[2]) - gap / 2
            event.terminal, event.direction = True, 1
            return event

        def leaves(side):
            def event(t, x):
                return pressing(x, side)
            event.terminal, event.direction = True, -1
            return event

        times = numpy.linspace(0, 1.5, 301)
        expected, x, time, side, pieces = [], numpy.zeros(4), 0.0, 0, 0
        while time < times[-1]:
            events = [leaves(side)] if side else [reaches(1), reaches(-1)]
            piece = scipy.integrate.solve_ivp(rates(side), (time, times[-1]), x, events=events, method="DOP853", rtol=1e-11, atol=1e-14,
                                              dense_output=True, max_step=2e-3)
            expected += [piece.sol(t) for t in times if time <= t < piece.t[-1]]
            time, x, pieces = piece.t[-1], piece.y[:, -1], pieces + 1
            if piece.status == 1:
                side = 0 if side else (1 if len(piece.t_events[0]) else -1)
        expected = numpy.array(expected + [x])
        self.assertGreater(pieces, 8)
        blocks = {"drive": {"type": "Sine", "amplitude": with_unit(amplitude, "N*m"), "frequency": with_unit(12, "rad/s")},
                  "gear": {"type": "Gear", "ratio": n, "stiffness": k, "damping": c, "gap": gap, "efficiency": efficiency,
                           "backwards_efficiency": backwards, "transition": width,
                           "in": {"input_angle": "motor.angle", "input_velocity": "motor.velocity", "output_angle": "load.angle",
                                  "output_velocity": "load.velocity"}},
                  "drag": {"type": "ViscousFriction", "damping": with_unit(drag, "N*m*s/rad"), "in": {"velocity": "load.velocity"}},
                  "motor_net": {"type": "Sum", "signs": "+-", "in": {"terms": ["drive.y", "gear.input_torque"]}},
                  "load_net": {"type": "Sum", "signs": "+-", "in": {"terms": ["gear.output_torque", "drag.force"]}},
                  "motor": {"type": "Inertia", "inertia": J1, "in": {"torque": "motor_net.sum"}},
                  "load": {"type": "Inertia", "inertia": J2, "in": {"torque": "load_net.sum"}}}
        log = ["motor.angle", "motor.velocity", "load.angle", "load.velocity"]
        out = run(blocks, variable_step("dopri5", 1.5, 0.005, **tight), log)
        for i, name in enumerate(log):
            scale = abs(expected[:, i]).max()
            numpy.testing.assert_allclose(out[name], expected[:, i], atol=1e-5 * scale, err_msg=name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
