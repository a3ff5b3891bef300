"""Runs `loopwright diagnose` on many scenarios, each judged blind, and continues where an interrupted batch stopped."""

import argparse
import concurrent.futures
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile

TUNING, JUDGING = 100_000, 900_000
INTERRUPTED = 130  # the program's exit code


def diagnose(program, folder, limit_s, more=()):
    """The answer, exit code, text and CPU seconds of one diagnosis."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (limit_s, limit_s + 5))

    with tempfile.TemporaryFile("w+", errors="replace") as said:
        process = subprocess.Popen([str(a) for a in (program, "diagnose", folder / "diagram.json", folder / "record.experiment.json",
                                                     "--json", folder / "answer.json", *more)],
                                   stdout=said, stderr=said, preexec_fn=limit)
        _, status, usage = os.wait4(process.pid, 0)  # not wait(): the CPU time of this child alone
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        text = "".join(line for line in said if not line.startswith("diagnose: "))  # without progress
    answer = folder / "answer.json"
    ended = process.returncode
    return {"answer": json.loads(answer.read_text()) if ended == 0 and answer.exists() else None, "exit": ended,
            "over_limit": ended in (-signal.SIGXCPU, -signal.SIGKILL), "time_s": usage.ru_utime + usage.ru_stime,
            "text": text[:2000]}


def judge(options, seed, generate, more=lambda folder: ()):
    """`generate(seed, folder)` writes a scenario and returns its truth; `more(folder)` are further arguments of the diagnosis."""
    result_file = options.output / f"{seed}.json"
    if result_file.exists():
        return json.loads(result_file.read_text())
    folder = options.output / f"{seed}"
    truth = generate(seed, folder)
    (folder / "truth.json").unlink()  # the diagnosis must not read it
    result = {"truth": truth, **diagnose(options.loopwright, folder, options.limit, more(folder))}
    if result["exit"] in (INTERRUPTED, -signal.SIGINT):
        raise KeyboardInterrupt
    partial = result_file.with_suffix(".partial")  # atomically, so that an interrupted batch can resume
    partial.write_text(json.dumps(result, indent=1))
    partial.rename(result_file)
    if options.keep:
        (folder / "truth.json").write_text(json.dumps(truth, indent=1))
    else:
        shutil.rmtree(folder)
    return result


def parser_of(tool, description, folder, kinds, base=TUNING):
    parser = argparse.ArgumentParser(prog=tool, description=description)
    parser.add_argument("count", type=int, help=f"scenarios; multiples of {kinds} have all kinds alike")
    parser.add_argument("--seed-base", type=int, default=base,
                        help=f"first seed: {base} … for tuning (default), {JUDGING} … for judging alone")
    parser.add_argument("--every", type=int, default=1, help="take every n-th seed, to see more of the kinds in fewer records")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--limit", type=int, default=120, help="CPU seconds a record (default 120)")
    parser.add_argument("--output", type=pathlib.Path, help=f"results, one a seed; those there are not run again (default {folder}/SEED_BASE)")
    parser.add_argument("--json", type=pathlib.Path, help="the tables as JSON")
    parser.add_argument("--keep", action="store_true", help="keep records and diagrams of each scenario")
    parser.add_argument("--loopwright", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.set_defaults(folder=pathlib.Path(folder))
    return parser


def parsed(parser):
    options = parser.parse_args()
    options.output = options.output or options.folder / str(options.seed_base)
    options.output.mkdir(parents=True, exist_ok=True)
    return options


def run(options, judge_seed, outcome):
    """All seeds; prints a line for each and the tables of `outcome`."""
    seeds = range(options.seed_base, options.seed_base + options.count * options.every, options.every)
    results = []
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        for result in pool.map(judge_seed, seeds):
            results.append(result)
            print(f"{len(results)}/{options.count} {outcome.describe(result)}", file=sys.stderr, flush=True)
    summary = outcome.summary(results)
    print(outcome.text(summary), end="")
    if options.json:
        options.json.write_text(json.dumps(summary, indent=1))
