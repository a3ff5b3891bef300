#!/usr/bin/env python3
"""Compares the figures of two builds, in turn, so that a change of the machine's speed meets both.

    tests/benchmarks/paired.py OLD NEW [--runs 9] [--filter REGEX]

OLD and NEW are programs `benchmarks` of two builds. Prints for every figure both medians and the median of the
pairwise ratios NEW/OLD, turned so that more than 1 is worse. Ends with 1 if a figure is more than 10 % worse.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile

ALLOWED = 1.10


def measure(program, pattern):
    """All figures of one run: {name: entry}."""
    with tempfile.TemporaryDirectory() as folder:
        report = os.path.join(folder, "report.json")
        options = ["--benchmark_filter=" + pattern] if pattern else []
        outcome = subprocess.run([program, report, *options], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if outcome.returncode not in (0, 1):  # 1: a bar is missed
            sys.exit(f"{program}: {outcome.stderr}")
        with open(report, encoding="utf-8") as file:
            return {name: entry for name, entry in json.load(file).items() if isinstance(entry, dict)}


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("old")
    arguments.add_argument("new")
    arguments.add_argument("--runs", type=int, default=9)
    arguments.add_argument("--filter", default="")
    options = arguments.parse_args()
    old, new = [], []
    for run in range(options.runs):
        order = [(old, options.old), (new, options.new)]
        for figures, program in order if run % 2 == 0 else reversed(order):
            figures.append(measure(program, options.filter))
        print(f"run {run + 1} of {options.runs}", file=sys.stderr)
    worse = []
    print(f"{'figure':44} {'old':>12} {'new':>12} {'worse by':>9}")
    for name, entry in new[0].items():
        if any(name not in figures for figures in old + new):
            print(f"{name:44} only one of the builds has it")
            continue
        pairs = [(a[name]["value"], b[name]["value"]) for a, b in zip(old, new)]
        is_better_when_larger = "at_least" in entry
        ratio = statistics.median(a / b if is_better_when_larger else b / a for a, b in pairs)
        print(f"{name:44} {statistics.median(a for a, _ in pairs):12.4g} {statistics.median(b for _, b in pairs):12.4g} {ratio:9.3f}")
        if ratio > ALLOWED:
            worse.append(name)
    if worse:
        print(f"more than 10 % worse: {', '.join(worse)}", file=sys.stderr)
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main())
