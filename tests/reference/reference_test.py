"""Compares results of the program with SciPy, exact fractions and closed forms that share no code with it.

    /usr/bin/python3 tests/reference/reference_test.py build/release/bin/loopwright
"""

import fractions
import math
import sys
import unittest

import numpy
import scipy.integrate
import scipy.linalg
import scipy.signal

import diagrams
from diagrams import constant, run, tight, variable_step

diagrams.program = sys.argv[1]


def state_space(A, B, C, initial, source):
    return {"type": "StrictlyProperStateSpace", "A": A.tolist(), "B": B.tolist(), "C": C.tolist(),
            "initial": list(initial), "in": {"u": source}}


class Continuous(unittest.TestCase):
    def test_matrix_exponential(self):
        random = numpy.random.default_rng(7)
        for order in (2, 5, 9):
            A = random.normal(size=(order, order)) - 1.5 * numpy.eye(order)
            B, C, start = numpy.zeros((order, 1)), numpy.eye(order), random.normal(size=order)
            blocks = {"zero": constant(0), "x": state_space(A, B, C, start, "zero.y")}
            log = [f"x.y[{i}]" for i in range(order)]
            for solver in ({"method": "rk4", "step": 0.001, "stop": 2, "record_step": 0.1},
                           variable_step("dopri5", 2, 0.1, **tight), variable_step("cvode-bdf", 2, 0.1, **tight)):
                out = run(blocks, solver, log)
                for row, time in enumerate(out["time"]):
                    expected = scipy.linalg.expm(A * time) @ start
                    numpy.testing.assert_allclose([out[name][row] for name in log], expected, rtol=1e-7, atol=1e-8)

    def test_transfer_function(self):
        numerator, denominator = [3.0, 2.0], [1.0, 2.4, 9.0, 4.0]
        blocks = {"one": constant(1), "x": {"type": "StrictlyProperTransferFunction", "numerator": numerator,
                                             "denominator": denominator, "in": {"u": "one.y"}}}
        out = run(blocks, variable_step("dopri5", 5, 0.05, **tight), ["x.y"])
        _, expected = scipy.signal.step((numerator, denominator), T=out["time"])
        numpy.testing.assert_allclose(out["x.y"], expected, atol=1e-8)

    def test_delay_equation(self):
        """dx/dt = -x(t - 1), x = 1 before 0: piecewise polynomials."""
        def exact(t):
            return sum((-1) ** k * (t - (k - 1)) ** k / math.factorial(k) for k in range(int(t) + 2))

        blocks = {"x": {"type": "Integrator", "initial": 1, "in": {"u": "g.y"}},
                  "late": {"type": "TransportDelay", "delay": 1, "initial": 1, "points": 20000, "in": {"u": "x.y"}},
                  "g": {"type": "Gain", "gain": {"value": -1, "unit": "1/s"}, "in": {"u": "late.y"}}}
        out = run(blocks, variable_step("dopri5", 6, 0.125, maximum_step=2e-4), ["x.y"])
        numpy.testing.assert_allclose(out["x.y"], [exact(t) for t in out["time"]], atol=1e-6)


