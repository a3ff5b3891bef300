"""A current loop at 4 kHz inside a position loop at 1 kHz: both controllers in plain Python, exact steps between them."""

import unittest

import numpy

from program import call, exact_step, poles, run

R, L, K, MASS, DAMPING = 2.0, 1e-3, 10.0, 0.5, 2.0  # ohm, H, N/A, kg, N s/m
FAST, RATIO, BEGIN, STEP = 0.00025, 4, 0.01, 0.001  # s, 1, s, m


class Loop:
    """x: current, position, velocity. The memories are integrals, errors, the last position and its filtered slope."""

    F, g = exact_step([[-R / L, 0, -K / L], [0, 0, 1], [K / MASS, 0, -DAMPING / MASS]], [1 / L, 0, 0], FAST)

    def __init__(self, start=numpy.zeros(9)):
        self.x, self.tick = numpy.array(start[:3]), 0
        self.position_integral, self.position_error, self.position_before, self.slope, self.current_integral, self.current_error = start[3:]
        self.wanted = 0.0

    def state(self):
        return [*self.x, self.position_integral, self.position_error, self.position_before, self.slope, self.current_integral, self.current_error]

    def step(self, target):
        """One fast sample; returns position, wanted current, current and voltage at its beginning."""
        current, position, _ = self.x
        if self.tick % RATIO == 0:
            T, pole, error = RATIO * FAST, 1500.0, target - position
            self.position_integral += 40000 * T / 2 * (error + self.position_error)
            self.slope = ((2 - pole * T) * self.slope - 2 * pole * (position - self.position_before)) / (2 + pole * T)
            self.wanted = 1500 * error + self.position_integral + 12 * self.slope
            self.position_error, self.position_before = error, position
        error = self.wanted - current
        self.current_integral += 4000 * FAST / 2 * (error + self.current_error)
        voltage = 2 * error + self.current_integral
        self.current_error = error
        self.x = self.F @ self.x + self.g * voltage
        self.tick += 1
        return position, self.wanted, current, voltage


class Multirate(unittest.TestCase):
    def test_against_plain_python(self):
        loop, result = Loop(), run("multirate")
        rows = [loop.step(STEP if row * FAST > BEGIN - FAST / 2 else 0.0) for row in range(1201)]
        for column, (name, unit, tolerance) in enumerate([("slide.position", "m", 1e-11), ("position.command", "A", 1e-8),
                                                          ("coil.y", "A", 1e-8), ("current.command", "V", 1e-7)]):
            numpy.testing.assert_allclose(result[name], [row[column] for row in rows], rtol=0, atol=tolerance)
            self.assertEqual(result.units[name], unit)
        # The slow controller holds its output for four fast samples.
        held = result["position.command"][:1200].reshape(-1, RATIO)
        self.assertTrue((held == held[:, :1]).all())
        self.assertGreater(len(numpy.unique(held[:, 0])), 200)
        # Settled to 2 % after 0.15 s, with less than a quarter of overshoot, and exact in the end
        self.assertLess(abs(result.within("slide.position", BEGIN + 0.15, 1) - STEP).max(), 0.02 * STEP)
        self.assertLess(result["slide.position"].max(), 1.25 * STEP)
        self.assertAlmostEqual(result["slide.position"][-1], STEP, delta=1e-7)

    def test_poles_of_a_whole_period(self):
        def period(start):
            loop = Loop(start)
            for _ in range(RATIO):
                loop.step(0.0)
            return loop.state()
        def significant(values):
            return numpy.sort_complex(values[abs(values) > 1e-6])
        own = numpy.linalg.eigvals(numpy.array([period(e) for e in numpy.eye(9)]).T)
        numpy.testing.assert_allclose(significant(poles("multirate", "--break", "current.reference")), significant(own), rtol=1e-5)
        self.assertLess(abs(own).max(), 1)

    def test_plan_names_both_rates(self):
        plan = call("plan", "multirate.json")
        self.assertIn("every 1 ticks from tick 0: 0.00025 s", plan)
        self.assertIn("every 4 ticks from tick 0: 0.001 s", plan)


if __name__ == "__main__":
    unittest.main()
