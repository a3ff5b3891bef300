"""The score of hand-written answers."""

import unittest

import score


def hidden(*names, trajectory="paper"):
    return {"seed": 1, "kind": "hidden", "trajectory": trajectory, "controller": "cascade",
            "effects": [{"effect": n, "own_force_rms_N": 0.1, "parameters": {"level": 0.2}} for n in names]}


def named(name, *alternatives, **more):
    return {"effect": name, "parameters": {}, "inclusion": 0.99, "alternatives": list(alternatives), **more}


def result(truth, *effects, verdict="explained", **more):
    return {"truth": truth, "answer": {"verdict": verdict, "effects": list(effects), **more}, "time_s": 1.0}


class Sets(unittest.TestCase):
    def test_order_does_not_matter_for_the_set_but_for_the_first(self):
        r = result(hidden("spring", "cogging"), named("cogging"), named("spring"))
        self.assertTrue(score.exact(r))
        self.assertTrue(score.first_true(result(hidden("cogging"), named("cogging"), named("spring"))))
        self.assertFalse(score.first_true(result(hidden("cogging"), named("spring"), named("cogging"))))

    def test_a_missed_and_an_extra_effect_are_wrong(self):
        self.assertFalse(score.exact(result(hidden("coulomb_friction", "cogging"), named("cogging"))))
        self.assertFalse(score.exact(result(hidden("cogging"), named("cogging"), named("inertia"))))

    def test_declared_alternative_counts_only_as_declared(self):
        r = result(hidden("input_delay", "cogging"), named("actuator_lag", "input_delay"), named("cogging"))
        self.assertFalse(score.exact(r))
        self.assertTrue(score.exact_or_declared(r))

    def test_alternatives_do_not_excuse_an_extra_effect(self):
        self.assertFalse(score.exact_or_declared(result(hidden("cogging"), named("cogging"), named("spring", "cogging"))))

    def test_a_declared_set_counts_as_declared_with_the_alternatives_of_what_stays(self):
        other = [{"in_place_of": ["inertia", "viscous_friction"], "effects": ["force_gain"]}]
        said = (named("inertia"), named("viscous_friction"), named("actuator_lag", "input_delay"))
        r = result(hidden("force_gain", "input_delay"), *said, other_explanations=other)
        self.assertFalse(score.exact(r))
        self.assertTrue(score.exact_or_declared(r))
        self.assertFalse(score.exact_or_declared(result(hidden("force_gain", "input_delay"), *said)))

    def test_offset_is_not_asked_beside_a_spring_but_else_it_is(self):
        self.assertTrue(score.exact(result(hidden("spring", "constant_force"), named("spring"))))
        self.assertTrue(score.exact(result(hidden("hardening_spring"), named("hardening_spring"), named("constant_force"))))
        self.assertFalse(score.exact(result(hidden("constant_force"), named("spring"))))
        self.assertFalse(score.exact(result(hidden("cogging", "constant_force"), named("cogging"))))

    def test_no_answer_is_never_right(self):
        failed = {"truth": hidden("cogging"), "answer": None, "time_s": 1.0}
        self.assertFalse(score.exact(failed) or score.exact_or_declared(failed) or score.first_true(failed))
        self.assertTrue(score.false_alarm({"truth": {"effects": []}, "answer": None}))


class Verdicts(unittest.TestCase):
    def test_only_nothing_missing_is_no_alarm(self):
        clean = {"kind": "clean", "effects": []}
        self.assertFalse(score.false_alarm(result(clean, verdict="nothing_missing")))
        self.assertTrue(score.false_alarm(result(clean, verdict="unexplained")))
        self.assertTrue(score.false_alarm(result(clean, named("cogging"))))

    def test_variables_must_be_all_and_no_more(self):
        truth = {"kind": "outside", "effects": [{"effect": "uneven_mass", "variables": ["position", "acceleration"]}]}
        for variables, right in ((["acceleration", "position"], True), (["position"], False), ([], False)):
            self.assertEqual(score.variable_named(result(truth, remainder={"variables": variables})), right)


class Intervals(unittest.TestCase):
    def test_truth_inside_and_outside(self):
        def level(low, high):
            return named("coulomb_friction") | {"parameters": {"level": {"value": (low + high) / 2, "low": low, "high": high}}}

        inside = [c[2] for low, high in ((0.19, 0.21), (0.21, 0.23))
                  for c in score.covered(result(hidden("coulomb_friction"), level(low, high)))]
        self.assertEqual(inside, [True, False])


class Tables(unittest.TestCase):
    def test_quantiles_lie_between_order_statistics(self):
        self.assertEqual(score.quantile([3, 1, 2], 0.5), 2)
        self.assertAlmostEqual(score.quantile([0, 1], 0.9), 0.9)
        self.assertIsNone(score.quantile([None], 0.5))

    def test_every_group_and_failure_shows(self):
        results = [result(hidden("cogging"), named("cogging")), result(hidden("cogging", "spring"), named("cogging"))]
        summary = score.summary(results)
        self.assertEqual([g["exact"] for g in summary["by_number_of_effects"]], [100, 0])
        self.assertEqual(len(summary["failures"]), 1)
        self.assertIn("| cogging", score.text(summary))


if __name__ == "__main__":
    unittest.main()
