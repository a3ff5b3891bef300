"""What holds for all diagrams of the tutorial."""

import json
import unittest

from program import TUTORIAL, call

EXAMPLES = ["motor_cascade", "thermal", "pendulum", "two_mass", "multirate", "gantry", "three_axes", "homing", "log_replay",
            "relay_tuning"]


class EveryDiagram(unittest.TestCase):
    def test_is_complete_and_every_wire_has_a_unit(self):
        files = {path.stem: json.loads(path.read_text()) for path in TUTORIAL.glob("*.json")}
        diagrams = {name: text for name, text in files.items() if "blocks" in text}
        self.assertLessEqual(set(EXAMPLES), set(diagrams))
        for name, text in diagrams.items():
            with self.subTest(name):
                call("check", "--strict-units", f"{name}.json")
                self.assertTrue(text["title"] and text["description"])
        self.assertEqual({name for name, text in diagrams.items() if "inputs" not in text}, set(EXAMPLES))
        for name in EXAMPLES:
            with self.subTest(name):
                self.assertTrue(3 <= len(diagrams[name]["log"]) <= 10)
                self.assertIn("stop", diagrams[name]["solver"])
                # What follows which reference is stated, not guessed.
                self.assertIn("follows", call("run", f"{name}.json"))
                self.assertNotIn("guess", call("run", f"{name}.json"))

    def test_is_in_the_tutorial(self):
        page = (TUTORIAL / "../../docs/tutorial.md").read_text()
        for name in EXAMPLES:
            self.assertIn(f"loopwright run diagrams/tutorial/{name}.json", page)


if __name__ == "__main__":
    unittest.main()
