"""Runs `loopwright diagnose` on diagrams of many kinds and judges the answers. Called by tools/any_diagram.sh."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "batch"))
import batch  # noqa: E402
import outcome  # noqa: E402
import scenario  # noqa: E402

KINDS = len(scenario.PLANTS) * len(scenario.CLASSES)


def judge(options, seed):
    return batch.judge(options, seed, lambda seed, folder: scenario.generate(seed, folder, options.disturbance))


def main():
    parser = batch.parser_of("tools/any_diagram.sh", "Judge the diagnosis of diagrams of many kinds.", "build/any_diagram", KINDS,
                             base=KINDS * 1000)
    parser.add_argument("--disturbance", type=float, default=0.0,
                        help="add a slow disturbance of this share of the signal where it acts, as 0.02; give an --output of its own")
    options = batch.parsed(parser)
    batch.run(options, lambda seed: judge(options, seed), outcome)


if __name__ == "__main__":
    main()
