#!/usr/bin/env python3
"""Runs the commands of README and docs in order, as on a fresh clone.

    tests/docs/commands.py            every command; slow ones are shortened according to SHORTENED
    tests/docs/commands.py --quick    without the slow commands: a part of tools/test.sh
    tests/docs/commands.py --list     lists what would be done with each command, and why

Blocks marked ```sh are run, one shell for each page, in a folder like the root of a clone. If the line before a block
ends with "`NAME`:", the block is the file NAME, which is written before the page's first command. JSON that is a whole file (it
has a key "loopwright") is checked by `loopwright check`. Every block must declare its kind; other blocks are ```text.
Exit code 0: all commands succeeded; 1: one failed.
"""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
KINDS = ("sh", "json", "cpp", "python", "text", "diff")
# In reading order: the README's demo makes files that other pages use.
FIRST = ["README.md", "docs/diagram_format.md", "docs/hardware.md", "docs/paper.md"]

# Commands with these beginnings are skipped on all pages.
LEFT_OUT = [
    ("tools/test.sh", "it runs this script"),
    ("loopwright studio", "it serves until it is ended; tests/tools/studio/web runs it"),
    ("srun ", "needs a cluster with Slurm"),
    ("mpirun ", "needs Open MPI; tests/tools/sweep runs it"),
]
# Commands that take minutes, and their replacements: (as written, as run, the difference).
SHORTENED = [
    ("tools/reproduce_paper.sh", "tools/reproduce_paper.sh --runs 1", "one run for every number instead of five"),
    ("tools/hidden_effects.sh 300", "tools/hidden_effects.sh 4", "4 scenarios instead of 300"),
    ("tools/hidden_effects.sh 120", "tools/hidden_effects.sh 2", "2 scenarios instead of 120"),
    ("tools/hidden_effects.sh 20", "tools/hidden_effects.sh 2", "2 scenarios instead of 20"),
    ("tools/conditions.sh 500", "tools/conditions.sh 2", "2 scenarios instead of 500"),
    ("tools/conditions.sh 90", "tools/conditions.sh 2", "2 scenarios instead of 90"),
    ("tools/sensitivity.sh --without-roles", "tools/sensitivity.sh --without-roles --seeds 120007 --thresholds least_share_of_site",
     "one record and one threshold"),
    ("tools/sensitivity.sh", "tools/sensitivity.sh --seeds 100000 --thresholds judged_row_s", "one record and one threshold"),
    ("tools/any_diagram.sh 31", "tools/any_diagram.sh 2", "2 scenarios instead of 31"),
    ("--evaluations 300", "--evaluations 20", "20 runs of the search instead of 300"),
    ("loopwright sweep diagrams/linear_motor/robustness.sweep.json -o /tmp/robustness",
     "loopwright sweep diagrams/linear_motor/robustness.sweep.json -o /tmp/robustness --shard 0/20", "a twentieth of the runs"),
    ("loopwright sweep diagrams/linear_motor/controllers.sweep.json -o /tmp/controllers",
     "loopwright sweep diagrams/linear_motor/controllers.sweep.json -o /tmp/controllers --shard 0/20", "a twentieth of the runs"),
]
# Skipped by --quick: seconds to minutes each.
SLOW = ["tools/", "bin/hidden_effects ", "bin/conditions ", "loopwright sweep ", "loopwright gp ", "identification", "loopwright diagnose", "loopwright fit",
        "diagrams/linear_motor/ps.json", "diagrams/linear_motor/beyond.json", "loopwright deploy", "--replay", "g++", "magnetic_pull", "first/log", "first/improved"]
