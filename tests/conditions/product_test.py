"""Generator, product and judge work together. What the product cannot do yet under a condition is not asserted: docs/hidden_effects.md has
the figures."""

import argparse
import pathlib
import sys
import tempfile
import unittest

import benchmark
import outcome

GENERATOR, LOOPWRIGHT = (pathlib.Path(a).resolve() for a in sys.argv[1:3])

# Short records, clean and with effects, that are right today. 100044 has counts at 51.2 kHz, which looked like a delay; 100070
# coarse counts in slow motion, which are far from white. 100179 has 6 to 16 rows between turns of a damped axis: forces change within
# a sample; in 100359 a command comes a third of a sample late as well. The command of 100318 is smooth between rows: on lines it would
# call for less mass. In 900598 a held command comes a tenth of a sample late; in 900652 a resonance hides in loud noise beside friction.
# The load of 900776 is measured, and noise moves its motor. In 900590 friction builds up over 56 counts. The resonance of 900823 is
# sampled at uneven times. Of 901681, a third of the gain and of the damping state the law of three times the mass; that of
# 901751, a gain, is also that of a mass and a damping. The record of 100162 has 400 Hz, at which dry friction is Coulomb friction or
# presliding hysteresis. In 901970 and 902209 the controller answers to coarse counts, late and not late. The command of 902244 is late by
# 61 rows of 51.2 kHz. Beside no noise, the gain of 902191 is that of a mass and a damping. Of the clean 902864 means of two rows are
# judged. The load of 903142 flies in loud noise and is found once the noise is known; the command of 903343 is late by a part of an
# uneven row. Of the clean 904669 a velocity is measured alone, and the diagram's cogging is a tenth of a millimetre beside its place; of
# the clean 904722 the noise of the search asks for a delay for which its own does not. In 904839 friction falls with speed in rows after
# turns that nothing explains. Of 904942 the balance of forces speaks against the load that would explain what counts and controller make.
# In 904969 the cogging of the diagram is again beside its place, beside what is missing. In 905233 several rows are one, within which the
# controller answers to noise: that is no delay. The encoder errors of 905299 and 905459 repeat within a third of the stroke. In 905489 what
# the cogging of the diagram does beside its place is not told as one that changes with speed either. In 905508 the axis slides slowly
# before it rests, which speaks against no friction.
RIGHT = {100162: "rate", 100318: "between_samples", 100359: "few_rows_between_turns", 100000: "mass",
         100008: "voltage", 100014: "known_nominal", 100035: "weak_beside_strong", 100044: "rounded_stamps",
         100052: "loud", 100070: "counts", 900598: "between_samples", 900652: "loud", 900776: "load_side", 900590: "counts",
         900823: "jitter", 901681: "rotary", 901751: "no_noise",
         901970: "counts", 902191: "no_noise", 902209: "velocity_only", 902244: "rounded_stamps",
         902864: "rounded_stamps", 903142: "rate", 903343: "jitter", 904669: "velocity_only", 904722: "rate",
         904839: "few_rows_between_turns", 904942: "rate", 904969: "velocity_only", 905233: "length",
         905299: "few_rows_between_turns", 905459: "few_rows_between_turns", 905489: "velocity_only", 905508: "voltage"}
# Short records of conditions at which the diagnosis may fail. In 100179 a stop is met within a sample of few: flagged, without its name.
ANY = [100004, 100005, 100011, 100019, 100042, 100047, 100049, 100179]


class Product(unittest.TestCase):
    def judged(self, seeds):
        with tempfile.TemporaryDirectory() as name:
            options = argparse.Namespace(output=pathlib.Path(name), generator=GENERATOR, loopwright=LOOPWRIGHT, limit=120, keep=False)
            results = [benchmark.judge(options, seed) for seed in seeds]
            again = [benchmark.judge(options, seed) for seed in seeds]  # from the files: an interrupted batch continues
            self.assertEqual(results, again)
            return results

    def test_answers_are_right_where_nothing_is_unusual(self):
        for seed, result in zip(RIGHT, self.judged(RIGHT)):
            with self.subTest(seed=seed):
                self.assertEqual(result["truth"]["condition"], RIGHT[seed])
                self.assertIn(outcome.classify(result), ("exact", "declared"), outcome.describe(result))

    def test_every_condition_has_an_outcome(self):
        results = self.judged(ANY)
        summary = outcome.summary(results)
        self.assertEqual(sum(row[kind][c] for row in summary["by_condition"] for kind in ("hidden", "clean") for c in outcome.CLASSES),
                         len(ANY))
        self.assertIn("clean called nothing_missing", outcome.text(summary))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
