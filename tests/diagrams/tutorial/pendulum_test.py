"""The inverted pendulum against SciPy, with equations of motion from the energy."""

import json
import unittest

import numpy
import scipy.integrate
import scipy.linalg

from program import TUTORIAL, poles, run

CART, BOB, ROD, FRICTION, GRAVITY = 1.0, 0.2, 0.4, 0.5, 9.81  # kg, kg, m, N s/m, m/s²
STEP, BEGIN, STOP = 0.3, 4.0, 8.0  # m, s, s
START = numpy.radians(15)


def accelerations(velocity, angle, rate, force):
    """M(q) q'' = Q: the bob is at x + l sin a, l cos a."""
    s, c = numpy.sin(angle), numpy.cos(angle)
    mass = [[CART + BOB, BOB * ROD * c], [BOB * ROD * c, BOB * ROD**2]]
    return numpy.linalg.solve(mass, [force - FRICTION * velocity + BOB * ROD * s * rate**2, BOB * GRAVITY * ROD * s])


def gains():
    parameters = json.loads((TUTORIAL / "pendulum.json").read_text())["parameters"]
    return numpy.array([parameters[name]["value"] for name in ("k_position", "k_velocity", "k_angle", "k_rate")])


def upright():
    """A and B of x' = A x + B force at rest, by central differences."""
    def flow(x, force):
        acceleration = accelerations(x[1], x[2], x[3], force)
        return numpy.array([x[1], acceleration[0], x[3], acceleration[1]])
    h = 1e-5
    A = numpy.array([(flow(h * e, 0) - flow(-h * e, 0)) / (2 * h) for e in numpy.eye(4)]).T
    return A, ((flow(numpy.zeros(4), h) - flow(numpy.zeros(4), -h)) / (2 * h))[:, None]


class Pendulum(unittest.TestCase):
    def test_against_scipy(self):
        result, k = run("pendulum"), gains()
        rows, x = [], [0, 0, START, 0]
        for target, begin, end in ((0.0, 0.0, BEGIN), (STEP, BEGIN, STOP)):
            def flow(t, x, target=target):
                acceleration = accelerations(x[1], x[2], x[3], -k @ (x - [target, 0, 0, 0]))
                return [x[1], acceleration[0], x[3], acceleration[1]]
            time = numpy.arange(round(begin * 100), round(end * 100) + 1) / 100
            piece = scipy.integrate.solve_ivp(flow, (begin, end), x, method="DOP853", t_eval=time, rtol=1e-13, atol=1e-14)
            x = piece.y[:, -1]
            rows.extend(piece.y.T if end == STOP else piece.y.T[:-1])
        rows = numpy.array(rows)
        for column, name in enumerate(("position", "velocity", "angle", "rate")):
            numpy.testing.assert_allclose(result[f"plant.{name}"], rows[:, column], rtol=0, atol=1e-9)
        self.assertEqual([result.units[f"plant.{name}"] for name in ("position", "velocity", "angle", "rate")],
                         ["m", "m/s", "rad", "rad/s"])
        # It is caught: the cart had to move under the bob, and both came to rest.
        self.assertGreater(result.within("plant.position", 0, BEGIN).max(), 0.2)
        self.assertLess(abs(result.at("plant.angle", BEGIN)), 0.002)
        # The step begins the wrong way, and settles within 2 %.
        self.assertLess(result.within("plant.position", BEGIN, BEGIN + 0.5).min(), -0.005)
        self.assertLess(abs(result.within("plant.position", BEGIN + 3, STOP) - STEP).max(), 0.02 * STEP)

    def test_gains_are_optimal(self):
        A, B = upright()
        weight = numpy.diag([20, 2, 60, 2.0])
        riccati = scipy.linalg.solve_continuous_are(A, B, weight, [[0.5]])
        numpy.testing.assert_allclose(gains(), (B.T @ riccati)[0] / 0.5, rtol=2e-4)

    def test_poles(self):
        A, B = upright()
        numpy.testing.assert_allclose(poles("pendulum", "--set", "initial_angle=0"),
                                      numpy.sort_complex(numpy.linalg.eigvals(A - B * gains())), rtol=1e-6)

    def test_falls_from_too_far(self):
        for angle, falls in ((60, False), (65, True)):
            result = run("pendulum", f"initial_angle={angle}", "solver.stop=1.5")
            self.assertEqual(abs(result["plant.angle"]).max() > numpy.pi / 2, falls, angle)


if __name__ == "__main__":
    unittest.main()
