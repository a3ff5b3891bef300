"""Generator, product and judge work together, on records that had a wrong answer."""

import argparse
import pathlib
import sys
import tempfile
import unittest

import benchmark
import outcome

LOOPWRIGHT = pathlib.Path(sys.argv[1]).resolve()

# Convection beside a moved loss is nearly radiation: with all parameters free it is worse. A dead zone beside a moved rate is nearly a
# law that falls with its variable: with the rate decided it is better. An ampere at the diode of a ladder tells nothing of its response.
RIGHT = {900715: "thermal", 900717: "valve", 700115: "rc_ladder"}


class Product(unittest.TestCase):
    def test_records_that_had_a_wrong_answer_have_the_right_one(self):
        with tempfile.TemporaryDirectory() as name:
            options = argparse.Namespace(output=pathlib.Path(name), loopwright=LOOPWRIGHT, limit=240, keep=False, disturbance=0.0)
            for seed, plant in RIGHT.items():
                with self.subTest(seed=seed):
                    result = benchmark.judge(options, seed)
                    self.assertEqual(result["truth"]["plant"], plant)
                    self.assertIn(outcome.classify(result), ("exact", "declared"), outcome.describe(result))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