# Preconditions of a page that this machine may lack.
BEFORE = {
    "docs/hardware.md": "# the emulated card in the place of the real one, in virtual time: this machine may be busy\n"
                        "export HIL_LIBRARY=$PWD/build/release/lib/libhil_emulator.so\n",
    "docs/diagnose.md": "# the record of which the example of a map speaks\n"
                        "awk 'BEGIN { print \"t_s,iq_A,theta_rad\"; for (i = 0; i < 400; ++i) print i \",\" 0.1 * sin(i / 3) \",\" i / 100 }' > map.csv\n",
}
# Whole files that a page shows without a name: their folder and name.
NAMES = {
    ("docs/diagram_format.md", "A mass on a spring, pushed"): "spring_by_frequency.json",
    ("docs/diagnose.md", "Holding current"): "holding.experiment.json",
    ("docs/editors.md", "Two gains"): "gains.sweep.json",
    ("docs/effects.md", "A bump on the track"): "bump.json",
    ("docs/sweeps.md", "Payload and cogging"): "diagrams/linear_motor/example.sweep.json",
}
# Further arguments of `check`.
CHECKED_WITH = {"magnet.json": "--blocks magnetic_pull.so"}


class Block:
    def __init__(self, page, line, kind, text, before):
        self.page, self.line, self.kind, self.text = page, line, kind, text
        named = re.search(r"`([\w./]+\.\w+)`:\s*$", before)
        is_file = named and (kind in ("json", "cpp") or (kind == "text" and named.group(1).endswith(".csv")))
        self.name = named.group(1) if is_file else None
        if kind == "json" and not self.name:
            whole = self.whole_file()
            self.name = NAMES.get((page, whole.get("title"))) if whole else None

    def whole_file(self):
        """The JSON, if it is a whole file of Loopwright; else None."""
        try:
            value = json.loads(self.text)
        except ValueError:
            return None
        return value if isinstance(value, dict) and "loopwright" in value else None

    def commands(self):
        """Shell commands, with continuation lines joined and without comment lines."""
        joined = self.text.replace("\\\n", " ")
        return [line for line in joined.splitlines() if line.strip() and not line.lstrip().startswith("#")]


def blocks_of(page):
    blocks, before, kind, start, lines = [], "", None, 0, []
    for number, line in enumerate((ROOT / page).read_text().splitlines(), 1):
        if line.startswith("```"):
            if kind is None:
                kind, start, lines = line[3:].strip(), number, []
            else:
                blocks.append(Block(page, start, kind, "\n".join(lines) + "\n", before))
                kind = None
        elif kind is not None:
            lines.append(line)
        elif line.strip():
            before = line
    return blocks


def pages():
    rest = sorted(str(p.relative_to(ROOT)) for p in (ROOT / "docs").glob("*.md"))
    return FIRST + [p for p in rest if p not in FIRST]


def missing_record(experiment, folder, data):
    """The name of an experiment's measured record if it is neither beside it nor below the data folder; else None."""
    name = experiment.get("data", "")
    places = [folder, data, *(data.iterdir() if data.is_dir() else [])]
    return None if not name or any((place / name).is_file() for place in places) else name


def decide(command, quick, data):
    """(the command to run, or None; the reason why it differs from the page)"""
    text = command.strip()
    for beginning, why in LEFT_OUT:
        if text.startswith(beginning):
            return None, why
    for named in re.findall(r"diagrams/[\w/.]+\.experiment\.json", text):
        missing = missing_record(json.loads((ROOT / named).read_text()), (ROOT / named).parent, data)
        if missing:
            return None, f"there is no {missing} below {data}"
    if quick and any(part in text for part in SLOW):
        return None, "slow"
    for written, run, why in SHORTENED:
        if written in text:
            return text.replace(written, run), why
    return text, ""


def scratch_clone(folder, build):
    """A writable folder like the root of a clone that has been built."""
    for name in ("diagrams", "hw"):
        shutil.copytree(ROOT / name, folder / name)
    for name in ("docs", "engine", "models", "blocks", "tests"):
        (folder / name).symlink_to(ROOT / name)
    (folder / "build").mkdir()
    (folder / "tmp").mkdir()  # replaces /tmp
    (folder / "build/release").symlink_to(build)
    demo = ROOT / "build/demo"  # made by tools/demo.sh
    (folder / "build/demo").symlink_to(demo)
    (folder / "tools").mkdir()
    for script in (ROOT / "tools").glob("*.sh"):
        wrapper = folder / "tools" / script.name
        wrapper.write_text(f'#!/bin/sh\nexec "{script}" "$@"\n')
        wrapper.chmod(0o755)


