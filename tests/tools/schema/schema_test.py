#!/usr/bin/env python3
"""Holds the JSON Schemas to the files and to their readers, by an independent validator (python3-jsonschema).

    /usr/bin/python3 tests/tools/schema/schema_test.py build/release/bin/loopwright

Every shipped file fits the schema of its kind. Files that use every key are changed in every small way: what the schema refuses,
`loopwright check` refuses; and where `check` does not know a key, misses one, or sees a value of a wrong kind, so does the schema.
"""
import fnmatch
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import jsonschema

from mutants import at, mutants, places, replaced
from samples import BESIDE, SAMPLES

ROOT = Path(__file__).resolve().parents[3]
program = str(Path(sys.argv[1]).resolve())
Validator = jsonschema.Draft202012Validator
# As in engine/json/file_kind.cpp.
TELLING = [("loopwright_gp_model", "model"), ("effect", "effect"), ("driver", "device"), ("blocks", "diagram"), ("axes", "sweep"),
           ("metrics", "sweep"), ("recordings", "training"), ("label", "training"), ("data", "experiment"), ("compare", "experiment"),
           ("drive", "experiment")]
# What `check` says of keys that it does not know, of missing ones, and of values of a wrong kind.
STRUCTURAL = re.compile(r'has no key "|there is no parameter "unknown_key|there is no parameter ".*_x"|of the wrong kind|wrong kind of value')


def kind_of(value):
    return next((kind for key, kind in TELLING if isinstance(value, dict) and key in value), None)


def run(*arguments, **options):
    return subprocess.run([program, *arguments], capture_output=True, encoding="utf-8", **options)


def schema_of(kind):
    return json.loads(run("schema", kind).stdout)


SCHEMAS = {kind: schema_of(kind) for kind in ("diagram", "experiment", "sweep", "training", "effect", "device", "model")}


def shipped():
    for folder in ("diagrams", "hw"):
        for path in sorted((ROOT / folder).rglob("*.json")):
            value = json.loads(path.read_text())
            if kind_of(value):
                yield path.relative_to(ROOT), value


class Folder:
    """Files of one kind beside those that they refer to, which one call of the program checks."""

    def __init__(self, kind):
        self.kind, self.count = kind, 0
        self.temporary = tempfile.TemporaryDirectory()
        self.path = Path(self.temporary.name)
        self.files = []

    def add(self, value, beside=None):
        """Each in a folder of its own, because an effect must have the name of its file."""
        folder = self.path / str(len(self.files))
        folder.mkdir()
        for name, text in BESIDE.items():
            (folder / name).symlink_to(self.beside(name, text))
        for path in beside or ():
            if not (folder / path.name).exists():
                (folder / path.name).symlink_to(path)
        (folder / "sample.json").write_text(json.dumps(value))
        self.files.append(folder.name + "/sample.json")

    def beside(self, name, text):
        path = self.path / name
        if not path.exists():
            path.write_text(text)
        return path

    def verdicts(self):
        """For each file: whether it is fine, and what was said."""
        said = {file: [] for file in self.files}
        fine = set()
        for begin in range(0, len(self.files), 1000):
            done = run("check", *self.files[begin:begin + 1000], cwd=self.path)
            fine |= {line.split(": fine")[0] for line in done.stdout.splitlines() if ": fine" in line}
            file = None
            for line in done.stderr.splitlines():
                found = re.match(r"(\d+/sample\.json)", line)
                file = found.group(1) if found else file
                if file:
                    said[file].append(line)
        return [(file in fine, "\n".join(said[file])) for file in self.files]


