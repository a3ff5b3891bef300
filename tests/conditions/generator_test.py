"""The generator of the conditions benchmark: the same bits everywhere, records that follow from the truth, gains that
a likelihood confirms."""

import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from scipy.linalg import expm

GENERATOR = pathlib.Path(sys.argv[1]).resolve()
# Settings by which glibc avoids certain instructions. Other C libraries ignore the variable.
CHOICES = ["", "glibc.cpu.hwcaps=-FMA,-AVX2"]


def generated(folder, *arguments, choice=""):
    environment = dict(os.environ, **({"GLIBC_TUNABLES": choice} if choice else {}))
    seed, *more = arguments
    subprocess.run([str(GENERATOR), str(seed), str(folder), *more], check=True, env=environment)
    truth = json.loads((folder / "truth.json").read_text())
    with open(folder / "record.csv") as file:
        rows = list(csv.reader(file))
    return truth, rows[0], np.array(rows[1:], dtype=float)


def parameter(truth, effect, name):
    return next((e["parameters"][name] for e in truth["effects"] if e["effect"] == effect), 0)


def laws(truth):
    """∂slopes/∂states of (position, velocity, other position, other velocity), and of a force at the motor and on the carriage.

    Linear effects alone: added mass and damping, a spring, a constant force."""
    machine = truth["nominal"]
    other = machine.get("load") or machine.get("motor")
    mass = machine["mass"] + parameter(truth, "inertia", "mass")
    damping = machine["damping"] + parameter(truth, "viscous_friction", "damping")
    spring = parameter(truth, "spring", "stiffness")
    a, motor, carriage = np.zeros((4, 4)), np.zeros(4), np.zeros(4)
    a[0, 1] = 1
    a[1, 0], a[1, 1] = -spring / mass, -damping / mass
    carriage[1] = 1 / mass
    if other:
        a[2, 3] = 1
        for row, sign, body in ((1, -1, mass), (3, 1, other["mass"])):
            a[row] += sign / body * np.array([other["stiffness"], other["damping"], -other["stiffness"], -other["damping"]])
    motor[3 if "motor" in machine else 1] = 1 / (other["mass"] if "motor" in machine else mass)
    return a, motor, carriage


def simulated(truth, time, force):
    """The motion from rest at zero, with the recorded force held from row to row, or on a straight line between rows."""
    a, motor, carriage = laws(truth)
    constant = parameter(truth, "spring", "stiffness") * parameter(truth, "spring", "rest_position") \
        - parameter(truth, "constant_force", "level") - truth["nominal"].get("gravity", 0)
    state, motion, known = np.zeros(4), np.zeros((len(time), 2)), {}
    slopes = np.diff(force, append=force[-1]) if truth["interpolation"] != "hold" else np.zeros(len(time))
    for k in range(len(time)):
        motion[k] = state[:2]
        if k + 1 == len(time):
            break
        h = round(time[k + 1] - time[k], 12)
        if h not in known:  # states, force at the motor, its slope a sample, force on the carriage
            whole = np.zeros((7, 7))
            whole[:4, :4], whole[:4, 4], whole[:4, 6], whole[4, 5] = a, motor, carriage, 1 / h
            known[h] = expm(whole * h)[:4]
        state = known[h] @ np.concatenate([state, [force[k], slopes[k], constant]])
    return motion


def in_si(truth, header, table):
    """Time, command as a force without that of the back-EMF, position or velocity from zero."""
    sensor = truth["sensor"]
    time = table[:, 0] * (1e-3 if truth["time_unit"] == "ms" else 1)
    force = table[:, 1]
    if "motor" in truth:
        force = force * truth["motor"]["constant"] / truth["motor"]["resistance"]
    scale = {"mm": 1e-3, "deg": math.pi / 180, "count": sensor["resolution"]}.get(sensor["unit"], 1)
    moved = table[:, 2] * scale
    return time, force, moved - moved[0] if sensor["quantity"] == "position" else moved


class SameBits(unittest.TestCase):
    def test_whatever_instructions_the_c_library_selects(self):
        with tempfile.TemporaryDirectory() as name:
            for seed in (43, 28, 39, 41):
                texts = []
                for i, choice in enumerate(CHOICES):
                    folder = pathlib.Path(name) / f"{seed}_{i}"
                    generated(folder, seed, choice=choice)
                    texts.append((folder / "record.csv").read_bytes() + (folder / "truth.json").read_bytes())
                self.assertEqual(texts[0], texts[1], seed)


