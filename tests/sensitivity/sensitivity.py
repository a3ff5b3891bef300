"""What half and one and a half of each threshold of the diagnosis change on a few records. Called by tools/sensitivity.sh."""

import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "conditions"))
import outcome  # noqa: E402
import scenario  # noqa: E402
import score  # noqa: E402
import variable_criteria  # noqa: E402

# Quick development records of the conditions benchmark that are right with the thresholds as they are; three are clean.
SEEDS = (100000, 100005, 100014, 100021, 100030, 100035, 100042)
FACTORS = (0.5, 1.5)
NONE = ("judged_row_s", 1.0)  # no threshold is changed
WITHOUT_ROLES = "Any diagram."  # the section of thresholds that records with roles do not meet


def thresholds_with_roles(text):
    """Names and values, in the order of the file."""
    before, _, rest = text.partition(f"// {WITHOUT_ROLES}\n")
    _, _, after = rest.partition("\n// ")
    return [(name, value) for _, name, _, value in variable_criteria.thresholds(before + after)]


def answers(program, name, factor, folders):
    """Class of each record's answer, and the answer itself without its numbers."""
    files = [folder / f"answer.{name}.{factor}.json" for folder in folders]
    missing = [folder for folder, file in zip(folders, files) if not file.exists()]
    for folder in missing:  # one at a time: one that fails does not end the others
        subprocess.run([str(a) for a in (program, name, factor, folder)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return [judged(folder, file) for folder, file in zip(folders, files)]


def judged(folder, file):
    truth = json.loads((folder / "truth.json").read_text())
    answer = json.loads(file.read_text()) if file.exists() else None
    result = {"truth": truth, "answer": answer, "exit": 0 if answer else 1, "over_limit": False, "text": "no answer"}
    return outcome.classify(result), outcome.said(result)


def cell(before, after):
    """"=" if every answer is the same, else what became of those that are not."""
    is_right = [b[0] in ("exact", "declared") for b in before]
    lost = [a[0] for b, a, right in zip(before, after, is_right) if right and a[0] not in ("exact", "declared")]
    mended = sum(a[0] in ("exact", "declared") for a, right in zip(after, is_right) if not right)
    other = sum(b[1] != a[1] for b, a in zip(before, after)) - len(lost) - mended
    parts = [f"{lost.count(c)} {c}" for c in outcome.CLASSES if c in lost]
    parts += [f"{mended} right"] if mended else []
    parts += [f"{other} said otherwise"] if other else []
    return ", ".join(parts) or "="


def table(thresholds, results):
    rows, unchanged = [], []
    for name, value in thresholds:
        cells = [cell(results[NONE], results[name, factor]) for factor in FACTORS]
        if set(cells) == {"="}:
            unchanged.append(f"`{name}`")
        else:
            rows.append([f"`{name}`", value, *cells])
    right = sum(c in ("exact", "declared") for c, _ in results[NONE])
    return (f"{len(results[NONE])} records, {right} right with the thresholds as they are.\n\n"
            + score.table(["threshold", "value", "half", "one and a half"], rows)
            + f"\n\nNo answer changes with {', '.join(unchanged) or 'any of them'}.\n")


def main():
    parser = argparse.ArgumentParser(prog="tools/sensitivity.sh", description="Half and one and a half of each threshold of the diagnosis.")
    parser.add_argument("--seeds", type=int, nargs="+", default=SEEDS, help="of the conditions benchmark")
    parser.add_argument("--thresholds", nargs="+", help="names in criteria.h (default all that records with roles meet)")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("build/sensitivity"), help="answers there are not computed again")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--program", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--generator", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    options = parser.parse_args()
    folders = [options.output / str(seed) for seed in options.seeds]
    for seed, folder in zip(options.seeds, folders):
        if not (folder / "truth.json").exists():
            folder.mkdir(parents=True, exist_ok=True)
            scenario.generate(options.generator, seed, folder)
    thresholds = thresholds_with_roles((HERE.parents[1] / "tools/diagnose/criteria.h").read_text())
    if options.thresholds:
        unknown = set(options.thresholds) - {name for name, _ in thresholds}
        if unknown:
            parser.error(f"no threshold {', '.join(sorted(unknown))}")
        thresholds = [(name, value) for name, value in thresholds if name in options.thresholds]
    runs = [NONE, *((name, factor) for name, _ in thresholds for factor in FACTORS)]
    results = {}
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        for run, result in zip(runs, pool.map(lambda r: answers(options.program, *r, folders), runs)):
            results[run] = result
            print(f"{len(results)}/{len(runs)} {run[0]} × {run[1]}", file=sys.stderr, flush=True)
    print(table(thresholds, results), end="")


if __name__ == "__main__":
    main()