class Kinds(unittest.TestCase):
    def test_every_schema_is_one(self):
        for schema in SCHEMAS.values():
            Validator.check_schema(schema)

    def test_every_shipped_file_fits_the_schema_of_its_kind(self):
        count = {}
        for path, value in shipped():
            kind = kind_of(value)
            count[kind] = count.get(kind, 0) + 1
            error = jsonschema.exceptions.best_match(Validator(SCHEMAS[kind]).iter_errors(value))
            self.assertIsNone(error, f"{path}: {error and error.message[:300]}")
        for kind, least in {"diagram": 150, "experiment": 8, "sweep": 3, "training": 4, "effect": 23, "device": 4, "model": 3}.items():
            self.assertGreaterEqual(count[kind], least, kind)

    def test_a_misspelt_kind_is_recognized(self):
        done = run("schema", "experimnt")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn('did you mean "experiment"?', done.stderr)

    def test_the_settings_of_a_new_project_give_each_file_its_schema(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(run("new", "axis", cwd=folder).returncode, 0)
            project = Path(folder) / "axis"
            settings = json.loads((project / ".vscode/settings.json").read_text())["json.schemas"]
            for path in project.glob("*.json"):
                urls = [entry["url"] for entry in settings if self.matches(path.name, entry["fileMatch"])]
                self.assertEqual(len(urls), 1, f"{path.name}: {urls}")
                value = json.loads(path.read_text())
                self.assertEqual(Path(urls[0]).name, kind_of(value) + ".schema.json")
                Validator(json.loads((project / urls[0]).read_text())).validate(value)

    def test_the_page_shows_the_settings_of_a_new_project(self):
        shown = [json.loads(text) for text in re.findall(r"```json\n(.*?)```", (ROOT / "docs/editors.md").read_text(), re.S)]
        with tempfile.TemporaryDirectory() as folder:
            run("new", "axis", cwd=folder)
            self.assertIn(json.loads((Path(folder) / "axis/.vscode/settings.json").read_text()), shown)

    @staticmethod
    def matches(name, patterns):
        """As an editor reads it: the last pattern that fits decides."""
        fits = False
        for pattern in patterns:
            if fnmatch.fnmatch(name, pattern.lstrip("!").removeprefix("**/")):
                fits = not pattern.startswith("!")
        return fits


class TheKeyOfTheSchema(unittest.TestCase):
    def test_changes_neither_a_result_nor_its_identity(self):
        with tempfile.TemporaryDirectory() as folder:
            path, results = Path(folder), []
            value = json.loads((ROOT / "diagrams/examples/gain.json").read_text())
            for diagram in (value, {"$schema": "diagram.schema.json", **value}):
                (path / "d.json").write_text(json.dumps(diagram))
                done = run("run", "d.json", "-q", "-o", "r.csv", cwd=folder)
                self.assertEqual(done.returncode, 0, done.stderr)
                results.append((path / "r.csv").read_text())
            self.assertIn("plan", results[0])
            self.assertEqual(*results)

    def test_is_not_covered_by_the_checksum_of_a_model(self):
        value = json.loads((ROOT / "diagrams/examples/gpr.model.json").read_text())
        folder = Folder("model")
        for changed in (value, {"$schema": "model.schema.json", **value}, {"$schema": 1, **value}, {**value, "title": "Another"},
                        {**value, "unknown_key": 1}):
            folder.add(changed)
        self.assertEqual([is_fine for is_fine, _ in folder.verdicts()], [True, True, False, False, False])


class Agreement(unittest.TestCase):
    def compare(self, kind, cases, is_valid, beside=None):
        """cases: (what was changed, the changed file)."""
        folder = Folder(kind)
        for _, value in cases:
            folder.add(value, beside)
        disagreements = []
        for (change, value), (is_fine, said) in zip(cases, folder.verdicts()):
            fits = is_valid(value)
            # The reader looks only at the variant that is active.
            if is_fine and not fits and "variants/b" not in change:
                disagreements.append(f"{change}: refused by the schema only")
            if fits and self.is_structural(change, said):
                disagreements.append(f"{change}: refused by the reader only:\n    " + said.replace("\n", "\n    "))
        self.assertEqual(disagreements, [], f"{len(disagreements)} of {len(cases)}\n" + "\n".join(disagreements[:40]))

    @staticmethod
    def is_structural(change, said):
        """Whether a problem of the place that was changed is about keys or kinds of values."""
        if change.startswith(("blocks/part/parameters", "parameters/k")):  # whose kind is that in the subdiagram
            return False
        place = re.split(r" = | \+ | - |: ", change.split(".json ")[-1])[0]
        for problem in re.split(r"(?m)^\d+/sample", said):
            at_place = re.search(r"at: /(.*)", problem)
            if STRUCTURAL.search(problem) and "set by this axis" not in problem and (at_place.group(1) if at_place else "").startswith(place):
                return True
        return False

    def test_the_program_accepts_the_samples(self):
        for kind, samples in SAMPLES.items():
            folder = Folder(kind)
            for sample in samples:
                Validator(SCHEMAS[kind]).validate(sample)
                folder.add(sample)
            for is_fine, said in folder.verdicts():
                self.assertTrue(is_fine, f"{kind}: {said}")

    def test_the_samples_use_every_key(self):
        for kind, samples in SAMPLES.items():
            seen, schema = set(), SCHEMAS[kind]

            def properties(validator, keys, instance, node):
                if isinstance(instance, dict):
                    seen.update((id(keys), key) for key in keys if key in instance)
                yield from Validator.VALIDATORS["properties"](validator, keys, instance, node)

            recording = jsonschema.validators.extend(Validator, {"properties": properties})
            for sample in samples:
                list(recording(schema).iter_errors(sample))
            # The types of blocks are held against their examples.
            roots = {name: part for name, part in schema.get("$defs", {}).items() if not name[0].isupper()}
            if kind != "diagram":  # in whose samples the definitions of diagrams are used
                roots = {name: part for name, part in roots.items() if name not in SCHEMAS["diagram"]["$defs"]}
            roots["file"] = {key: value for key, value in schema.items() if key != "$defs"}
            used = {}  # by place: a key that several alternatives have is used if it is in one
            for root, part in roots.items():
                for path, node in places(part):
                    if isinstance(node, dict) and path and path[-1] == "properties" and "if" not in path:
                        of = "file" if root == "diagram" else root  # an inner diagram has the keys of a file
                        place = (of, *(step for step in path if not isinstance(step, int)))
                        for key in node:
                            used[place, key] = used.get((place, key), False) or (id(node), key) in seen
            self.assertEqual([where for where, is_used in used.items() if not is_used], [], kind)

    def test_schema_and_reader_refuse_the_same_changes(self):
        for kind, samples in SAMPLES.items():
            validator = Validator(SCHEMAS[kind])
            for number, sample in enumerate(samples):
                with self.subTest(kind, sample=number):
                    self.compare(kind, list(mutants(sample)), validator.is_valid)

    def test_schema_and_reader_refuse_the_same_changes_of_every_block(self):
        """By the definition of the type alone: the whole schema would take minutes."""
        definitions = SCHEMAS["diagram"]["$defs"]
        by_type = {name: Validator({"$ref": f"#/$defs/{name}", "$defs": definitions}) for name in definitions if name[0].isupper()}
        covered, cases, valid = set(), [], []
        for path in sorted((ROOT / "diagrams/examples").glob("*.json")):
            value = json.loads(path.read_text())
            for name, block in value.get("blocks", {}).items():
                kind = block.get("type")
                if kind not in by_type or kind in covered or kind == "HardwareIo":  # whose file is a device
                    continue
                covered.add(kind)
                for change, changed in mutants(value, [None, True, "text", [None], {"unknown_key": 1}], ("blocks", name)):
                    now = at(changed, ("blocks", name))
                    if now.get("type") == kind:
                        cases.append((f"{path.name} {change}", changed))
                        valid.append(by_type[kind].is_valid(now))
        answers = iter(valid)
        self.assertGreater(len(covered), 100)
        beside = [path for path in (ROOT / "diagrams/examples").iterdir() if path.suffix in (".csv",) or ".model." in path.name]
        self.compare("diagram", cases, lambda _: next(answers), beside)


class Choices(unittest.TestCase):
    def test_the_reader_knows_every_choice_of_the_schema(self):
        for kind, samples in SAMPLES.items():
            for sample in samples:
                folder, changes = Folder(kind), []
                for path, choices in self.choices(kind, sample):
                    for choice in choices:
                        changes.append(f"{'/'.join(map(str, path))} = {choice!r}")
                        folder.add(replaced(sample, path, choice))
                for change, (_, said) in zip(changes, folder.verdicts()):
                    self.assertNotRegex(said, r'there is no|cannot be attached|is neither|is of the wrong kind', f"{kind} {change}")

    @staticmethod
    def choices(kind, sample):
        found = []

        def enum(validator, choices, instance, node):
            if len(choices) < 50:  # the types of blocks need other keys
                found.append((instance, choices))
            yield from Validator.VALIDATORS["enum"](validator, choices, instance, node)

        recording = jsonschema.validators.extend(Validator, {"enum": enum})
        schema = SCHEMAS[kind]
        for part in schema.get("anyOf", [schema]):  # an effect of an axis has other choices than one at a site
            form = {**part, "$defs": schema.get("$defs", {})}
            if Validator(form).is_valid(sample):
                list(recording(form).iter_errors(sample))
        for path, part in places(sample):
            for choices in {tuple(choices) for instance, choices in found if instance is part and isinstance(part, str)}:
                if part in choices and path[-1] not in ("driver", "to") and "in" not in path:  # which need other keys
                    yield path, choices


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
