"""Scores the answers of `loopwright diagnose` against the truth.

A result is a dictionary {"truth", "answer", "held_out_ratio", "closed_loop_ratio", "time_s"}: truth.json of the generator, the JSON
of `diagnose` (None if it failed), and figures that the judge measured with the improved diagram.
"""

import itertools
import math

SPRINGS = {"spring", "hardening_spring"}

# Parameters whose intervals are checked, by the names of the catalogue; if an answer gives a wave by its amplitude,
# its two components are not counted again.
PARAMETERS = {
    "inertia": ["mass"],
    "viscous_friction": ["damping"],
    "coulomb_friction": ["level"],
    "stribeck_friction": ["level", "rise", "speed"],
    "direction_dependent_friction": ["asymmetry"],
    "quadratic_drag": ["drag"],
    "eddy_current_drag": ["damping", "critical_speed"],
    "presliding_hysteresis": ["level", "distance"],
    "cogging": ["pitch", "amplitude"],
    "velocity_dependent_cogging": ["pitch", "slope"],
    "force_ripple": ["pitch", "depth"],
    "force_gain": ["gain_error"],
    "force_saturation": ["droop"],
    "constant_force": ["level"],
    "spring": ["stiffness"],
    "hardening_spring": ["cubic_stiffness", "rest_position"],
    "end_stop": ["stiffness", "place"],
    "backlash": ["load_mass", "gap"],
    "flexible_mode": ["load_mass", "frequency", "damping_ratio"],
    "input_delay": ["delay"],
    "actuator_lag": ["time_constant"],
    "thermal_drift": ["drift", "change", "time_constant"],
    "encoder_periodic_error": ["pitch", "amplitude"],
}


def quantile(values, share):
    """Linear interpolation between order statistics; None for an empty list."""
    ordered = sorted(v for v in values if v is not None and math.isfinite(v))
    if not ordered:
        return None
    at = share * (len(ordered) - 1)
    low = int(at)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (at - low) * (ordered[high] - ordered[low])


def percent(flags):
    flags = list(flags)
    return 100 * sum(flags) / len(flags) if flags else None


def comparable(names):
    """The set that counts: a spring's rest position is an offset, so a constant force beside a spring is ignored."""
    names = set(names)
    return frozenset(names - {"constant_force"} if names & SPRINGS else names)


def true_names(result):
    return [effect["effect"] for effect in result["truth"]["effects"]]


def found(result):
    return (result["answer"] or {}).get("effects", [])


def found_names(result):
    return [effect["effect"] for effect in found(result)]


def alternatives(effect):
    names = [a if isinstance(a, str) else a["effect"] for a in effect.get("alternatives", [])]
    return [name for name in names if name != effect["effect"]]


def exact(result):
    return result["answer"] is not None and comparable(true_names(result)) == comparable(found_names(result))


def declared_choices(result):
    """For each declared explanation, the names that each of its effects may have."""
    yield [[effect["effect"], *alternatives(effect)] for effect in found(result)]
    for other in result["answer"].get("other_explanations", []):
        kept = [effect for effect in found(result) if effect["effect"] not in other["in_place_of"]]
        yield [[effect["effect"], *alternatives(effect)] for effect in kept] + [[name] for name in other["effects"]]


def exact_or_declared(result):
    """Whether a declared explanation is the truth, for some choice of each named effect or one of its alternatives."""
    if result["answer"] is None:
        return False
    truth = comparable(true_names(result))
    return any(comparable(choice) == truth and len(set(choice)) == len(choice)
               for choices in declared_choices(result) for choice in itertools.product(*choices))


def first_true(result):
    names = found_names(result)
    return bool(names) and names[0] in true_names(result)


def false_alarm(result):
    return result["answer"] is None or result["answer"]["verdict"] != "nothing_missing" or bool(found(result))


def flagged(result):
    return result["answer"] is not None and result["answer"]["verdict"] in ("partly_explained", "unexplained")


def variable_named(result):
    outside = next(e for e in result["truth"]["effects"] if "variables" in e)
    named = ((result["answer"] or {}).get("remainder") or {}).get("variables") or []
    return set(named) == set(outside["variables"])


def covered(result):
    """For each leading parameter of an exactly found set: (effect, parameter, inside its interval?, error / half-width)."""
    truth = {e["effect"]: e["parameters"] for e in result["truth"]["effects"]}
    for effect in found(result):
        name = effect["effect"]
        if name not in truth:
            continue
        given = {p: v for p, v in effect["parameters"].items() if v.get("low") is not None and v.get("high") is not None}
        parameters = PARAMETERS[name]
        if not {"amplitude", "slope", "depth"} & set(given):
            parameters = parameters + ["sine", "cosine"]
        for parameter in parameters:
            if parameter not in truth[name] or parameter not in given:
                continue
            interval = given[parameter]
            value, low, high = truth[name][parameter], interval["low"], interval["high"]
            width = max((high - low) / 2, 1e-300)
            yield name, parameter, low <= value <= high, (interval["value"] - value) / width


