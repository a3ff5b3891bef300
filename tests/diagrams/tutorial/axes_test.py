"""The gantry and the three axes: closed forms and the matrix exponential."""

import unittest

import numpy
import scipy.linalg

from program import run, step_response, step_velocity

PI = numpy.pi


def mass_matrix(trolley):
    """Of beam and trolley for the positions of both ends: the sum of m J^T J over all that moves."""
    span, middle, turn = 1.0, numpy.array([0.5, 0.5]), numpy.array([-1.0, 1.0])
    at_trolley = middle + trolley / span * turn
    return 12 * numpy.outer(middle, middle) + 1 / span**2 * numpy.outer(turn, turn) + 8 * numpy.outer(at_trolley, at_trolley)


class Gantry(unittest.TestCase):
    WAY, FIRST, SECOND, NATURAL, DAMPING, PLACE = 0.01, 0.1, 0.5, 2 * PI * 5, 0.7, 0.3

    def test_the_mass_matrix_decouples(self):
        result = run("gantry")
        for end, begin in ((0, self.FIRST), (1, self.SECOND)):
            expected = self.WAY * step_response(self.NATURAL, self.DAMPING, result["time"] - begin)
            numpy.testing.assert_allclose(result[f"position.y[{end}]"], expected, rtol=0, atol=1e-10)
        # The second motor must push to keep its end at rest.
        self.assertAlmostEqual(result.within("force.y[1]", 0, 0.3).max(),
                               abs(mass_matrix(self.PLACE)[0, 1]) * self.NATURAL**2 * self.WAY, delta=10)
        self.assertEqual([result.units["position.y[0]"], result.units["force.y[1]"]], ["m", "N"])

    def test_forces(self):
        result = run("gantry")
        at = result["time"] == self.FIRST
        expected = mass_matrix(self.PLACE) @ [self.NATURAL**2 * self.WAY, 0]
        numpy.testing.assert_allclose([result["force.y[0]"][at][0], result["force.y[1]"][at][0]], expected, rtol=1e-9, atol=1e-9)

    def test_without_decoupling(self):
        """Four states by the matrix exponential: the first end disturbs the second."""
        result = run("gantry", "decoupling=0")
        gain = numpy.linalg.solve(mass_matrix(self.PLACE), numpy.diag(numpy.diag(mass_matrix(self.PLACE))))
        stiff = self.NATURAL**2 * gain
        A = numpy.block([[numpy.zeros((2, 2)), numpy.eye(2)], [-stiff, -2 * self.DAMPING * self.NATURAL * gain]])

        def after(begin, end):
            whole = numpy.block([[A, numpy.append([0, 0], stiff[:, end])[:, None] * self.WAY], [numpy.zeros((1, 5))]])
            return numpy.array([scipy.linalg.expm(whole * max(t - begin, 0))[:2, 4] for t in result["time"]])
        expected = after(self.FIRST, 0) + after(self.SECOND, 1)
        numpy.testing.assert_allclose(numpy.array([result["position.y[0]"], result["position.y[1]"]]).T, expected, rtol=0, atol=1e-9)
        self.assertGreater(abs(result.within("position.y[1]", 0, self.SECOND)).max(), 0.05 * self.WAY)


class ThreeAxes(unittest.TestCase):
    AXES = {"x": 2 * PI * 6, "y": 2 * PI * 10, "z": 2 * PI * 15}
    MASS = {"x": 12, "y": 8, "z": 3}
    WAY, BEGIN, GRAVITY = 0.005, 0.1, 9.81

    def compare(self, result, sags):
        for name, natural in self.AXES.items():
            expected = self.WAY * step_response(natural, 0.8, result["time"] - self.BEGIN)
            if sags and name == "z":
                expected -= self.GRAVITY / natural**2 * step_response(natural, 0.8, result["time"])
            numpy.testing.assert_allclose(result[f"{name}.position"], expected, rtol=0, atol=1e-10)
            self.assertEqual(result.units[f"{name}.position"], "m")
            # The motor accelerates the mass, and overcomes friction and weight.
            weight = self.MASS[name] * self.GRAVITY if name == "z" else 0
            if not sags:
                velocity = self.WAY * step_velocity(natural, 0.8, result["time"] - self.BEGIN)
                target = numpy.where(result["time"] >= self.BEGIN, self.WAY, 0)
                acceleration = natural**2 * (target - expected) - 2 * 0.8 * natural * velocity
                numpy.testing.assert_allclose(result[f"{name}.force"], self.MASS[name] * acceleration + 20 * velocity + weight, atol=1e-6)
            self.assertAlmostEqual(result[f"{name}.force"][-1], weight, delta=1e-3)

    def test_every_copy_has_its_own_parameters(self):
        self.compare(run("three_axes"), sags=True)

    def test_compensated_weight(self):
        self.compare(run("three_axes", "z.compensation=1"), sags=False)

    def test_a_parameter_of_one_copy_leaves_the_others_alone(self):
        before, after = run("three_axes"), run("three_axes", "y.bandwidth=20")
        for name in "xz":
            numpy.testing.assert_allclose(after[f"{name}.position"], before[f"{name}.position"], rtol=0, atol=1e-10)
        numpy.testing.assert_allclose(after["y.position"], self.WAY * step_response(2 * PI * 20, 0.8, after["time"] - self.BEGIN), rtol=0, atol=1e-10)


if __name__ == "__main__":
    unittest.main()
