"""Runs, sweeps and deployments write the same bytes whatever instructions the C library selects. So does the hidden-effect
generator. All other commands give the same words, and the same numbers to six digits."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

LOOPWRIGHT, GENERATOR, EMULATOR, SOURCE = sys.argv[1], sys.argv[2], sys.argv[3], pathlib.Path(sys.argv[4])
# Settings by which glibc avoids certain instructions. Other C libraries ignore the variable.
CHOICES = ["", "glibc.cpu.hwcaps=-FMA,-AVX2", "glibc.cpu.hwcaps=-AVX2"]


SIX_DIGITS = 1e-6

# Of the computer, not of the answer.
CLOCK_COLUMNS = ("loop.lateness", "loop.step_time")


def files_with(choice, command, folder):
    environment = dict(os.environ, HIL_LIBRARY=EMULATOR, **({"GLIBC_TUNABLES": choice} if choice else {}))
    folder.mkdir()
    subprocess.run([str(part) for part in command(folder)], env=environment, check=True, capture_output=True, timeout=300)
    return {file.relative_to(folder): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def numbers_of(column_names, text):
    """The rows of a CSV file without the columns that measure the computer."""
    rows = [line.split(",") for line in text.splitlines() if not line.startswith("#")]
    kept = [i for i, name in enumerate(rows[0]) if not any(word in name for word in column_names)]
    return [[row[i] for i in kept] for row in rows]


def differences(a, b, at=""):
    """Where two answers differ in words, or in numbers by more than six digits."""
    if isinstance(a, dict) and isinstance(b, dict):
        if a.keys() != b.keys():
            return [f"{at}: {sorted(a)} and {sorted(b)}"]
        return [found for key in a for found in differences(a[key], b[key], f"{at}/{key}")]
    if isinstance(a, list) and isinstance(b, list):
        if len(a) != len(b):
            return [f"{at}: {len(a)} and {len(b)} items"]
        return [found for i, pair in enumerate(zip(a, b)) for found in differences(*pair, f"{at}/{i}")]
    if isinstance(a, float) and isinstance(b, (int, float)):
        return [] if abs(a - b) <= SIX_DIGITS * max(abs(a), abs(b)) else [f"{at}: {a} and {b}"]
    return [] if a == b else [f"{at}: {a} and {b}"]


class SameBits(unittest.TestCase):
    def expect_same(self, command, of=None):
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

    def test_of_a_sweep(self):
        with tempfile.TemporaryDirectory() as name:
            sweep = pathlib.Path(name) / "payload.sweep.json"
            sweep.write_text(json.dumps({
                "loopwright": 1, "diagram": str(SOURCE / "diagrams" / "linear_motor" / "conventional.json"),
                "axes": {"payload": {"linear": {"from": 0, "to": 0.5, "count": 20}}},
                "metrics": {"end": {"final": "stage.position"}}}))
            self.expect_same(lambda folder: [LOOPWRIGHT, "sweep", sweep, "-o", folder / "results"], of=("results.csv",))

    def test_of_a_deployment(self):
        """In simulated time. Timing columns are of the computer."""
        motor = SOURCE / "diagrams" / "linear_motor"
        device = json.loads((SOURCE / "hw" / "devices" / "qpid_e.json").read_text())
        device.setdefault("clock", {})["time"] = "simulated"
        with tempfile.TemporaryDirectory() as name:
            file = pathlib.Path(name) / "device.json"
            file.write_text(json.dumps(device))
            logs = []
            for i, choice in enumerate(CHOICES):
                files = files_with(choice, lambda folder: [
                    LOOPWRIGHT, "deploy", motor / "conventional.json", "--variant", "stage=quanser", "--set", f"stage.device={file}",
                    "--priority", "0", "-o", folder / "log.csv"], pathlib.Path(name) / str(i))
                logs.append(numbers_of(CLOCK_COLUMNS, files[pathlib.Path("log.csv")].decode()))
            self.assertGreater(len(logs[0]), 1000)
            for other in logs[1:]:
                self.assertTrue(logs[0] == other)

    def expect_same_answer(self, command):
        with tempfile.TemporaryDirectory() as name:
            answers = []
            for i, choice in enumerate(CHOICES):
                files = files_with(choice, command, pathlib.Path(name) / str(i))
                answers.append(json.loads(files[pathlib.Path("answer.json")]))
            for other in answers[1:]:
                self.assertEqual(differences(answers[0], other), [])

    def test_answers_about_a_record(self):
        """Among them the record whose verdict once turned on the last bit."""
        with tempfile.TemporaryDirectory() as name:
            for seed in (25, 62):
                folder = pathlib.Path(name) / str(seed)
                subprocess.run([GENERATOR, str(seed), str(folder)], check=True, capture_output=True)
                nominal, record = folder / "nominal.json", folder / "train.experiment.json"
                for command in ("compare", "diagnose"):
                    with self.subTest(seed=seed, command=command):
                        self.expect_same_answer(lambda to: [LOOPWRIGHT, command, nominal, record, "--json", to / "answer.json"])

    def test_answers_about_a_diagram(self):
        loop = SOURCE / "diagrams" / "linear_motor" / "conventional.json"
        self.expect_same_answer(lambda to: [LOOPWRIGHT, "linearize", loop, "--json", to / "answer.json"])

    def test_of_records_of_the_judge(self):
        for seed in (1, 25, 62):
            with self.subTest(seed=seed):
                self.expect_same(lambda folder: [GENERATOR, seed, folder / "scenario"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
