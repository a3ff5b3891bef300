"""The figures of docs/first_hour.md: its files and commands, with the emulated card at HIL_LIBRARY."""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy

from program import PROGRAM, TUTORIAL, Result

ROOT = TUTORIAL.parents[1]
sys.path.insert(0, str(ROOT / "tests/docs"))
import commands  # noqa: E402


class FirstHour(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        (cls.folder / "first").mkdir()
        for block in commands.blocks_of("docs/first_hour.md"):
            if block.name:
                (cls.folder / block.name).write_text(block.text)
        cls.environment = {**os.environ, "HIL_EMU": str(cls.folder / "first/card.json")}

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def call(self, *arguments):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, env=self.environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def error(self, name):
        """Root mean square in µm."""
        error = Result((self.folder / name).read_text())["error.sum"]
        return 1e6 * numpy.sqrt(numpy.mean(error**2)), 1e6 * abs(error).max()

    def test_the_simulated_loop(self):
        self.call("run", "first/loop.json", "-o", "first/run.csv")
        rms, greatest = self.error("first/run.csv")
        self.assertLess(greatest, 1.5)
        self.assertLess(rms, 168 / 100)

    def test_the_sweep_shows_the_unstable_run(self):
        self.call("sweep", "first/bandwidth.sweep.json", "-o", "first/bandwidth")
        sweep = Result((self.folder / "first/bandwidth/results.csv").read_text())
        wild = sweep["tracking"] > 1e6
        self.assertTrue(wild.any())
        self.assertEqual(set(sweep["bandwidth"][wild]), {100})
        self.assertLess(sweep["stage.mass"][wild].max(), 0.26)
        # A heavier motor: the error of the feedforward over the stiffness falls with the square of the bandwidth.
        heavy = abs(sweep["stage.mass"] - 0.4) < 1e-9
        ratio = sweep["tracking"][heavy & (sweep["bandwidth"] == 10)] / sweep["tracking"][heavy & (sweep["bandwidth"] == 20)]
        self.assertAlmostEqual(ratio[0], 4, delta=0.2)

    def test_the_friction_of_the_card_is_found_and_compensated(self):
        hidden = json.loads((self.folder / "first/card.json").read_text())["plant.coulomb"]
        card = ["first/loop.json", "--variant", "stage=card"]
        self.call("deploy", *card, "-o", "first/log.csv")
        self.call("run", *card, "--replay", "first/log.csv")
        experiment = ["first/log.experiment.json"]
        self.call("diagnose", "first/loop.json", *experiment, "-o", "first/improved.json", "--json", "first/diagnosis.json")
        diagnosis = json.loads((self.folder / "first/diagnosis.json").read_text())
        found = {effect["effect"]: effect for effect in diagnosis["effects"]}
        self.assertAlmostEqual(found["coulomb_friction"]["parameters"]["level"]["value"], hidden, delta=0.001)
        self.assertEqual([name for name, effect in found.items() if not effect["optional"]], ["coulomb_friction"])
        for diagram, most in (("loop", 1.01 * hidden), ("improved", 0.0015)):
            self.call("compare", f"first/{diagram}.json", *experiment, "--json", "first/compared.json")
            compared = json.loads((self.folder / "first/compared.json").read_text())
            self.assertLess(compared["force_residual"]["rmse"], most)
        # Before: friction over stiffness. After: a few micrometres.
        stiffness = 0.2621 * (2 * numpy.pi * 15) ** 2
        self.assertAlmostEqual(self.error("first/log.csv")[0], 1e6 * hidden / stiffness, delta=10)
        self.call("deploy", *card, "--set", f"friction={hidden}", "-o", "first/log_friction.csv")
        before, after = re.search(r"falls from (\d+) to ([\d.]+) µm rms", (ROOT / "docs/first_hour.md").read_text()).groups()
        self.assertAlmostEqual(self.error("first/log.csv")[0], float(before), delta=1)
        self.assertAlmostEqual(self.error("first/log_friction.csv")[0], float(after), delta=0.1)


if __name__ == "__main__":
    unittest.main()
