"""The judgement of hand-written answers."""

import unittest

import outcome


def truth(*effects, hardly=()):
    return {"seed": 1, "condition": "mass", "variant": "", "trajectory": "paper", "rows": 1000, "sample_time_s": 0.001,
            "effects": [{"effect": e, "gain": 300, "counts": True, "parameters": {}} for e in effects]
            + [{"effect": e, "gain": 20, "counts": False, "parameters": {}} for e in hardly]}


def named(name, *alternatives):
    return {"effect": name, "parameters": {}, "alternatives": list(alternatives)}


def result(what, *effects, verdict="explained", **more):
    return {"truth": what, "answer": {"verdict": verdict, "effects": list(effects), **more}, "exit": 0, "time_s": 1.0,
            "over_limit": False, "text": ""}


def ended(code, text, over_limit=False):
    return {"truth": truth(), "answer": None, "exit": code, "time_s": 1.0, "over_limit": over_limit, "text": text}


class Classes(unittest.TestCase):
    def expect(self, expected, r):
        self.assertEqual(outcome.classify(r), expected)

    def test_of_clean_records(self):
        self.expect("exact", result(truth(), verdict="nothing_missing"))
        self.expect("flagged", result(truth(), verdict="unexplained"))
        self.expect("silent", result(truth(), named("cogging")))
        self.expect("flagged", result(truth(), named("cogging"), verdict="partly_explained"))

    def test_of_records_with_effects(self):
        self.expect("exact", result(truth("cogging", "inertia"), named("inertia"), named("cogging")))
        self.expect("declared", result(truth("cogging"), named("spring", "cogging")))
        self.expect("silent", result(truth("cogging", "inertia"), named("inertia")))
        self.expect("silent", result(truth("cogging"), verdict="nothing_missing"))
        self.expect("flagged", result(truth("cogging"), named("spring"), verdict="partly_explained"))
        self.expect("exact", result(truth("spring"), named("spring"), named("constant_force")))
        self.expect("declared", result(truth("inertia"), named("cogging"),
                                       other_explanations=[{"in_place_of": ["cogging"], "effects": ["inertia"]}]))

    def test_an_effect_that_the_record_hardly_shows_need_not_be_named(self):
        what = truth("cogging", hardly=["stribeck_friction"])
        for names in (["cogging"], ["cogging", "stribeck_friction"], ["cogging", "coulomb_friction"]):
            self.expect("exact", result(what, *map(named, names)))
        self.expect("silent", result(what, named("stribeck_friction")))
        self.expect("silent", result(what, named("cogging"), named("spring")))
        self.expect("exact", result(truth(hardly=["spring"]), verdict="nothing_missing"))

    def test_what_is_too_small_is_declared_and_must_be_there(self):
        small = {"too_small": [{"effect": "input_delay"}, {"effect": "actuator_lag"}]}
        self.expect("declared", result(truth("input_delay"), verdict="nothing_missing", **small))
        self.expect("declared", result(truth("cogging", "actuator_lag"), named("cogging"), **small))
        self.expect("silent", result(truth("input_delay", "actuator_lag"), verdict="nothing_missing", **small))
        self.expect("exact", result(truth("cogging", hardly=["input_delay"]), named("cogging"), **small))
        self.expect("silent", result(truth("cogging"), named("cogging"), **small))
        self.expect("silent", result(truth(), verdict="nothing_missing", **small))

    def test_without_an_answer(self):
        self.expect("refused", ended(2, "error: no roles"))
        self.expect("crash", ended(2, ""))
        self.expect("crash", ended(-6, "assertion failed"))
        self.expect("over_limit", ended(-24, "", over_limit=True))


class Tables(unittest.TestCase):
    def test_bars_count_what_has_no_answer_as_not_right(self):
        results = [result(truth("cogging"), named("cogging")), result(truth(), verdict="nothing_missing"), ended(2, "error: no"),
                   ended(-6, "")]
        bars = {b["bar"]: b for b in outcome.bars(results)}
        self.assertEqual(bars["exact or declared, of the records with effects"]["value"], 100)
        self.assertAlmostEqual(bars["clean called nothing_missing"]["value"], 100 / 3)
        self.assertFalse(bars["clean called nothing_missing"]["met"])
        self.assertEqual(bars["crashes"]["value"], 1)
        self.assertEqual(bars["silently wrong or missed, of all"]["value"], 0)

    def test_text_lists_what_is_not_right(self):
        text = outcome.text(outcome.summary([result(truth("cogging"), named("inertia")), result(truth(), verdict="nothing_missing")]))
        self.assertIn("hidden cogging (300) → explained: inertia [silent", text)
        self.assertIn("**missed**", text)


if __name__ == "__main__":
    unittest.main()
