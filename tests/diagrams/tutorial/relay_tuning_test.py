"""Relay tuning: the oscillation against an exact simulation of its own, and against the process' ultimate gain and period."""

import math
import unittest

import numpy
from scipy.optimize import brentq

from program import exact_step, run

GAIN, SLOW, FAST, DEAD = 1.6, 8.0, 3.0, 1.5  # 1, s, s, s
BIAS, SWING, HYSTERESIS, T = 0.625, 0.3, 0.002, 0.05
JUMP = 180.0  # s, of the setpoint


def ultimate():
    """Gain and period at which the process, with the hold of the sampling, lags by half a turn."""
    def phase(w):
        return math.pi - math.atan(SLOW * w) - math.atan(FAST * w) - w * (DEAD + T / 2)
    w = brentq(phase, 0.01, 2)
    return math.hypot(1, SLOW * w) * math.hypot(1, FAST * w) / GAIN, 2 * math.pi / w


def oscillation():
    """Gain and period from five periods under the relay, sample by sample with the exact solution of the process."""
    A = [[-1 / SLOW, 0], [1 / FAST, -1 / FAST]]
    F, g = exact_step(A, [GAIN / SLOW, 0], T)
    x, on, commands = numpy.zeros(2), True, [BIAS] * round(DEAD / T)
    rises, area = [], 0.0
    for k in range(10000):
        error = 1 - x[1]
        before, on = on, (error > -HYSTERESIS if on else error > HYSTERESIS)
        if on and not before:
            rises.append((k * T, area))
            area = 0.0
            if len(rises) == 6:
                period = rises[-1][0] - rises[-2][0]
                return 8 * SWING * period / (math.pi**2 * rises[-1][1]), period
        area += T * abs(error)
        commands.append(BIAS + (SWING if on else -SWING))
        x = F @ x + g * commands.pop(0)
    raise AssertionError("it does not oscillate")


class RelayTuning(unittest.TestCase):
    def setUp(self):
        self.result = run("relay_tuning")

    def test_measures_the_oscillation(self):
        gain, period = oscillation()
        self.assertAlmostEqual(self.result["Tu.y"][-1], period, delta=T + 1e-9)
        self.assertAlmostEqual(self.result["Ku.y"][-1] / gain, 1, delta=0.01)

    def test_comes_close_to_the_ultimate_gain_and_period(self):
        gain, period = ultimate()
        self.assertAlmostEqual(self.result["Ku.y"][-1] / gain, 1, delta=0.15)  # a describing function is no more exact
        self.assertAlmostEqual(self.result["Tu.y"][-1] / period, 1, delta=0.06)

    def test_the_controller_takes_over_and_follows(self):
        tuned = self.result["order.tuned"]
        self.assertEqual(tuned[0], 0)
        begin = self.result["time"][numpy.argmax(tuned > 0.5)]
        self.assertLess(begin, 100)
        settled = self.result.within("process.y", JUMP - 20, JUMP)
        numpy.testing.assert_allclose(settled, 1, atol=0.01)
        after = self.result.within("process.y", JUMP, 260)
        self.assertLess(after.max(), 1.3 * 1.02)
        self.assertAlmostEqual(after[-1], 1.3, delta=0.02)

    def test_the_gains_are_those_of_the_rule_and_stable_with_margin(self):
        gain, period = self.result["Kp.y"][-1], 2.2 * self.result["Tu.y"][-1]
        self.assertAlmostEqual(gain, self.result["Ku.y"][-1] / 3.2, places=9)
        w = numpy.logspace(-3, 1, 20000)
        s = 1j * w
        loop = gain * (1 + 1 / (period * s)) * GAIN / ((1 + SLOW * s) * (1 + FAST * s)) * numpy.exp(-s * (DEAD + T / 2))
        self.assertLess(numpy.abs(1 / (1 + loop)).max(), 2)  # the greatest sensitivity: robust loops have 1.2 to 2


if __name__ == "__main__":
    unittest.main()