def need_hidden_record(build):
    """Makes the record of the README's diagnosis, as tools/demo.sh does."""
    hidden = ROOT / "build/demo/hidden"
    if not (hidden / "nominal.json").exists():
        hidden.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run([build / "bin/hidden_effects", "21", hidden, "paper", "coulomb_friction", "cogging"], check=True,
                       stdout=subprocess.DEVNULL)


def script_of(page, blocks, quick, data, tell):
    lines = ["set -euo pipefail", BEFORE.get(page, "")]
    for block in blocks:
        if block.kind != "sh":
            continue
        for command in block.commands():
            run, why = decide(command, quick, data)
            tell(f"{page}:{block.line}: {command.strip() if run is None else run}" + (f"   [{'left out: ' if run is None else ''}{why}]" if why else ""))
            if run is not None:
                lines.append(f"echo '{page}:{block.line}' > .at; {run.replace('/tmp/', 'tmp/')}")
    for block in blocks:
        if block.kind == "json" and block.name and block.whole_file():
            missing = None if page in BEFORE else missing_record(block.whole_file(), data, data)
            if missing:
                tell(f"{page}:{block.line}: check {block.name}   [left out: there is no {missing} below {data}]")
                continue
            check = f"loopwright check {block.name} {CHECKED_WITH.get(block.name, '')}"
            if quick and (block.name in CHECKED_WITH or block.name.endswith("training.json")):
                tell(f"{page}:{block.line}: {check}   [left out: slow]")
            else:
                tell(f"{page}:{block.line}: {check}")
                lines.append(f"echo '{page}:{block.line}' > .at; {check}")
    return "\n".join(lines) + "\n"


def faults_of_marks(page, blocks):
    faults = []
    for block in blocks:
        if block.kind not in KINDS:
            faults.append(f"{page}:{block.line}: the block does not say what it is: one of {', '.join(KINDS)}")
        if block.kind == "text" and re.search(r"^(loopwright|tools/\w+\.sh|build/\S+) [a-z]", block.text, re.M) and "…" not in block.text and "[" not in block.text \
                and "#SBATCH" not in block.text:
            faults.append(f"{page}:{block.line}: these look like commands: mark them sh")
        if block.kind == "json" and block.whole_file() and not block.name:
            faults.append(f"{page}:{block.line}: a whole file without a name: NAMES in tests/docs/commands.py gives it one")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--build", type=Path, default=ROOT / "build/release")
    parser.add_argument("--page", action="append", help="only these pages")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    data = Path(os.environ.get("LOOPWRIGHT_DATA", ROOT.parent / "shared/data")).resolve()
    environment = {**os.environ, "PATH": f"{build / 'bin'}:{os.environ['PATH']}", "LOOPWRIGHT_DATA": str(data)}
    faults = []
    with tempfile.TemporaryDirectory(prefix="loopwright_docs_") as name:
        clone = Path(name)
        if not arguments.list:
            scratch_clone(clone, build)
            need_hidden_record(build)
        for page in arguments.page or pages():
            blocks = blocks_of(page)
            faults += faults_of_marks(page, blocks)
            for block in blocks:
                if block.name and not arguments.list:
                    (clone / block.name).parent.mkdir(parents=True, exist_ok=True)
                    (clone / block.name).write_text(block.text)
            script = script_of(page, blocks, arguments.quick, data, print)
            if arguments.list:
                continue
            begin = time.monotonic()
            sys.stdout.flush()
            done = subprocess.run(["bash", "-c", script], cwd=clone, env=environment, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8", errors="replace")
            print(f"-- {page}: {time.monotonic() - begin:.1f} s")
            if done.returncode:
                at = (clone / ".at").read_text().strip() if (clone / ".at").exists() else page
                faults.append(f"{at}: exit code {done.returncode}\n" + done.stdout[-3000:])
    for fault in faults:
        print(fault)
    print("every command of the docs works" if not faults else f"{len(faults)} of the docs' blocks are wrong")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