class Sampled(unittest.TestCase):
    def test_loop_of_a_pi_controller(self):
        """A plant with two poles behind a hold: scipy's exact discretization, stepped by hand."""
        T, Kp, Ki = 0.05, 3.0, 4.0
        A, B, C = numpy.array([[0.0, 1.0], [-2.0, -0.7]]), numpy.array([[0.0], [1.0]]), numpy.array([[1.0, 0.0]])
        Ad, Bd, *_ = scipy.signal.cont2discrete((A, B, C, numpy.zeros((1, 1))), T)
        x, integral, expected = numpy.zeros(2), 0.0, []
        for _ in range(101):
            error = 1.0 - x[0]
            expected.append(x[0])
            u = Kp * error + integral
            integral += Ki * T * error
            x = Ad @ x + Bd[:, 0] * u
        blocks = {"one": constant(1), "plant": state_space(A, B, C, (0, 0), "u.sum"),
                  "error": {"type": "Sum", "signs": "+-", "in": {"terms": ["one.y", "plant.y[0]"]}},
                  "held": {"type": "ZeroOrderHold", "sample_time": T, "in": {"u": "error.sum"}},
                  "p": {"type": "Gain", "gain": Kp, "in": {"u": "held.y"}},
                  "i": {"type": "Gain", "gain": Ki * T, "in": {"u": "held.y"}},
                  "next": {"type": "Sum", "in": {"terms": ["sum.y", "i.y"]}},
                  "sum": {"type": "UnitDelay", "sample_time": T, "in": {"u": "next.sum"}},
                  "u": {"type": "Sum", "in": {"terms": ["p.y", "sum.y"]}}}
        for solver in (variable_step("dopri5", 5, T, **tight), {"method": "rk4", "step": 0.001, "stop": 5, "record_step": T}):
            out = run(blocks, solver, ["plant.y[0]"])
            numpy.testing.assert_allclose(out["plant.y[0]"], expected, atol=1e-9)

    def test_several_rates_with_offsets(self):
        """dx/dt = -x + a + b; a samples x every 0.3 s from 0.1 on, b samples a every 0.2 s from 0.05 on."""
        ticks = 20  # a second
        x, a, b, expected = 1.0, 0.0, 0.0, []
        decay = math.exp(-1 / ticks)
        for tick in range(6 * ticks + 1):
            if tick >= 2 and (tick - 2) % 6 == 0:
                a = -0.8 * x
            if tick >= 1 and (tick - 1) % 4 == 0:
                b = 0.5 * a
            expected.append((x, a, b))
            x = (a + b) + (x - a - b) * decay
        blocks = {"x": state_space(-numpy.eye(1), numpy.eye(1), numpy.eye(1), [1], "sum.sum"),
                  "ga": {"type": "Gain", "gain": -0.8, "in": {"u": "x.y[0]"}},
                  "a": {"type": "ZeroOrderHold", "sample_time": 0.3, "sample_offset": 0.1, "in": {"u": "ga.y"}},
                  "gb": {"type": "Gain", "gain": 0.5, "in": {"u": "a.y"}},
                  "b": {"type": "ZeroOrderHold", "sample_time": 0.2, "sample_offset": 0.05, "in": {"u": "gb.y"}},
                  "sum": {"type": "Sum", "in": {"terms": ["a.y", "b.y"]}}}
        out = run(blocks, variable_step("dopri5", 6, 1 / ticks, **tight), ["x.y[0]", "a.y", "b.y"])
        numpy.testing.assert_allclose(numpy.array([out["x.y[0]"], out["a.y"], out["b.y"]]).T, expected, atol=1e-9)

    def test_a_billion_ticks(self):
        """The last of a million seconds at 1 kHz, by exact fractions."""
        start, stop, T = 999_999, 1_000_000, fractions.Fraction(1, 1000)
        blocks = {"pulse": {"type": "PulseTrain", "period": 0.003, "width": 0.001, "sample_time": 0.001},
                  "late": {"type": "PulseTrain", "period": 0.007, "width": 0.002, "start": 0.0005, "sample_time": 0.001},
                  "chirp": {"type": "Chirp", "from": 100, "to": 200, "duration": 0.007, "repeats": True, "sample_time": 0.001},
                  "clock": {"type": "Clock", "sample_time": 0.001},
                  "sine": {"type": "Sine", "frequency": 17, "sample_time": 0.001}}
        out = run(blocks, {"start": start, "stop": stop, "step": 0.001},
                  ["pulse.y", "late.y", "chirp.frequency", "clock.time", "sine.y"])
        self.assertEqual(len(out["time"]), 1001)
        for row in range(1001):
            t = start + row * T
            self.assertEqual(out["clock.time"][row], float(t))
            self.assertEqual(out["pulse.y"][row], t % (3 * T) < T)
            self.assertEqual(out["late.y"][row], (t - T / 2) % (7 * T) < 2 * T)
            self.assertAlmostEqual(out["chirp.frequency"][row], 100 + 100 * float(t % (7 * T) / (7 * T)), delta=1e-5)
            self.assertAlmostEqual(out["sine.y"][row], math.sin(2 * math.pi * float(17 * t % 1)), delta=1e-7)


