"""Whether an answer hangs on the last bits of a record: scenarios of the generator, and the same with 1e-12 of each value
as noise, are diagnosed by `loopwright diagnose`, and the answers compared.

    python3 tests/hidden_effects/rounding.py 100 --seed-base 100000
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

NOISE = 1e-12  # of each value
MOST_TURNED = 0.01  # of the answers


def rounded_otherwise(text, seed):
    """The rows of a CSV file with noise on all but the time."""
    noise = random.Random(seed)
    head, *rows = text.splitlines()

    def changed(row):
        time, *values = row.split(",")
        return ",".join([time] + [repr(float(v) * (1 + NOISE * noise.gauss(0, 1))) for v in values])

    return "\n".join([head] + [changed(row) for row in rows]) + "\n"


def answer(options, folder, experiment):
    out = folder / f"{experiment}.answer.json"
    subprocess.run([options.bin / "loopwright", "diagnose", folder / "nominal.json", folder / f"{experiment}.experiment.json",
                    "--json", out], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    told = json.loads(out.read_text())
    return told["verdict"], sorted(effect["effect"] for effect in told["effects"])


def compared(options, seed):
    """(seed, answer, answer to the record with other last bits)"""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([options.bin / "hidden_effects", str(seed), folder], check=True, stdout=subprocess.DEVNULL)
        (folder / "other.csv").write_text(rounded_otherwise((folder / "train.csv").read_text(), seed))
        experiment = (folder / "train.experiment.json").read_text()
        (folder / "other.experiment.json").write_text(experiment.replace("train.csv", "other.csv"))
        return seed, answer(options, folder, "train"), answer(options, folder, "other")


def main():
    parser = argparse.ArgumentParser(description="Compare answers to records that differ in their last bits.")
    parser.add_argument("count", type=int, help="scenarios")
    parser.add_argument("--seed-base", type=int, default=100_000)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--bin", type=pathlib.Path, default=pathlib.Path("build/release/bin"), help="folder of the programs")
    options = parser.parse_args()
    turned = 0
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        seeds = range(options.seed_base, options.seed_base + options.count)
        for seed, one, other in pool.map(lambda seed: compared(options, seed), seeds):
            if one != other:
                turned += 1
                print(f"{seed}: {one} or {other}", flush=True)
    print(f"{options.count - turned} of {options.count} answers are the same")
    sys.exit(turned > MOST_TURNED * options.count)


if __name__ == "__main__":
    main()
