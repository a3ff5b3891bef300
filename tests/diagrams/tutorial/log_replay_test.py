"""A log drives a model. The log is that of a motor whose numbers differ from the model's; it is computed here."""

import math
import unittest

import numpy

from program import TUTORIAL, answer, exact_step, run

L, K, T, ROWS = 0.5e-3, 0.05, 0.002, 1000  # H, N m/A, s
REAL = {"resistance": 0.62, "inertia": 230e-6, "friction": 0.16e-3}  # ohm, kg m², N m s/rad
MODEL = {"resistance": 0.5, "inertia": 200e-6, "friction": 0.1e-3}
CURRENT_STEP, COUNT = 0.01, 0.18  # A, deg: resolutions of the log


def voltages():
    """At rest for 50 ms, then a rectangular wave with a faster sine, V."""
    def wave(t):
        return 3 * (1 if math.sin(2 * math.pi * 0.8 * t) >= 0 else -1) + 2 * math.sin(2 * math.pi * 3.1 * t)
    return [0.0 if k < 25 else round(wave(k * T), 2) for k in range(ROWS)]


def driven(resistance, inertia, friction):
    """Current, speed and angle of each row."""
    F, g = exact_step([[-resistance / L, -K / L, 0], [K / inertia, -friction / inertia, 0], [0, 1, 0]], [1 / L, 0, 0], T)
    x, rows = numpy.zeros(3), []
    for u in voltages():
        rows.append(x)
        x = F @ x + g * u
    return numpy.array(rows)


def logged():
    """Current in A and angle in degrees as they stand in the log."""
    current, _, angle = driven(**REAL).T
    return numpy.round(current / CURRENT_STEP) * CURRENT_STEP, numpy.floor(numpy.degrees(angle) / COUNT + 0.5) * COUNT


class LogReplay(unittest.TestCase):
    def test_the_log_is_that_of_the_real_motor(self):
        heading, *rows = (TUTORIAL / "log_replay.csv").read_text().splitlines()
        self.assertEqual(heading, "time [ms],voltage [V],current [A],angle [deg]")
        expected = numpy.array([1000 * T * numpy.arange(ROWS), voltages(), *logged()]).T
        numpy.testing.assert_allclose([[float(x) for x in row.split(",")] for row in rows], expected, atol=0.006)

    def test_the_log_drives_the_model(self):
        """Units of the heading: milliseconds and degrees become seconds and radians."""
        result = run("log_replay")
        self.assertEqual(len(result["time"]), ROWS)
        self.assertAlmostEqual(result["time"][-1], 1.998, delta=1e-12)
        numpy.testing.assert_allclose(result["voltage.value"], voltages(), atol=1e-12)
        numpy.testing.assert_allclose(result["current.value"], logged()[0], atol=1e-9)
        numpy.testing.assert_allclose(result["angle.value"], numpy.radians(logged()[1]), atol=1e-4)
        simulated = driven(**MODEL)
        numpy.testing.assert_allclose(result["motor.current"], simulated[:, 0], atol=1e-6)
        numpy.testing.assert_allclose(result["motor.angle"], simulated[:, 2], atol=1e-7)
        self.assertEqual([result.units[name] for name in ("voltage.value", "motor.current", "angle.value")], ["V", "A", "rad"])

    def test_comparison(self):
        signals = answer("compare", "log_replay.json", "log_replay.experiment.json")["signals"]
        current, angle = logged()
        simulated = driven(**MODEL)
        for name, error in (("motor.current", simulated[:, 0] - current), ("motor.angle", simulated[:, 2] - numpy.radians(angle))):
            self.assertAlmostEqual(signals[name]["rmse"], numpy.sqrt(numpy.mean(error**2)), delta=1e-6)
            self.assertAlmostEqual(signals[name]["max_abs"], abs(error).max(), delta=1e-5)

    def test_fit_finds_the_real_motor(self):
        fit = answer("fit", "log_replay.json", "log_replay.experiment.json", "--parameters", *REAL)
        self.assertTrue(fit["converged"])
        for name, value in REAL.items():
            self.assertAlmostEqual(fit["parameters"][name]["value"] / value, 1, delta=1e-3)
        # What remains is the rounding of the log: a uniform error of a step.
        self.assertAlmostEqual(fit["signals"]["motor.current"]["held_out_after"], CURRENT_STEP / math.sqrt(12), delta=0.2 * CURRENT_STEP / math.sqrt(12))
        self.assertAlmostEqual(fit["signals"]["motor.angle"]["held_out_after"], math.radians(COUNT) / math.sqrt(12), delta=0.2 * math.radians(COUNT) / math.sqrt(12))


if __name__ == "__main__":
    unittest.main()
