"""Runs `loopwright diagnose` on diagrams of many kinds and judges the answers. Called by tools/any_diagram.sh."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "batch"))
import batch  # noqa: E402
import outcome  # noqa: E402
import scenario  # noqa: E402

KINDS = len(scenario.PLANTS) * len(scenario.CLASSES)


def judge(options, seed):
    return batch.judge(options, seed, scenario.generate)


def main():
    options = batch.parsed(batch.parser_of("tools/any_diagram.sh", "Judge the diagnosis of diagrams of many kinds.", "build/any_diagram", KINDS,
                                           base=KINDS * 1000))
    batch.run(options, lambda seed: judge(options, seed), outcome)


if __name__ == "__main__":
    main()
