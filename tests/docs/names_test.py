#!/usr/bin/env python3
"""Holds docs/coming_from_simulink.md to the program: its blocks exist, their parameters too, and `blocks --find` gives the same advice.

    tests/docs/names_test.py build/release/bin/loopwright
"""
import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "docs/coming_from_simulink.md"
program = sys.argv[1]


def answer(*arguments):
    return subprocess.run([program, *arguments], capture_output=True, encoding="utf-8").stdout


def rows(heading):
    """The cells of the table below a heading, without its head."""
    text = PAGE.read_text().split(f"\n## {heading}\n")[1].split("\n## ")[0]
    table = [line for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table[2:]]


class Names(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.schema = answer("schema")
        cls.types = set(re.findall(r"^  ([A-Z]\w+) ", answer("blocks"), re.M))

    def test_the_program_gives_the_advice_of_the_page(self):
        table = rows("Blocks")
        self.assertGreater(len(table), 60)
        for name, here, _ in table:
            with self.subTest(name):
                block = re.match(r"\[(\w+)\]", here).group(1)
                self.assertRegex(answer("blocks", "--find", name), rf'(?m)^ +{block} |"{block}"')

    def test_every_block_exists_and_is_linked_to_its_own_description(self):
        for block, anchor in re.findall(r"\[([A-Z]\w+)\]\(blocks\.md#(\w+)\)", PAGE.read_text()):
            self.assertIn(block, self.types)
            self.assertEqual(anchor, block.lower())

    def test_every_key_and_value_of_a_row_is_one_of_its_blocks(self):
        for name, here, differs in rows("Blocks"):
            description = "".join(answer("blocks", block) for block in re.findall(r"\[([A-Z]\w+)\]", here + differs))
            for code in re.findall(r"`([^`]*)`", here + differs):
                for word in re.findall(r'"([a-z_]\w*)"', code.split("{")[0]):
                    with self.subTest(f"{name}: {word}"):
                        self.assertTrue(re.search(rf"\b{word}\b", description) or f'"{word}"' in self.schema)

    def test_every_solver_exists(self):
        for _, here, _ in rows("Solvers"):
            for method in re.findall(r"`([\w-]+)`", here):
                self.assertIn(f'"{method}"', self.schema)

    def test_the_defaults_that_the_page_names(self):
        defaults = {"Step": r"time \(number in s, default 0\)", "Switch": r"threshold .*default 0\.5", "Saturation": r"low .*default -inf",
                    "PidController": r'method .*default "tustin"', "ContinuousPidController": r'anti_windup .*default "clamping"',
                    "DiscreteIntegrator": r'method .*default "trapezoidal"', "Lookup1D": r'outside .*default "hold"', "Sine": r"frequency \(number in Hz",
                    "RecordedColumn": r'interpolation .*default "hold"', "RateLimiter": r"falling .*at least 0"}
        for block, line in defaults.items():
            self.assertRegex(answer("blocks", block), line)

    def test_the_discrete_transfer_function_of_the_page(self):
        """1/(z - 0.5): nothing at the first sample, 1 at the second, 1.5 at the third."""
        self.assertIn('"numerator": [0, 1]', PAGE.read_text())
        diagram = {"loopwright": 1, "solver": {"stop": 2}, "log": ["filter.y"], "blocks": {
            "one": {"type": "Constant", "value": 1},
            "filter": {"type": "DiscreteTransferFunction", "sample_time": 1, "numerator": [0, 1], "denominator": [1, -0.5], "in": {"u": "one.y"}}}}
        path = Path(self.id() + ".json")
        path.write_text(json.dumps(diagram))
        try:
            out = answer("run", str(path), "-o", "-", "-q")
        finally:
            path.unlink()
        self.assertEqual([line.split(",")[1] for line in out.splitlines()[-3:]], ["0", "1", "1.5"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
