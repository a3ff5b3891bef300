"""The heated plate: exact steps of two heat capacities, and a PID controller in plain Python."""

import math
import unittest

import numpy

from program import exact_step, run

HEATER, PLATE, CONTACT, LOSS = 40.0, 400.0, 5.0, 0.8  # J/K, J/K, W/K, W/K
ROOM, WANTED, ZERO = 20.0, 80.0, 273.15  # degC, degC, K
T, BEGIN, DRAUGHT, STOP = 0.5, 60.0, 1500.0, 2400.0  # s
KP, KI, KD, POLE, TRACKING = 15.0, 0.15, 100.0, 0.5, 0.05
LOW, HIGH = 0.0, 100.0  # W


def plant(loss):
    """Both temperatures over the room, a sample later: x = F x + g power."""
    A = [[-CONTACT / HEATER, CONTACT / HEATER], [CONTACT / PLATE, -(CONTACT + loss) / PLATE]]
    return exact_step(A, [1 / HEATER, 0], T)


def reference(anti_windup):
    """Rows of plate, heater (degC) and power (W), one for each second."""
    steps = {False: plant(LOSS), True: plant(2 * LOSS)}
    x, integral, error_before, measured_before, slope, rows = numpy.zeros(2), 0.0, 0.0, ROOM, 0.0, []
    for k in range(int(STOP / T) + 1):
        t = k * T
        measured, target = ROOM + x[1], WANTED if t >= BEGIN else ROOM
        error = target - measured
        # trapezoidal integral; s/(1 + s/pole) of the measurement with s = 2/T (z - 1)/(z + 1)
        slope = ((2 - POLE * T) * slope - 2 * POLE * (measured - measured_before)) / (2 + POLE * T)
        added = KI * T * (error + error_before) / 2
        wanted = KP * error + integral + added + KD * slope
        power = min(max(wanted, LOW), HIGH)
        if anti_windup == "clamping" and (wanted - power) * added > 0:
            added = 0.0
        if anti_windup == "back_calculation":
            added -= (1 - math.exp(-TRACKING * T)) * (wanted - power)
        integral, error_before, measured_before = integral + added, error, measured
        if k % 2 == 0:
            rows.append((measured, ROOM + x[0], power))
        F, g = steps[t >= DRAUGHT]
        x = F @ x + g * power
    return numpy.array(rows)


class Thermal(unittest.TestCase):
    def compare(self, anti_windup):
        result = run("thermal", f"controller.anti_windup={anti_windup}")
        plate, heater, power = reference(anti_windup).T
        numpy.testing.assert_allclose(result["plate.y"] - ZERO, plate, atol=1e-5)
        numpy.testing.assert_allclose(result["heater.y"] - ZERO, heater, atol=1e-4)
        numpy.testing.assert_allclose(result["controller.command"], power, atol=1e-3)
        return result

    def overshoot(self, result):
        return result.within("plate.y", 0, DRAUGHT).max() - ZERO - WANTED

    def test_with_anti_windup(self):
        result = self.compare("back_calculation")
        self.assertEqual(result.units["plate.y"], "K")
        self.assertEqual(result["target.y"][0], ROOM + ZERO)
        self.assertEqual(result["target.y"][-1], WANTED + ZERO)
        self.assertEqual((result["controller.command"].min(), result["controller.command"].max()), (LOW, HIGH))
        self.assertLess(self.overshoot(result), 0.1)
        # The heat that both need, and what was lost on the way, at the full power
        full = (result["controller.command"] == HIGH) & (result["time"] < DRAUGHT)
        duration = result["time"][full].max() - BEGIN
        self.assertGreater(duration, (PLATE * 55 + HEATER * 60) / HIGH)
        # Steady: what the plate loses to the room, through the contact
        for time, loss in ((DRAUGHT - 1, LOSS), (STOP, 2 * LOSS)):
            power = loss * (WANTED - ROOM)
            self.assertAlmostEqual(result.at("plate.y", time) - ZERO, WANTED, delta=0.02)
            self.assertAlmostEqual(result.at("controller.command", time), power, delta=0.1)
            self.assertAlmostEqual(result.at("heater.y", time) - ZERO, WANTED + power / CONTACT, delta=0.05)
        # The draught costs less than three kelvins
        self.assertGreater(result.within("plate.y", DRAUGHT, STOP).min() - ZERO, WANTED - 3)

    def test_with_clamping(self):
        self.assertLess(self.overshoot(self.compare("clamping")), 0.2)

    def test_without_anti_windup(self):
        result = self.compare("none")
        self.assertGreater(self.overshoot(result), 20)


if __name__ == "__main__":
    unittest.main()
