"""Two simulators without shared code agree: the nominal loop has the same error in Loopwright and in the generator."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

GENERATOR, LOOPWRIGHT = sys.argv[1:3]


class Loop(unittest.TestCase):
    def test_clean_record_is_missed_by_its_noise_alone(self):
        for seed in (1, 2, 3, 7):  # both controllers, with and without cogging
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                subprocess.run([GENERATOR, str(seed), folder, "forward"], check=True)
                subprocess.run([LOOPWRIGHT, "compare", folder / "nominal.json", folder / "closed_loop.experiment.json",
                                "--json", folder / "compared.json"], check=True, capture_output=True)
                error = json.loads((folder / "compared.json").read_text())["signals"]["controller.measured"]["rmse"]
                truth = json.loads((folder / "truth.json").read_text())["closed_loop_rmse_m"]["true_model"]
                self.assertAlmostEqual(error / truth, 1, delta=2e-3)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