class Events(unittest.TestCase):
    def test_relay_limit_cycle(self):
        """A relay with hysteresis around two lags, by scipy with an event for each switch."""
        def flow(sign):
            return lambda t, x: [x[1], sign - 2 * x[0] - 0.6 * x[1]]

        time, x, sign, switches = 0.0, [0.0, 0.0], 1.0, []
        while time < 40:
            def threshold(t, x, sign=sign):
                return sign * x[0] - 0.1
            threshold.terminal, threshold.direction = True, 1
            piece = scipy.integrate.solve_ivp(flow(sign), (time, 40), x, events=threshold, rtol=1e-12, atol=1e-13)
            time, x = piece.t[-1], piece.y[:, -1]
            if piece.status == 1:
                switches.append(time)
                sign = -sign
        self.assertGreater(len(switches), 10)
        blocks = {"r": {"type": "Relay", "switch_on": 0.1, "switch_off": -0.1, "on": -1, "off": 1, "in": {"u": "plant.y[0]"}},
                  "plant": state_space(numpy.array([[0.0, 1.0], [-2.0, -0.6]]), numpy.array([[0.0], [1.0]]), numpy.eye(2),
                                       (0, 0), "r.y"),
                  "one": constant(1), "zero": constant(0)}
        out = run(blocks, variable_step("dopri5", 40, 40, **tight), ["plant.y[0]", "plant.y[1]"])
        numpy.testing.assert_allclose([out["plant.y[0]"][-1], out["plant.y[1]"][-1]], x, atol=1e-7)

    def test_bouncing_ball(self):
        """The first fifteen bounces, by scipy."""
        floor = lambda t, x: x[0]
        floor.terminal, floor.direction = True, -1
        time, x = 0.0, [1.0, 0.0]
        for _ in range(15):
            piece = scipy.integrate.solve_ivp(lambda t, x: [x[1], -9.81], (time, 10), x, events=floor, rtol=1e-12, atol=1e-14)
            time, x = piece.t[-1], [1e-15, -0.8 * piece.y[1, -1]]
        stop = round(time, 3) + 0.005
        rest = stop - time
        expected = x[1] * rest - 9.81 / 2 * rest ** 2
        blocks = {"gravity": constant(-9.81, "m/s^2"),
                  "v": {"type": "Integrator", "in": {"u": "gravity.y", "reset": "below.y", "reset_value": "rebound.y"}},
                  "h": {"type": "Integrator", "initial": {"value": 1, "unit": "m"}, "in": {"u": "v.y"}},
                  "below": {"type": "Gain", "gain": {"value": -1, "unit": "1"}, "in": {"u": "h.y"}},
                  "rebound": {"type": "Gain", "gain": {"value": -0.8, "unit": "1"}, "in": {"u": "v.y"}}}
        out = run(blocks, variable_step("dopri5", stop, stop, **tight), ["h.y"])
        self.assertAlmostEqual(out["h.y"][-1], expected, delta=1e-8)

    def test_resets_by_a_sine(self):
        """An integrator of 1 that is reset by a sine of 1 Hz."""
        blocks = {"one": constant(1, "1/s"), "zero": constant(0), "s": {"type": "Sine", "frequency": 1, "phase": 0.3},
                  "i": {"type": "Integrator", "in": {"u": "one.y", "reset": "s.y", "reset_value": "zero.y"}}}
        for method in ("dopri5", "cvode-bdf"):
            out = run(blocks, variable_step(method, 200, 0.05), ["i.y"])
            phase = out["time"] + 0.3 / (2 * math.pi)
            expected = numpy.where(phase < 1, out["time"], phase % 1)
            numpy.testing.assert_allclose((out["i.y"] - expected + 0.5) % 1 - 0.5, 0, atol=1e-6)
            self.assertLessEqual(out["i.y"].max(), 1 + 1e-6)

    def test_stick_slip(self):
        """A mass on a belt: it sticks until the spring force exceeds the holding friction, slips along a sine, sticks again."""
        mass, stiffness, speed, holding, sliding = 1.0, 40.0, 0.1, 3.0, 2.0

        def slip(t, x):  # position, velocity while it slides backwards against the belt
            return [x[1], (-stiffness * x[0] + sliding) / mass]

        def caught(t, x):
            return x[1] - speed
        caught.terminal, caught.direction = True, 1
        # From the moment of release: the spring force equals the holding force, and the mass moves with the belt.
        release = [holding / stiffness, speed]
        piece = scipy.integrate.solve_ivp(slip, (0, 5), [release[0], release[1] - 1e-12], events=caught, rtol=1e-12, atol=1e-14,
                                          max_step=1e-3)
        slip_time, slip_end = piece.t[-1], piece.y[0, -1]
        period = slip_time + (release[0] - slip_end) / speed
        blocks = {"m": {"type": "Mass", "mass": {"value": mass, "unit": "kg"}, "initial_position": {"value": slip_end, "unit": "m"},
                        "initial_velocity": {"value": speed, "unit": "m/s"}, "in": {"force": "net.sum"}},
                  "spring": {"type": "Spring", "stiffness": {"value": stiffness, "unit": "N/m"}, "in": {"position": "m.position"}},
                  "belt": constant(speed, "m/s"),
                  "against": {"type": "Sum", "signs": "+-", "in": {"terms": ["m.velocity", "belt.y"]}},
                  "pull": {"type": "Gain", "gain": {"value": -1, "unit": "1"}, "in": {"u": "spring.force"}},
                  "dry": {"type": "CoulombFriction", "level": {"value": sliding, "unit": "N"},
                          "static_level": {"value": holding, "unit": "N"}, "mass": {"value": mass, "unit": "kg"},
                          "in": {"velocity": "against.sum", "applied": "pull.y"}},
                  "net": {"type": "Sum", "signs": "--", "in": {"terms": ["spring.force", "dry.force"]}}}
        cycles = 5
        out = run(blocks, variable_step("dopri5", cycles * period, 0.001, **tight), ["m.position", "m.velocity"])
        times, velocity = out["time"], out["m.velocity"]
        releases = [t for t, before, now in zip(times[1:], velocity, velocity[1:]) if before > speed - 1e-6 > now]
        self.assertGreaterEqual(len(releases), cycles - 1)
        numpy.testing.assert_allclose(numpy.diff(releases), period, atol=0.0021)  # rows are a millisecond apart
        self.assertAlmostEqual(out["m.position"].max(), piece.y[0].max(), delta=1e-4)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