def bar(name, value, count, at_least=None, at_most=None, unit="%"):
    met = None
    if value is not None:
        met = (at_least is None or value >= at_least) and (at_most is None or value <= at_most)
    return {"bar": name, "value": value, "n": count, "at_least": at_least, "at_most": at_most, "unit": unit, "met": met}


def share_bar(name, judge, results, **limits):
    results = list(results)
    return bar(name, percent(map(judge, results)), len(results), **limits)


def ratio_bars(name, values, median_most, p90_most):
    values = [v for v in values if v is not None]
    return [bar(f"{name}, median", quantile(values, 0.5), len(values), at_most=median_most, unit=""),
            bar(f"{name}, p90", quantile(values, 0.9), len(values), at_most=p90_most, unit="")]


def bars(results):
    """The table of bars; `met` is None if nothing was measured."""
    clean = [r for r in results if r["truth"]["kind"] == "clean"]
    outside = [r for r in results if r["truth"]["kind"] == "outside"]
    hidden = [r for r in results if r["truth"]["kind"] == "hidden"]
    forward = [r for r in hidden if r["truth"]["trajectory"] == "forward"]
    both_ways = [r for r in hidden if r["truth"]["trajectory"] != "forward"]
    slow = [r for r in hidden if r["truth"]["trajectory"] == "constant_speeds"]
    right = [r for r in hidden if exact(r)]
    inside = [c[2] for r in right for c in covered(r) if c[0] != "backlash"]
    long = [r["time_s"] for r in results if r["truth"]["trajectory"] == "many_speeds" and r["time_s"] is not None]
    every = [r["time_s"] for r in results if r["time_s"] is not None]
    return [
        share_bar("false alarms on clean records", false_alarm, clean, at_most=1),
        share_bar("first-ranked effect true", first_true, hidden, at_least=98),
        share_bar("exact set (all but the forward pass)", exact, both_ways, at_least=97),
        share_bar("exact or declared ambiguity (all but the forward pass)", exact_or_declared, both_ways, at_least=99),
        share_bar("exact or declared ambiguity, forward pass", exact_or_declared, forward, at_least=92),
        share_bar("exact set, constant speeds", exact, slow, at_least=95),
        *ratio_bars("held-out force residual over true floor, exact sets",
                    [r.get("held_out_ratio") for r in right], 1.02, 1.10),
        *ratio_bars("closed-loop error over that of the true model (all but the forward pass)",
                    [r.get("closed_loop_ratio") for r in both_ways], 1.05, 1.5),
        *ratio_bars("closed-loop error over that of the true model, forward pass",
                    [r.get("closed_loop_ratio") for r in forward], None, None),
        share_bar("outside the catalogue: flagged", flagged, outside, at_least=97),
        share_bar("flagged although right (exact sets and clean)", flagged, right + [r for r in clean if not found(r)],
                  at_most=3),
        share_bar("outside the catalogue: right variable named", variable_named, outside, at_least=80),
        bar("95 % intervals that cover (exact sets, without backlash)", percent(inside), len(inside), at_least=92,
            at_most=97),
        bar("CPU time for a record of 56 s, median", quantile(long, 0.5), len(long), at_most=1.5, unit="s"),
        bar("CPU time for a record of 56 s, p95", quantile(long, 0.95), len(long), at_most=8, unit="s"),
        bar("CPU time for any record, most", max(every, default=None), len(every), at_most=60, unit="s"),
    ]


def breakdown(results, key):
    """Exact, declared and first-ranked shares of the hidden sets by key(result)."""
    rows = {}
    for result in results:
        if result["truth"]["kind"] == "hidden":
            rows.setdefault(key(result), []).append(result)
    return [{"group": str(group), "n": len(rows[group]), "exact": percent(map(exact, rows[group])),
             "exact_or_declared": percent(map(exact_or_declared, rows[group])),
             "first_true": percent(map(first_true, rows[group]))} for group in sorted(rows)]


def calibration(results):
    """The share of true effects among those named with this inclusion probability."""
    rows = []
    for low, high in ((0, 0.2), (0.2, 0.8), (0.8, 0.95), (0.95, 0.99), (0.99, 1.0001)):
        claims = [(e["inclusion"], e["effect"] in true_names(r)) for r in results if r["truth"]["kind"] == "hidden"
                  for e in found(r) if low <= (e.get("inclusion") or 0) < high]
        claimed = sum(c for c, _ in claims) / len(claims) if claims else None
        rows.append({"from": low, "to": min(high, 1), "n": len(claims), "claimed_percent": claimed and 100 * claimed,
                     "true_percent": percent(t for _, t in claims)})
    return rows


