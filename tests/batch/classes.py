"""What the benchmarks of diagnoses have in common: the classes of results, and the tables of a summary.

A result is {"truth", "answer", "exit", "time_s", "over_limit", "text"}: the truth of the scenario, the JSON of the answer (None if there is
none), the exit code (negative: the signal), the CPU seconds, whether the time limit ended it, and what the program said.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "hidden_effects"))
import score  # noqa: E402  tables and quantiles

CLASSES = ("exact", "declared", "flagged", "silent", "refused", "over_limit", "crash")
MEANING = {
    "declared": "a declared alternative is the hidden set",
    "flagged": "not right, and the answer says that something remains",
    "silent": "not right, and the answer says that everything is explained",
    "refused": "no answer, with a reason",
    "over_limit": "no answer within the time limit",
    "crash": "ended by a signal, or without a reason",
}


def without_answer(result):
    """The class of a result without an answer; None if there is one."""
    if result["over_limit"]:
        return "over_limit"
    if result["answer"] is None:
        return "refused" if result["exit"] in (1, 2) and result["text"].strip() != "" else "crash"
    return None


def said_without_answer(result):
    return f"exit {result['exit']}: " + " ".join(result["text"].split())[:300]


def tables(summary, meaning_of_exact, *groups):
    """The summary as Markdown tables."""
    marks = {True: "met", False: "**missed**", None: "not measured"}
    meaning = {"exact": meaning_of_exact, **MEANING}
    parts = [f"{summary['scenarios']} scenarios",
             score.table(["bar", "measured", "n", "must be", ""],
                         [[b["bar"], score.number(b["value"]) + (f" {b['unit']}" if b["unit"] and b["value"] is not None else ""), b["n"],
                           score.limit(b), marks[b["met"]] if score.limit(b) else ""] for b in summary["bars"]]),
             "\n".join(f"- {c}: {meaning[c]}" for c in CLASSES), *groups,
             "Not right (in brackets what the record gains in −2 ln L):\n" + "\n".join("- " + line for line in summary["not_right"])]
    return "\n\n".join(parts) + "\n"
