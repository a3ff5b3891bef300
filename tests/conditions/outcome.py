"""What an answer of `loopwright diagnose` is worth, and the tables of the conditions benchmark.

A result is what tests/batch/classes.py says.
"""

import itertools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "batch"))
from classes import CLASSES, said_without_answer, score, tables, without_answer  # noqa: E402

EXACT = "the set is the hidden one; of a clean record, nothing_missing"
# What stands for an effect whose own shape the record hardly shows.
SIMPLER = {"stribeck_friction": {"coulomb_friction"}, "presliding_hysteresis": {"coulomb_friction"}}


def required(truth):
    return {e["effect"] for e in truth["effects"] if e["counts"]}


def tolerated(truth):
    """Effects of which the record gains too little: named or not, the answer is right."""
    hardly_visible = {e["effect"] for e in truth["effects"] if not e["counts"]}
    return hardly_visible | {s for e in hardly_visible for s in SIMPLER.get(e, ())}


def is_clean(truth):
    return not truth["effects"]


def acceptable(names, truth):
    names, must, may = set(names), required(truth), tolerated(truth)
    if (names | must | may) & score.SPRINGS:  # the rest position of a spring is a constant force
        names, must = names - {"constant_force"}, must - {"constant_force"}
    return must <= names <= must | may


def too_small(result):
    """Effects that the answer says are there, but too small to matter; all of them stand for one."""
    return [effect["effect"] for effect in result["answer"].get("too_small", [])]


def invents_something_small(result):
    truth, small = result["truth"], too_small(result)
    return bool(small) and not set(small) & (required(truth) | tolerated(truth))


def declares(result):
    small = [[]] + [[name] for name in too_small(result)]
    for choices in score.declared_choices(result):
        for choice in itertools.product(*choices):
            if len(set(choice)) == len(choice) and any(acceptable([*choice, *more], result["truth"]) for more in small):
                return True
    return False


def classify(result):
    truth, answer = result["truth"], result["answer"]
    if answer is None or result["over_limit"]:
        return without_answer(result)
    names = score.found_names(result)
    if not invents_something_small(result):
        if not names:
            if not required(truth) and answer["verdict"] == "nothing_missing":
                return "exact"
        elif not is_clean(truth) and acceptable(names, truth):
            return "exact"
        if not is_clean(truth) and (names or too_small(result)) and declares(result):
            return "declared"
    return "flagged" if score.flagged(result) else "silent"


def share(results, *classes):
    return score.percent(classify(r) in classes for r in results)


def bars(results):
    hidden, clean = [r for r in results if not is_clean(r["truth"])], [r for r in results if is_clean(r["truth"])]

    def times(name, *classes):
        return score.bar(name, float(sum(classify(r) in classes for r in results)), len(results), at_most=0, unit="")

    return [score.bar("exact or declared, of the records with effects", share(hidden, "exact", "declared"), len(hidden), at_least=95),
            score.bar("exact, of the records with effects", share(hidden, "exact"), len(hidden)),
            score.bar("silently wrong or missed, of all", share(results, "silent"), len(results), at_most=1),
            score.bar("clean called nothing_missing", share(clean, "exact"), len(clean), at_least=97),
            times("crashes", "crash"), times("beyond the time limit", "over_limit"),
            score.share_bar("flagged although right", score.flagged, [r for r in results if classify(r) in ("exact", "declared")]),
            score.bar("refusals: each must have a reason that the user can mend", share(results, "refused"), len(results))]


def grouped(results, key):
    groups = {}
    for result in results:
        groups.setdefault(key(result["truth"]), []).append(result)
    rows = []
    for name in sorted(groups):
        row = {"group": name}
        for kind, chosen in (("hidden", [r for r in groups[name] if not is_clean(r["truth"])]),
                             ("clean", [r for r in groups[name] if is_clean(r["truth"])])):
            row[kind] = {"n": len(chosen), **{c: sum(classify(r) == c for r in chosen) for c in CLASSES}}
        times = [r["time_s"] for r in groups[name]]
        row["time_s"] = {"median": score.quantile(times, 0.5), "most": max(times)}
        rows.append(row)
    return rows


def said(result):
    answer = result["answer"]
    if answer is None:
        return said_without_answer(result)
    named = ", ".join(e["effect"] + (f" or {'/'.join(score.alternatives(e))}" if score.alternatives(e) else "")
                      for e in score.found(result))
    return f"{answer['verdict']}: {named or 'no effect'}"


def describe(result):
    truth = result["truth"]
    hidden = ", ".join(f"{e['effect']} ({e['gain']:.3g}{'' if e['counts'] else ', does not count'})" for e in truth["effects"])
    rate = 1 / truth["sample_time_s"]
    kind = truth["variant"] or truth["trajectory"]
    return (f"{truth['seed']} {truth['condition']} ({kind}), {truth['rows']} rows of {rate:.4g} Hz: "
            f"hidden {hidden or 'nothing'} → {said(result)} [{classify(result)}, {result['time_s']:.1f} s]")


def summary(results):
    return {"scenarios": len(results), "bars": bars(results), "by_condition": grouped(results, lambda t: t["condition"]),
            "by_variant": grouped([r for r in results if r["truth"]["variant"]], lambda t: f"{t['condition']}, {t['variant']}"),
            "not_right": [describe(r) for r in results if classify(r) not in ("exact", "declared")]}


def group_table(name, rows):
    columns = [name, "effects", "exact", "declared", "flagged", "silent", "refused", "limit", "crash",
               "clean", "right", "flagged", "silent", "refused", "limit", "crash", "s median", "s most"]
    return score.table(columns, [
        [row["group"], *[row["hidden"][c] for c in ("n", *CLASSES)],
         *[row["clean"][c] for c in ("n", "exact", "flagged", "silent", "refused", "over_limit", "crash")],
         score.number(row["time_s"]["median"], "{:.1f}"), score.number(row["time_s"]["most"], "{:.1f}")] for row in rows])


def text(s):
    return tables(s, EXACT, group_table("condition", s["by_condition"]), group_table("variant", s["by_variant"]))