class Records(unittest.TestCase):
    def test_follow_from_the_truth_and_the_recorded_command(self):
        with tempfile.TemporaryDirectory() as name:
            for condition, seed, effects in (
                    ("mass", 3, ["viscous_friction", "spring"]), ("rotary", 3, ["inertia", "constant_force"]),
                    ("rate", 3, ["viscous_friction"]), ("jitter", 3, ["spring"]), ("rounded_stamps", 3, ["inertia"]),
                    ("gaps", 4, ["constant_force"]), ("origin", 3, ["inertia"]), ("column_units", 3, ["spring"]),
                    ("column_units", 6, ["inertia"]), ("column_units", 7, ["viscous_friction"]),
                    ("voltage", 3, ["inertia", "constant_force"]), ("velocity_only", 3, ["viscous_friction"]),
                    ("counts", 3, ["spring"]), ("no_noise", 3, ["inertia"]), ("known_nominal", 3, ["viscous_friction"]),
                    ("known_nominal", 7, ["inertia"]), ("load_side", 3, ["viscous_friction", "inertia"]), ("gantry", 3, ["inertia"]),
                    ("between_samples", 6, ["viscous_friction"]), ("between_samples", 7, ["spring"]),
                    ("few_rows_between_turns", 1, ["inertia", "spring"])):
                with self.subTest(condition=condition, seed=seed):
                    truth, header, table = generated(pathlib.Path(name) / f"{condition}_{seed}", seed, "--quiet", condition, *effects)
                    self.assertFalse({"cogging", "stribeck"} & set(truth["nominal"]), "laws that are not linear: take another seed")
                    time, force, measured = (column[:8000] for column in in_si(truth, header, table))
                    motion = simulated(truth, time, force)[:, 1 if truth["sensor"]["quantity"] == "velocity" else 0]
                    # A smooth command is not quite straight between rows; a position in counts is rounded.
                    tolerance = 1e-5 if truth["interpolation"] == "band_limited" else 1e-6
                    tolerance += (truth["sensor"]["resolution"] if truth["sensor"]["unit"] == "count" else 0) / np.ptp(measured)
                    self.assertLess(np.max(np.abs(motion - measured)) / np.ptp(measured), tolerance)

    def test_are_sampled_at_their_own_stamps_where_the_clock_jitters(self):
        with tempfile.TemporaryDirectory() as name:
            truth, header, table = generated(pathlib.Path(name) / "r", 7, "--quiet", "jitter", "spring")
            self.assertEqual(truth["variant"], "8 to 30 %")
            time, force, measured = (column[:4000] for column in in_si(truth, header, table))
            self.assertGreater(np.std(np.diff(time)) / truth["sample_time_s"], 0.02)
            errors = [np.max(np.abs(simulated(truth, t, force)[:, 0] - measured)) / np.ptp(measured)
                      for t in (time, np.arange(len(time)) * truth["sample_time_s"])]
            self.assertLess(errors[0], 1e-6)
            self.assertGreater(errors[1], 1e-4)


class Seeds(unittest.TestCase):
    def test_cover_all_conditions(self):
        with tempfile.TemporaryDirectory() as name:
            truths = [generated(pathlib.Path(name) / str(seed), seed)[0] for seed in range(20, 40)]
        self.assertEqual(len({t["condition"] for t in truths}), 20)
        self.assertTrue(all(t["effects"] for t in truths))


def minus_two_log_likelihood(truth, time, force, measured, with_effects):
    """Of a linear machine, by a Kalman filter with the slow force as a state."""
    bare = dict(truth, effects=truth["effects"] if with_effects else [])
    a, motor, carriage = laws(bare)
    h, noise = truth["sample_time_s"], truth["noise"]
    whole = np.zeros((6, 6))
    whole[:4, :4], whole[:4, 4], whole[:4, 5] = a, motor, carriage
    step = expm(whole * h)
    memory = math.exp(-h / noise["slow_time_s"])
    transition = np.zeros((5, 5))
    transition[:4, :4], transition[:4, 4], transition[4, 4] = step[:4, :4], step[:4, 4], memory
    drive, constant = np.append(step[:4, 4], 0), np.append(step[:4, 5], 0) * -parameter(bare, "constant_force", "level")
    covariance = noise["white_force"]**2 * np.outer(drive, drive)
    covariance[4, 4] += (1 - memory**2) * noise["slow_force"]**2
    variance_measured = noise["sensor"]**2 + truth["sensor"]["resolution"]**2 / 12
    at = 1 if truth["sensor"]["quantity"] == "velocity" else 0
    state, p, total = np.zeros(5), np.diag([0, 0, 0, 0, noise["slow_force"]**2]), 0.0
    for k in range(len(time)):
        s = p[at, at] + variance_measured
        error = measured[k] - state[at]
        total += math.log(s) + error**2 / s
        gain = p[:, at] / s
        state, p = state + gain * error, p - np.outer(gain, p[at])
        state, p = transition @ state + drive * force[k] + constant, transition @ p @ transition.T + covariance
    return total


class Gains(unittest.TestCase):
    def test_are_those_of_a_likelihood(self):
        for seed, condition, effect in ((1, "loud", "viscous_friction"), (3, "mass", "inertia"), (3, "rotary", "constant_force"),
                                        (3, "velocity_only", "inertia"), (3, "load_side", "viscous_friction")):
            with self.subTest(effect=effect), tempfile.TemporaryDirectory() as name:
                truth, header, table = generated(pathlib.Path(name) / "r", seed, condition, effect)
                self.assertNotIn("cogging", truth["nominal"])
                record = in_si(truth, header, table)
                gain = minus_two_log_likelihood(truth, *record, False) - minus_two_log_likelihood(truth, *record, True)
                expected = truth["effects"][0]["gain"]
                # Rows at rest carry force in the likelihood alone.
                self.assertAlmostEqual(gain / expected, 1, delta=0.25 if effect == "constant_force" else 0.08)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
