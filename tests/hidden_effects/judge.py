"""Runs `loopwright diagnose` on scenarios of the generator and scores the answers. Called by tools/hidden_effects.sh."""

import argparse
import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading

import score

TUNING, JUDGING = 100_000, 900_000


def run(command, timeout_s=600):
    """(success, error text, CPU seconds)"""
    with tempfile.TemporaryFile("w+") as errors:
        process = subprocess.Popen([str(c) for c in command], stdout=subprocess.DEVNULL, stderr=errors)
        limit = threading.Timer(timeout_s, process.kill)
        limit.start()
        _, status, usage = os.wait4(process.pid, 0)  # not wait(): the CPU time of this child alone
        limit.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        text = f"ended with {process.returncode}: " + errors.read()
    return process.returncode == 0, text, usage.ru_utime + usage.ru_stime


def read(path):
    return json.loads(path.read_text()) if path.exists() else None


def write(path, value):
    """Writes the file atomically, so that an interrupted batch can resume."""
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps(value, indent=1))
    partial.rename(path)


def compared(options, diagram, folder, experiment, *more):
    out = folder / f"{experiment}.compared.json"
    good, _, _ = run([options.loopwright, "compare", diagram, folder / f"{experiment}.experiment.json", "--json", out, *more])
    return read(out) if good else None


def ratio(numerator, denominator):
    return numerator / denominator if numerator is not None and denominator else None


def figures(options, folder, truth):
    """Errors of the improved diagram on a record that the diagnosis has not seen, relative to the noise floor."""
    improved = folder / "improved.json"
    if not improved.exists():
        improved = folder / "nominal.json"

    def residual(comparison):
        return comparison and (comparison.get("force_residual") or {}).get("rmse")

    held_out = residual(compared(options, improved, folder, "held_out"))
    floor = residual(compared(options, folder / "nominal.json", folder, "floor", "--set", f"axis.mass={truth['mass_kg']}"))
    loop = compared(options, improved, folder, "closed_loop")
    error = loop and loop["signals"]["controller.measured"]["rmse"]
    return {"held_out_ratio": ratio(held_out, floor),
            "closed_loop_ratio": ratio(error, truth["closed_loop_rmse_m"]["true_model"])}


def judge(options, seed):
    result_file = options.output / f"{seed}.json"
    if result_file.exists():
        return read(result_file)
    folder = options.output / f"{seed}"
    good, error, _ = run([options.generator, seed, folder])
    if not good:
        sys.exit(f"generator, seed {seed}: {error}")
    truth = read(folder / "truth.json")
    (folder / "truth.json").unlink()  # the diagnosis must not read it
    answered, error, seconds = run([options.loopwright, "diagnose", folder / "nominal.json", folder / "train.experiment.json",
                                    "--json", folder / "answer.json", "-o", folder / "improved.json", "--all"])
    result = {"truth": truth, "answer": read(folder / "answer.json") if answered else None, "time_s": seconds,
              "failure": "" if answered else error[-2000:]}
    result |= figures(options, folder, truth)
    write(result_file, result)
    if options.keep:
        write(folder / "truth.json", truth)
    else:
        shutil.rmtree(folder)
    return result


def arguments():
    parser = argparse.ArgumentParser(prog="tools/hidden_effects.sh", description="Judge the diagnosis on hidden effects.")
    parser.add_argument("count", type=int, help="scenarios")
    parser.add_argument("--seed-base", type=int, default=TUNING,
                        help=f"first seed: {TUNING} … for tuning (default), {JUDGING} … for judging alone")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--output", type=pathlib.Path, help="results, one a seed; those there are not run again "
                        "(default build/hidden_effects/SEED_BASE)")
    parser.add_argument("--json", type=pathlib.Path, help="the table as JSON")
    parser.add_argument("--keep", action="store_true", help="keep records and diagrams of each scenario")
    parser.add_argument("--loopwright", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--generator", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    options = parser.parse_args()
    options.output = options.output or pathlib.Path("build/hidden_effects") / str(options.seed_base)
    options.output.mkdir(parents=True, exist_ok=True)
    return options


def main():
    options = arguments()
    seeds = range(options.seed_base, options.seed_base + options.count)
    results = []
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        for result in pool.map(lambda seed: judge(options, seed), seeds):
            results.append(result)
            verdict = (result["answer"] or {}).get("verdict", "no answer")
            print(f"\r{len(results)}/{options.count}  seed {result['truth']['seed']}: {verdict:20}",
                  end="" if sys.stderr.isatty() else "\n", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    summary = score.summary(results)
    print(score.text(summary), end="")
    if options.json:
        write(options.json, summary)


if __name__ == "__main__":
    main()
