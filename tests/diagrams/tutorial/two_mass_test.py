"""The two-mass drive: matrix exponentials along the seven phases of the motion."""

import unittest

import numpy
import scipy.linalg

from program import poles, run

PI = numpy.pi
MOTOR, LOAD, RESONANCE, ZETA, BANDWIDTH = 2.0, 3.0, 2 * PI * 50, 0.01, 2 * PI * 10  # kg, kg, rad/s, 1, rad/s
WAY, VELOCITY, ACCELERATION, JERK = 0.1, 0.5, 5.0, 250.0
BEGIN = 0.05  # s
ROW = 0.001  # s
ARRIVED = BEGIN + WAY / VELOCITY + VELOCITY / ACCELERATION + ACCELERATION / JERK


def closed_loop(depth=0.01):
    """x' = A x + B (r, r'') and load = C x, for x = the positions and velocities of motor and load, the slow signal of the
    derivative, and two states of the notch."""
    reduced, total = MOTOR * LOAD / (MOTOR + LOAD), MOTOR + LOAD
    stiffness, damping = reduced * RESONANCE**2, 2 * ZETA * reduced * RESONANCE
    kp, kd, pole = total * BANDWIDTH**2 / 3, total * BANDWIDTH, 10 * BANDWIDTH
    width = 0.5
    unit, r, acceleration = numpy.eye(9)[:7], numpy.eye(9)[7], numpy.eye(9)[8]
    x1, v1, x2, v2, slow, n1, n2 = [numpy.append(row, 0)[:9] for row in unit]
    error = r - x2
    command = kp * error + kd * pole * (error - slow)
    # y = u - (2 (width - depth) ω s / (s² + 2 width ω s + ω²)) u
    force = command - 2 * (width - depth) * RESONANCE * n2 + total * acceleration
    coupling = stiffness * (x1 - x2) + damping * (v1 - v2)
    rates = numpy.array([v1, (force - coupling) / MOTOR, v2, coupling / LOAD, pole * (error - slow),
                         n2, command - RESONANCE**2 * n1 - 2 * width * RESONANCE * n2])
    return rates[:, :7], rates[:, 7:], force


def motion():
    """Jerk in each row, from row to row."""
    rounding, constant = ACCELERATION / JERK, VELOCITY / ACCELERATION - ACCELERATION / JERK
    cruise = WAY / VELOCITY - VELOCITY / ACCELERATION - ACCELERATION / JERK
    phases = [(BEGIN, 0), (rounding, 1), (constant, 0), (rounding, -1), (cruise, 0), (rounding, -1), (constant, 0), (rounding, 1), (1, 0)]
    return numpy.concatenate([numpy.full(round(duration / ROW), sign * JERK) for duration, sign in phases])[:1001]


class TwoMass(unittest.TestCase):
    def test_against_the_matrix_exponential(self):
        A, B, force = closed_loop()
        # x, and position, velocity, acceleration and jerk of the motion
        whole = numpy.zeros((11, 11))
        whole[:7, :7], whole[:7, 7], whole[:7, 9] = A, B[:, 0], B[:, 1]
        whole[7:10, 8:11] = numpy.eye(3)
        step, x, rows = scipy.linalg.expm(whole * ROW), numpy.zeros(11), []
        for jerk in motion():
            rows.append(x.copy())
            x[10] = jerk
            x = step @ x
        rows = numpy.array(rows)
        result = run("two_mass")
        for column, name in ((7, "path.position"), (8, "path.velocity"), (9, "path.acceleration")):
            numpy.testing.assert_allclose(result[name], rows[:, column], atol=1e-9)
        numpy.testing.assert_allclose(result["drive.load_position"], rows[:, 2], atol=1e-9)
        numpy.testing.assert_allclose(result["drive.motor_position"], rows[:, 0], atol=1e-9)
        numpy.testing.assert_allclose(result["error.sum"], rows[:, 7] - rows[:, 2], atol=1e-9)
        numpy.testing.assert_allclose(result["force.sum"], rows[:, [*range(8), 9]] @ force, atol=1e-4)

    def test_the_motion_ends_when_it_must(self):
        result = run("two_mass")
        done = (result["path.done"] > 0.5) & (result["time"] > BEGIN)
        self.assertAlmostEqual(result["time"][done][0], ARRIVED, delta=1.1 * ROW)
        self.assertEqual([result.units[name] for name in ("path.position", "path.acceleration", "force.sum")], ["m", "m/s^2", "N"])
        self.assertAlmostEqual(result["path.velocity"].max(), VELOCITY, delta=1e-12)
        self.assertAlmostEqual(result["path.acceleration"].max(), ACCELERATION, delta=1e-9)
        self.assertLess(abs(result["error.sum"]).max(), 50e-6)

    def test_the_jerk_limit_keeps_the_load_quiet(self):
        def swing(*changes):
            return abs(run("two_mass", *changes).within("error.sum", ARRIVED + 0.15, ARRIVED + 0.3)).max()
        self.assertGreater(swing("jerk=100000"), 5 * swing())

    def test_the_notch_makes_it_stable(self):
        for depth, stable in ((0.01, True), (0.5, False)):
            A, *_ = closed_loop(depth)
            found = poles("two_mass", "--break", "notch.u", "--set", f"notch.depth_damping={depth}")
            numpy.testing.assert_allclose(found, numpy.sort_complex(numpy.linalg.eigvals(A)), rtol=1e-5)
            self.assertEqual(found.real.max() < 0, stable)
        self.assertGreater(abs(run("two_mass", "notch.depth_damping=0.5")["drive.load_position"]).max(), 10)


if __name__ == "__main__":
    unittest.main()
