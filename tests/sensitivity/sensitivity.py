"""What half and one and a half of each threshold of the diagnosis change on a few records. Called by tools/sensitivity.sh."""

import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "hidden_effects")]
import score  # noqa: E402
import variable_criteria  # noqa: E402

# Quick development records of the benchmark of other conditions, a quarter of them clean; and of the benchmark of any diagram, three of
# them clean, three with a wrong parameter.
WITH_ROLES = (901021, 901022, 901024, 901027, 901028, 901033, 901035, 901039, 901043, 901046, 901047, 901052, 901080, 901083, 901084,
              901092, 901098, 901118, 901060, 901064, 901074, 901076, 901079, 901126)
WITHOUT_ROLES = (120000, 120003, 120007, 120012, 120019, 120017, 120022, 120024, 120025, 120029)
FACTORS = (0.5, 1.5)
NONE = ("judged_row_s", 1.0)  # no threshold is changed


class Benchmark:
    """Records of one benchmark, and what its answers are worth."""

    def __init__(self, without_roles, generator):
        sys.path.insert(0, str(HERE.parent / ("any_diagram" if without_roles else "conditions")))
        import outcome
        import scenario
        self.outcome = outcome
        self.generate = scenario.generate if without_roles else lambda seed, folder: scenario.generate(generator, seed, folder)

    def judged(self, folder, file):
        truth = json.loads((folder / "truth.json").read_text())
        answer = json.loads(file.read_text()) if file.exists() else None
        result = {"truth": truth, "answer": answer, "exit": 0 if answer else 1, "over_limit": False, "text": "no answer"}
        return self.outcome.classify(result), self.outcome.said(result)


def thresholds(criteria, without_roles=False):
    """Names and values that such records meet, in the order of their file."""
    file = criteria.with_name("criteria_of_sites.h") if without_roles else criteria
    return [(name, value) for _, name, _, value in variable_criteria.thresholds(file.read_text())]


def answers(benchmark, program, name, factor, folders):
    """Class of each record's answer, and the answer itself without its numbers."""
    files = [folder / f"answer.{name}.{factor}.json" for folder in folders]
    missing = [folder for folder, file in zip(folders, files) if not file.exists()]
    for folder in missing:  # one at a time: one that fails does not end the others
        subprocess.run([str(a) for a in (program, name, factor, folder)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return [benchmark.judged(folder, file) for folder, file in zip(folders, files)]


def complaint(program, folder):
    """What the program prints on a record where it does not answer."""
    done = subprocess.run([str(a) for a in (program, *NONE, folder)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    return done.stderr.strip()


RIGHT = ("exact", "declared")


def cell(before, after):
    """"=" if every answer is the same, else what became of those that are not."""
    is_right = [b[0] in RIGHT for b in before]
    lost = [a[0] for a, right in zip(after, is_right) if right and a[0] not in RIGHT]
    mended = sum(a[0] in RIGHT for a, right in zip(after, is_right) if not right)
    other = sum(b[1] != a[1] for b, a in zip(before, after)) - len(lost) - mended
    parts = [f"{lost.count(c)} {c}" for c in dict.fromkeys(sorted(lost))]
    parts += [f"{mended} right"] if mended else []
    parts += [f"{other} said otherwise"] if other else []
    return ", ".join(parts) or "="


def table(varied, results):
    rows, unchanged = [], []
    for name, value in varied:
        cells = [cell(results[NONE], results[name, factor]) for factor in FACTORS]
        if set(cells) == {"="}:
            unchanged.append(f"`{name}`")
        else:
            rows.append([f"`{name}`", value, *cells])
    right = sum(c in RIGHT for c, _ in results[NONE])
    return (f"{len(results[NONE])} records, {right} right with the thresholds as they are.\n\n"
            + score.table(["threshold", "value", "half", "one and a half"], rows)
            + f"\n\nNo answer changes with {', '.join(unchanged) or 'any of them'}.\n")


def main():
    parser = argparse.ArgumentParser(prog="tools/sensitivity.sh", description="Half and one and a half of each threshold of the diagnosis.")
    parser.add_argument("--without-roles", action="store_true", help="the thresholds of any diagram, on records without roles")
    parser.add_argument("--seeds", type=int, nargs="+", help="of the benchmark of other conditions, or of any diagram")
    parser.add_argument("--thresholds", nargs="+", help="names in criteria.h (default all that such records meet)")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("build/sensitivity"), help="answers there are not computed again")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--program", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--generator", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    options = parser.parse_args()
    benchmark = Benchmark(options.without_roles, options.generator)
    seeds = options.seeds or (WITHOUT_ROLES if options.without_roles else WITH_ROLES)
    folders = [options.output / str(seed) for seed in seeds]
    for seed, folder in zip(seeds, folders):
        if not (folder / "truth.json").exists():
            folder.mkdir(parents=True, exist_ok=True)
            benchmark.generate(seed, folder)
    varied = thresholds(HERE.parents[1] / "tools/diagnose/criteria.h", options.without_roles)
    if options.thresholds:
        unknown = set(options.thresholds) - {name for name, _ in varied}
        if unknown:
            parser.error(f"no threshold {', '.join(sorted(unknown))}")
        varied = [(name, value) for name, value in varied if name in options.thresholds]
    runs = [NONE, *((name, factor) for name, _ in varied for factor in FACTORS)]
    results = {}
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        for run, result in zip(runs, pool.map(lambda r: answers(benchmark, options.program, *r, folders), runs)):
            results[run] = result
            if run == NONE and not any((folder / f"answer.{NONE[0]}.{NONE[1]}.json").exists() for folder in folders):
                pool.shutdown(wait=False, cancel_futures=True)
                parser.exit(1, f"{options.program} answers on none of these records; it says:\n{complaint(options.program, folders[0])}\n")
            print(f"{len(results)}/{len(runs)} {run[0]} × {run[1]}", file=sys.stderr, flush=True)
    print(table(varied, results), end="")


if __name__ == "__main__":
    main()
