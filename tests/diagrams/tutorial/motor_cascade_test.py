"""The cascade of three loops on a DC motor: limits by hand, the response to the load by the matrix exponential."""

import unittest

import numpy
import scipy.linalg

from program import run

PI = numpy.pi
R, L, K, J, B = 0.5, 0.5e-3, 0.05, 200e-6, 0.1e-3  # ohm, H, N m/A, kg m², N m s/rad
CURRENT, SPEED, POSITION = 2 * PI * 300, 2 * PI * 50, 2 * PI * 8  # rad/s
GREATEST_CURRENT, GREATEST_SPEED, WAY, LOAD, SUPPLY = 10, 40, 10, 0.2, 24  # A, rad/s, rad, N m, V
BEGIN, LOADED = 0.05, 0.7  # s


def linear():
    """x' = A x + T load for x = current, speed, angle, and the integrals of the speed and current controllers, all limits aside."""
    speed_error = numpy.array([0, -1, -POSITION, 0, 0.0])
    wanted_current = J * SPEED / K * speed_error + numpy.eye(5)[3]
    current_error = wanted_current - numpy.eye(5)[0]
    voltage = L * CURRENT * current_error + numpy.eye(5)[4]
    A = numpy.array([(voltage - numpy.array([R, K, 0, 0, 0])) / L,
                     numpy.array([K, -B, 0, 0, 0]) / J,
                     [0, 1, 0, 0, 0],
                     J * SPEED**2 / (4 * K) * speed_error,
                     R * CURRENT * current_error])
    return A, numpy.array([0, -1 / J, 0, 0, 0])


class MotorCascade(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.result = run("motor_cascade")

    def test_units(self):
        units = self.result.units
        self.assertEqual([units[name] for name in ("motor.angle", "motor.speed", "motor.current", "current.command")],
                         ["rad", "rad/s", "A", "V"])

    def test_limits_are_used_and_kept(self):
        result = self.result
        self.assertEqual(result["speed_limit.y"].max(), GREATEST_SPEED)
        self.assertEqual(result["speed.command"].max(), GREATEST_CURRENT)
        numpy.testing.assert_array_equal(result["target.y"], numpy.where(result["time"] >= BEGIN, WAY, 0))
        self.assertAlmostEqual(result["current.command"].max(), L * CURRENT * GREATEST_CURRENT, delta=1e-9)
        # While the wanted current is at its limit, the current is there too, short of what the voltage of the growing speed takes:
        # the integral of the current controller follows a ramp of v late, by its slope over the bandwidth and R.
        growth = (K * GREATEST_CURRENT - B * 20) / J  # rad/s²
        late = K * growth / (R * CURRENT)
        self.assertAlmostEqual(result.at("motor.current", BEGIN + 0.012), GREATEST_CURRENT - late, delta=0.02)
        slope = numpy.diff(result.within("motor.speed", BEGIN + 0.010, BEGIN + 0.012)) / 0.001
        numpy.testing.assert_allclose(slope, (K * (GREATEST_CURRENT - late) - B * 25) / J, rtol=0.005)
        # At the greatest speed for a while
        numpy.testing.assert_allclose(result.within("motor.speed", 0.15, 0.18), GREATEST_SPEED, rtol=0.005)
        self.assertLess(result["motor.speed"].max(), 1.05 * GREATEST_SPEED)
        self.assertAlmostEqual(result.at("motor.current", 0.25), B * GREATEST_SPEED / K, delta=1e-5)

    def test_the_voltage_is_limited_to_the_supply(self):
        self.assertGreater(L * 2 * PI * 1000 * GREATEST_CURRENT, SUPPLY)
        self.assertEqual(run("motor_cascade", "current_bandwidth=1000")["current.command"].max(), SUPPLY)

    def test_settles_without_overshoot(self):
        angle = self.result.within("motor.angle", 0, LOADED - 0.001)
        self.assertLess(angle.max(), WAY + 1e-5)
        # At the greatest speed up to where the position loop takes over, then down by its own time constant
        arrived = BEGIN + WAY / GREATEST_SPEED + numpy.log(0.02 * WAY * POSITION / GREATEST_SPEED) / -POSITION
        settled = self.result["time"][:len(angle)][abs(angle - WAY) > 0.02 * WAY].max()
        self.assertAlmostEqual(settled, arrived, delta=0.02)
        self.assertLess(abs(angle[-1] - WAY), 1e-5)

    def test_overshoots_where_the_current_does_not_suffice(self):
        """The rule of the description: the motor must be able to stop within the way on which the position loop brakes."""
        for speed in (40, 120):
            feasible = speed**2 / (2 * K * GREATEST_CURRENT / J) < speed / POSITION
            overshoot = run("motor_cascade", f"greatest_speed={speed}").within("motor.angle", 0, LOADED - 0.001).max() - WAY
            self.assertEqual(overshoot < 1e-3, feasible, speed)

    def test_response_to_the_load(self):
        A, load = linear()
        self.assertLess(numpy.linalg.eigvals(A).real.max(), -20)
        after = self.result["time"] >= LOADED
        time = self.result["time"][after] - LOADED
        # x(t) = A⁻¹ (e^(A t) - 1) T load
        x = numpy.array([numpy.linalg.solve(A, (scipy.linalg.expm(A * t) - numpy.eye(5)) @ (load * LOAD)) for t in time])
        start = self.result.at("motor.angle", LOADED)
        numpy.testing.assert_allclose(self.result["motor.angle"][after] - start, x[:, 2], atol=5e-6)
        numpy.testing.assert_allclose(self.result["motor.current"][after], x[:, 0], atol=5e-4)
        self.assertLess(x[:, 2].min(), -0.01)

    def test_steady_state(self):
        result = self.result
        self.assertAlmostEqual(result["motor.angle"][-1], WAY, delta=1e-6)
        self.assertAlmostEqual(result["motor.current"][-1], LOAD / K, delta=1e-5)
        self.assertAlmostEqual(result["current.command"][-1], R * LOAD / K, delta=1e-5)


if __name__ == "__main__":
    unittest.main()