def by_effect(results):
    """How often each effect was hidden, found, missed, and named although absent."""
    rows = {}
    for result in results:
        if result["truth"]["kind"] == "outside":
            continue
        truth, answer = set(true_names(result)), set(found_names(result))
        if (truth | answer) & SPRINGS:
            truth, answer = truth - {"constant_force"}, answer - {"constant_force"}
        for name in truth | answer:
            row = rows.setdefault(name, {"effect": name, "hidden": 0, "found": 0, "false": 0, "missed_by_seeds": []})
            row["hidden"] += name in truth
            row["found"] += name in truth & answer
            row["false"] += name in answer - truth
            if name in truth - answer:
                row["missed_by_seeds"].append(result["truth"]["seed"])
    return [rows[name] for name in sorted(rows)]


def coverage(results):
    rows = {}
    for result in results:
        if result["truth"]["kind"] == "hidden" and exact(result):
            for name, parameter, inside, error in covered(result):
                rows.setdefault(f"{name}.{parameter}", []).append((inside, error))
    return [{"parameter": name, "n": len(rows[name]), "inside": sum(i for i, _ in rows[name]),
             "median_error_in_half_widths": quantile([e for _, e in rows[name]], 0.5)} for name in sorted(rows)]


def wrong(result):
    kind = result["truth"]["kind"]
    if kind == "clean":
        return false_alarm(result)
    return not exact(result) if kind == "hidden" else not (flagged(result) and variable_named(result))


def describe(result):
    truth, answer = result["truth"], result["answer"]
    hidden = ", ".join(f"{e['effect']} ({e['own_force_rms_N']:.3g} N)" for e in truth["effects"]) or "nothing"
    if answer is None:
        said = "no answer: " + " ".join(result.get("failure", "").split())[:200]
    else:
        said = answer["verdict"] + ": " + (", ".join(
            e["effect"] + (f" or {'/'.join(alternatives(e))}" if alternatives(e) else "") for e in found(result)) or "nothing")
        if flagged(result):
            said += f"; remainder {((answer.get('remainder') or {}).get('variables'))}"
    mark = "declared" if exact_or_declared(result) else "wrong"
    return f"{truth['seed']} {truth['trajectory']}, {truth['controller']}: hidden {hidden} → {said} [{mark}]"


def summary(results):
    return {
        "scenarios": len(results),
        "bars": bars(results),
        "by_trajectory": breakdown(results, lambda r: r["truth"]["trajectory"]),
        "by_number_of_effects": breakdown(results, lambda r: len(r["truth"]["effects"])),
        "by_controller": breakdown(results, lambda r: r["truth"]["controller"]),
        "by_effect": by_effect(results),
        "calibration": calibration(results),
        "coverage": coverage(results),
        "other_explanations_per_answer": quantile([len(r["answer"].get("other_explanations", [])) for r in results
                                                   if r["answer"]], 0.9),
        "declared_alternatives_per_effect": quantile([len(alternatives(e)) for r in results for e in found(r)], 0.9),
        "failures": [describe(r) for r in results if wrong(r)],
    }


def number(value, form="{:.4g}"):
    return "—" if value is None else form.format(value)


def limit(row):
    parts = ([f"≥ {row['at_least']}"] if row["at_least"] is not None else []) + (
        [f"≤ {row['at_most']}"] if row["at_most"] is not None else [])
    return " and ".join(parts)


def table(columns, rows):
    widths = [max(len(str(r[i])) for r in [columns, *rows]) for i in range(len(columns))]
    lines = [columns, ["-" * w for w in widths], *rows]
    return "\n".join("| " + " | ".join(str(c).ljust(w) for c, w in zip(line, widths)) + " |" for line in lines)


def text(s):
    """The summary as Markdown tables."""
    marks = {True: "met", False: "**missed**", None: "not measured"}
    parts = [f"{s['scenarios']} scenarios",
             table(["bar", "measured", "n", "must be", ""],
                   [[b["bar"], number(b["value"]) + (f" {b['unit']}" if b["unit"] and b["value"] is not None else ""), b["n"],
                     limit(b), marks[b["met"]] if limit(b) else ""] for b in s["bars"]])]
    for key in ("by_trajectory", "by_number_of_effects", "by_controller"):
        parts.append(table([key.replace("_", " "), "n", "exact %", "exact or declared %", "first true %"],
                           [[g["group"], g["n"], number(g["exact"]), number(g["exact_or_declared"]), number(g["first_true"])]
                            for g in s[key]]))
    parts.append(table(["effect", "hidden", "found", "named though absent", "missed in"],
                       [[e["effect"], e["hidden"], e["found"], e["false"], " ".join(map(str, e["missed_by_seeds"]))]
                        for e in s["by_effect"]]))
    parts.append(table(["inclusion", "n", "claimed %", "true %"],
                       [[f"{c['from']} … {c['to']}", c["n"], number(c["claimed_percent"]), number(c["true_percent"])]
                        for c in s["calibration"]]))
    parts.append(table(["95 % interval of", "n", "inside", "median error in half-widths"],
                       [[c["parameter"], c["n"], c["inside"], number(c["median_error_in_half_widths"], "{:+.2f}")]
                        for c in s["coverage"]]))
    parts.append("Not right:\n" + "\n".join("- " + f for f in s["failures"]))
    return "\n\n".join(parts) + "\n"
