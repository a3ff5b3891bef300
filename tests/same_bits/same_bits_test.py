"""Runs write the same bytes whatever instructions the C library selects. So does the hidden-effect generator."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

LOOPWRIGHT, GENERATOR, SOURCE = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
# Settings by which glibc avoids certain instructions. Other C libraries ignore the variable.
CHOICES = ["", "glibc.cpu.hwcaps=-FMA,-AVX2", "glibc.cpu.hwcaps=-AVX2"]


def files_with(choice, command, folder):
    environment = dict(os.environ, **({"GLIBC_TUNABLES": choice} if choice else {}))
    folder.mkdir()
    subprocess.run([str(part) for part in command(folder)], env=environment, check=True, capture_output=True, timeout=300)
    return {file.relative_to(folder): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


class SameBits(unittest.TestCase):
    def expect_same(self, command):
        with tempfile.TemporaryDirectory() as name:
            results = [files_with(choice, command, pathlib.Path(name) / str(i)) for i, choice in enumerate(CHOICES)]
        self.assertTrue(results[0])
        for other in results[1:]:
            self.assertEqual(results[0].keys(), other.keys())
            for file, content in results[0].items():
                self.assertTrue(content == other[file], file)

    def test_of_every_example(self):
        for diagram in sorted((SOURCE / "diagrams" / "examples").glob("*.json")):
            if diagram.name.endswith(".model.json"):
                continue
            with self.subTest(diagram=diagram.name):
                self.expect_same(lambda folder: [LOOPWRIGHT, "run", diagram, "-o", folder / "out.csv"])

    def test_of_a_whole_loop(self):
        for name in ("conventional", "common_job"):
            with self.subTest(diagram=name):
                diagram = SOURCE / "diagrams" / "linear_motor" / f"{name}.json"
                self.expect_same(lambda folder: [LOOPWRIGHT, "run", diagram, "-o", folder / "out.csv"])

    def test_of_records_of_the_judge(self):
        for seed in (1, 25, 62):
            with self.subTest(seed=seed):
                self.expect_same(lambda folder: [GENERATOR, seed, folder / "scenario"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
