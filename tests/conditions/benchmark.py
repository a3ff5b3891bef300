"""Runs `loopwright diagnose` on scenarios of many conditions and judges the answers. Called by tools/conditions.sh."""

import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "batch"))
import batch  # noqa: E402
import outcome  # noqa: E402
import scenario  # noqa: E402

CONDITIONS = 20  # of the generator; that of a seed is its remainder


def judge(options, seed):
    return batch.judge(options, seed, lambda s, folder: scenario.generate(options.generator, s, folder),
                       lambda folder: ("-o", folder / "improved.json"))


def main():
    parser = batch.parser_of("tools/conditions.sh", "Judge the diagnosis under many conditions.", "build/conditions", CONDITIONS)
    parser.add_argument("--generator", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    options = batch.parsed(parser)
    batch.run(options, lambda seed: judge(options, seed), outcome)


if __name__ == "__main__":
    main()
