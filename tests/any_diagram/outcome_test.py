"""The judge of the benchmark of any diagram."""

import copy
import unittest

import outcome

OVERFLOW = {"law": "overflow", "shapes": ["overflow"], "sites": ["balance1.sum"], "variables": ["level1.y"], "also": [], "gain": 500, "counts": True}
BUMP = {**OVERFLOW, "law": "bump", "shapes": []}


def result(effects, parameters, found, moved=(), verdict="explained", kind="one", others=(), alternatives=()):
    return {"truth": {"seed": 1, "plant": "tanks", "class": kind, "effects": copy.deepcopy(effects),
                      "parameters": [{"name": n, "stated": 1, "true": 1.2, "gain": 500, "counts": True} for n in parameters],
                      "outputs": ["level1.y", "level2.y"], "simulation": [0.2, 0.1]},
            "answer": {"verdict": verdict, "effects": [{"site": s, "effect": e, "variables": v, "alternatives": list(alternatives)}
                                                       for s, e, v in found],
                       "moved_parameters": {n: {} for n in moved}, "other_explanations": list(others), "steps": [{"simulation_rmse": 0.11}],
                       "error": {"port": "level2.y"}},
            "exit": 0, "over_limit": False, "time_s": 2.0, "text": ""}


RIGHT = ("balance1.sum", "overflow", ["level1.y"])


class Judge(unittest.TestCase):
    def expect(self, name, judged):
        self.assertEqual(outcome.classify(judged), name, outcome.describe(judged))

    def test_the_hidden_term_at_its_site_is_exact(self):
        self.expect("exact", result([OVERFLOW], [], [RIGHT]))

    def test_another_site_variable_or_shape_is_wrong(self):
        for wrong in (("balance2.sum", "overflow", ["level1.y"]), ("balance1.sum", "overflow", ["level2.y"]), ("balance1.sum", "cube", ["level1.y"])):
            self.expect("silent", result([OVERFLOW], [], [wrong]))
            self.expect("flagged", result([OVERFLOW], [], [wrong], verdict="partly_explained"))

    def test_a_term_or_parameter_too_many_or_missing_is_wrong(self):
        self.expect("silent", result([OVERFLOW], [], [RIGHT, RIGHT]))
        self.expect("silent", result([OVERFLOW], [], [RIGHT], ["area1"]))
        self.expect("silent", result([OVERFLOW], [], [], verdict="nothing_missing"))
        self.expect("silent", result([OVERFLOW], ["area1"], [RIGHT]))

    def test_what_the_record_hardly_shows_may_be_missing(self):
        faint = {**OVERFLOW, "counts": False}
        self.expect("exact", result([faint], [], [], verdict="nothing_missing"))
        self.expect("exact", result([faint], [], [RIGHT]))

    def test_declared_alternatives_count(self):
        self.expect("declared", result([OVERFLOW], [], [("balance1.sum", "cube", ["level1.y"])], alternatives=["balance1.sum: overflow(level1.y)"]))
        instead = {"in_place_of": ["area1"], "effects": ["balance1.sum: overflow(level1.y)"]}
        self.expect("declared", result([OVERFLOW], [], [], ["area1"], others=[instead]))
        self.expect("declared", result([], ["outlet1"], [], ["area1"], kind="parameter", others=[{"in_place_of": ["area1"], "effects": ["outlet1"]}]))

    def test_a_clean_record_must_be_called_that(self):
        self.expect("exact", result([], [], [], verdict="nothing_missing", kind="clean"))
        self.expect("flagged", result([], [], [], verdict="unexplained", kind="clean"))

    def test_outside_the_catalogue_a_function_at_the_site_is_exact(self):
        self.expect("exact", result([BUMP], [], [("balance1.sum", "unknown", ["level1.y"])], verdict="partly_explained", kind="outside"))
        self.expect("silent", result([BUMP], [], [("balance1.sum", "periodic", ["level1.y"])], kind="outside"))

    def test_an_end_without_an_answer(self):
        ended = {**result([], [], []), "answer": None}
        self.expect("refused", {**ended, "exit": 2, "text": "error: too few rows"})
        self.expect("crash", {**ended, "exit": -11})
        self.expect("over_limit", {**ended, "over_limit": True})

    def test_sites_and_simulation(self):
        self.assertTrue(outcome.sites_are_right(result([OVERFLOW], [], [("balance1.sum", "cube", ["level1.y"])])))
        self.assertFalse(outcome.sites_are_right(result([OVERFLOW], [], [("balance2.sum", "overflow", ["level1.y"])])))
        self.assertFalse(outcome.sites_are_right(result([OVERFLOW], [], [])))
        self.assertAlmostEqual(outcome.simulation_ratio(result([], [], [])), 1.1)

    def test_the_tables_have_every_bar(self):
        text = outcome.text(outcome.summary([result([OVERFLOW], [], [RIGHT]), result([], [], [], verdict="nothing_missing", kind="clean")]))
        self.assertIn("false effects on clean and parameter-only records", text)
        self.assertIn("| tanks", text)


if __name__ == "__main__":
    unittest.main()
