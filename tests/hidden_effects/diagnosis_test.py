"""Fixed scenarios of the benchmark: every kind of motion, with no hidden effect and with several effects at once."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import score

GENERATOR, LOOPWRIGHT = sys.argv[1:3]

SCENARIOS = [
    (5, "constant_speeds", []),  # coarse counts, which look like a lag if the noise is underestimated
    (6, "constant_speeds", ["eddy_current_drag", "thermal_drift"]),
    (13, "constant_speeds", ["spring"]),  # a slow force that a shift of the input by 0.1 s would explain in part
    (33, "constant_speeds", ["input_delay", "encoder_periodic_error"]),  # a lag, if only the mean of the delayed staircase counts
    (8, "many_speeds", ["presliding_hysteresis", "input_delay"]),
    (3, "many_speeds", ["backlash"]),
    (4, "multisine", ["coulomb_friction", "force_gain"]),
    (9, "multisine", ["flexible_mode", "spring"]),
    (25, "multisine", ["backlash"]),  # impacts at uncertain moments
    (10, "forward", ["cogging", "constant_force"]),
    (11, "paper", ["encoder_periodic_error", "direction_dependent_friction"]),
    (34, "paper", ["input_delay", "coulomb_friction"]),
    (12, "paper", ["force_saturation", "end_stop"]),
]
# As drawn: a friction that remembers has narrow maxima beside the true one; noise that is not fitted again becomes a mode; a friction
# that holds the axis at rest with nearly all it has lets the predictor creep; laws of one variable that are added one at a time bend to
# what the others lack: a drag beside a spring and a ripple, two laws for three of the velocity, a hardening spring for a spring and a stop.
DRAWN = [150055, 150094, 902991, 904127, 904234, 904152]


def diagnosed(seed, *asked):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([GENERATOR, str(seed), folder, *asked], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([LOOPWRIGHT, "diagnose", folder / "nominal.json", folder / "train.experiment.json",
                        "--json", folder / "answer.json"], check=True, capture_output=True)
        return {"truth": json.loads((folder / "truth.json").read_text()),
                "answer": json.loads((folder / "answer.json").read_text())}


class Diagnosis(unittest.TestCase):
    def test_names_what_is_hidden_and_nothing_else(self):
        for seed, trajectory, effects in SCENARIOS:
            with self.subTest(seed=seed, trajectory=trajectory):
                result = diagnosed(seed, trajectory, *effects)
                self.assertEqual(sorted(score.true_names(result)), sorted(effects))
                self.assertTrue(score.exact(result), f"{effects} hidden, {score.found_names(result)} named")
                self.assertEqual(result["answer"]["verdict"], "explained" if effects else "nothing_missing")

    def test_names_three_effects_that_were_missed(self):
        for seed in DRAWN:
            with self.subTest(seed=seed):
                result = diagnosed(seed)
                self.assertEqual(len(score.true_names(result)), 3)
                self.assertTrue(score.exact(result), f"{score.true_names(result)} hidden, {score.found_names(result)} named")

    def test_a_load_is_found_in_its_gap_or_something_is_said_to_be_left(self):
        # 905682: along the path, without the moments of its blows, it promises more in half the gap. 904480: it hits a flank only where
        # the steady speeds change, and the work is spent before it is seen.
        for seed, may_be_flagged in ((905682, False), (904480, True)):
            with self.subTest(seed=seed):
                result = diagnosed(seed)
                hidden = next(e["parameters"]["gap"] for e in result["truth"]["effects"] if e["effect"] == "backlash")
                found = [e["parameters"]["gap"]["value"] for e in score.found(result) if e["effect"] == "backlash"]
                is_right = score.exact(result) and abs(found[0] / hidden - 1) < 0.1
                self.assertTrue(is_right or (may_be_flagged and score.flagged(result)),
                                f"a gap of {hidden} is told as {found}, {result['answer']['verdict']}")

    def test_a_late_input_that_could_not_be_compared_is_declared(self):
        result = diagnosed(905719)  # a delay of a part of a row beside a load in a gap, which takes all the work
        self.assertTrue(score.exact_or_declared(result), score.found_names(result))
        late = next(e for e in score.found(result) if e["effect"] in ("input_delay", "actuator_lag"))
        self.assertEqual({late["effect"], *score.alternatives(late)}, {"input_delay", "actuator_lag"})

    def test_fits_along_the_motion_of_the_answer(self):
        result = diagnosed(906104)  # along that of a wrong set, a drag is 1 % and a friction 3 % too small
        self.assertTrue(score.exact(result), score.found_names(result))
        self.assertEqual(result["answer"]["verdict"], "explained")

    def test_declares_laws_of_the_velocity_whose_sum_is_alike(self):
        result = diagnosed(903891)  # a drag of eddy currents is smooth friction, more square drag and less damping
        self.assertTrue(score.exact_or_declared(result), score.found_names(result))

    def test_names_what_is_beside_a_load_in_a_gap(self):
        seeds = {904359: "such a load swings on its flank between the blows, as one on a spring",
                 904805: "the load is thrown about, and no simulation shows what else is there"}
        for seed, why in seeds.items():
            with self.subTest(seed=seed, why=why):
                result = diagnosed(seed)
                self.assertTrue(score.exact(result), f"{score.true_names(result)} hidden, {score.found_names(result)} named")

    def test_goes_on_from_an_answer_that_leaves_something(self):
        seeds = {905081: "a function without a name takes the place of a mass beside a load in a gap",
                 905138: "names that cancel lead to two right ones, beside which a third is missing"}
        for seed, why in seeds.items():
            with self.subTest(seed=seed, why=why):
                result = diagnosed(seed)
                self.assertTrue(score.exact(result), f"{score.true_names(result)} hidden, {score.found_names(result)} named")

    def test_finds_the_mass_behind_the_gap(self):
        result = diagnosed(130015)  # a lighter load on a harder contact is a maximum of the likelihood beside the true one
        self.assertEqual(score.found_names(result), ["backlash"])
        mass = result["truth"]["effects"][0]["parameters"]["load_mass"]
        self.assertAlmostEqual(score.found(result)[0]["parameters"]["load_mass"]["value"] / mass, 1, delta=0.1)

    def test_finds_the_gap_although_the_moments_of_the_blows_are_hardly_known(self):
        result = diagnosed(62, "constant_speeds", "backlash")  # few impacts; their exact moments cannot be predicted
        self.assertEqual(score.found_names(result), ["backlash"])
        gap = result["truth"]["effects"][0]["parameters"]["gap"]
        self.assertAlmostEqual(score.found(result)[0]["parameters"]["gap"]["value"] / gap, 1, delta=0.05)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
