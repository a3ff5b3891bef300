"""What an answer about a diagram without roles is worth, and the tables of the benchmark of any diagram.

A result is what tests/batch/classes.py says. A term is (site, shape, variable).
What the record hardly shows (`counts` is false) may be named or not.
"""

import itertools
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "batch"))
from classes import CLASSES, said_without_answer, score, tables, without_answer  # noqa: E402

EXACT = "terms with their sites, and moved parameters, are the hidden ones; outside the catalogue: a function at the right site"
UNKNOWN = "unknown"  # what the answer calls a function without a name


def term(text):
    """Of "site: shape(variable)"."""
    match = re.fullmatch(r"(.+?): (\w+)(?:\((.+)\))?", text)
    return match and (match[1], match[2], match[3] or "")


def found_terms(answer):
    return [(e["site"], e["effect"], " ".join(e["variables"])) for e in answer["effects"]]


def found_parameters(answer):
    return list(answer["moved_parameters"])


def is_named(effect, site, shape, variable):
    if [site, shape, variable] in effect["also"]:
        return True
    shapes = effect["shapes"] or [UNKNOWN]
    # A distortion depends on the signal of its own port.
    return site in effect["sites"] and shape in shapes and (not effect["variables"] or variable in effect["variables"])


def is_at_site(effect, site):
    return site in effect["sites"] or any(site == s for s, _, _ in effect["also"])


def explains(terms, effects, fits):
    """Whether each term stands for another effect, and none that counts is left."""
    if not terms:
        return not any(e["counts"] for e in effects)
    return any(fits(e, *terms[0]) and explains(terms[1:], effects[:i] + effects[i + 1:], fits) for i, e in enumerate(effects))


def is_right(terms, parameters, truth):
    must, may = {p["name"] for p in truth["parameters"] if p["counts"]}, {p["name"] for p in truth["parameters"]}
    return must <= set(parameters) <= may and explains(list(terms), truth["effects"], is_named)


def declared(answer):
    """All declared (terms, parameters)."""
    terms, parameters = found_terms(answer), found_parameters(answer)
    choices = [[own, *filter(None, map(term, e["alternatives"]))] for own, e in zip(terms, answer["effects"])]
    yield from ((list(choice), parameters) for choice in itertools.product(*choices))
    for other in answer["other_explanations"]:
        kept = [t for t, e in zip(terms, answer["effects"]) if e["effect"] not in other["in_place_of"]]
        there = [term(text) for text in other["effects"]]
        moved = [p for p in parameters if p not in other["in_place_of"]] + [n for n, t in zip(other["effects"], there) if t is None]
        yield [*kept, *filter(None, there)], moved


def flagged(result):
    return result["answer"] is not None and result["answer"]["verdict"] in ("partly_explained", "unexplained")


def classify(result):
    truth, answer = result["truth"], result["answer"]
    if answer is None or result["over_limit"]:
        return without_answer(result)
    terms, parameters = found_terms(answer), found_parameters(answer)
    if terms or parameters or answer["verdict"] == "nothing_missing":
        if is_right(terms, parameters, truth):
            return "exact"
        if any(is_right(*choice, truth) for choice in declared(answer)):
            return "declared"
    return "flagged" if flagged(result) else "silent"


def sites_are_right(result):
    answer = result["answer"]
    if answer is None:
        return False
    sites = sorted({site for site, _, _ in found_terms(answer)})
    effects = result["truth"]["effects"]
    return (all(any(is_at_site(e, s) for e in effects) for s in sites) and
            all(any(is_at_site(e, s) for s in sites) for e in effects if e["counts"]))


def of_class(results, *classes):
    return [r for r in results if r["truth"]["class"] in classes]


def within_catalogue(results):
    return [r for r in of_class(results, "one", "two", "three", "one_and_parameter") if any(e["counts"] for e in r["truth"]["effects"])]


def simulation_ratio(result):
    if result["answer"] is None or not result["answer"]["steps"]:
        return None
    port = result["truth"]["outputs"].index(result["answer"]["error"]["port"])
    return result["answer"]["steps"][-1]["simulation_rmse"] / result["truth"]["simulation"][port]


def share(results, *classes):
    return score.percent(classify(r) in classes for r in results)


def bars(results):
    hidden, clean, parameter = within_catalogue(results), of_class(results, "clean"), of_class(results, "parameter")
    outside = [r for r in of_class(results, "outside") if any(not e["shapes"] and e["counts"] for e in r["truth"]["effects"])]
    inside = [r for r in results if all(e["shapes"] for e in r["truth"]["effects"])]
    ratios, times = [simulation_ratio(r) for r in inside], [r["time_s"] for r in results]

    def plain(name, value, n, **limits):
        return score.bar(name, value, n, unit="", **limits)

    return [score.bar("false effects on clean and parameter-only records",
                      score.percent(r["answer"] is None or bool(r["answer"]["effects"]) for r in clean + parameter), len(clean + parameter),
                      at_most=1),
            score.bar("clean called nothing_missing", score.percent((r["answer"] or {}).get("verdict") == "nothing_missing" for r in clean),
                      len(clean)),
            score.bar("a wrong parameter named as that", share(parameter, "exact", "declared"), len(parameter), at_least=95),
            score.bar("sites right, of the records with effects", score.percent(map(sites_are_right, hidden)), len(hidden), at_least=95),
            score.bar("exact or declared, of the records with effects", share(hidden, "exact", "declared"), len(hidden), at_least=90),
            score.bar("exact, of the records with effects", share(hidden, "exact"), len(hidden)),
            score.bar("outside the catalogue: flagged with site and variable", share(outside, "exact"), len(outside), at_least=85),
            score.bar("outside the catalogue: flagged", score.percent(map(flagged, outside)), len(outside)),
            score.bar("silently wrong, of all", share(results, "silent"), len(results)),
            plain("simulation error over that of the true model, median", score.quantile(ratios, 0.5), len(ratios), at_most=1.02),
            plain("simulation error over that of the true model, 90 %", score.quantile(ratios, 0.9), len(ratios), at_most=1.2),
            plain("CPU seconds a record, median", score.quantile(times, 0.5), len(times), at_most=10),
            plain("CPU seconds a record, longest", max(times), len(times)),
            plain("crashes", float(sum(classify(r) == "crash" for r in results)), len(results), at_most=0),
            plain("refused", float(sum(classify(r) == "refused" for r in results)), len(results), at_most=0)]


def grouped(results, key):
    groups = {}
    for result in results:
        groups.setdefault(result["truth"][key], []).append(result)
    return [{"group": name, "n": len(groups[name]), **{c: sum(classify(r) == c for r in groups[name]) for c in CLASSES},
             "sites": sum(map(sites_are_right, groups[name])), "median_s": score.quantile([r["time_s"] for r in groups[name]], 0.5)}
            for name in sorted(groups)]


def said(result):
    answer = result["answer"]
    if answer is None:
        return said_without_answer(result)
    named = [f"{site} {shape}({variable})" for site, shape, variable in found_terms(answer)] + found_parameters(answer)
    return f"{answer['verdict']}: {', '.join(named) or 'nothing'}"


def describe(result):
    truth = result["truth"]
    hidden = [f"{e['sites'][0]} {e['law']}({(e['variables'] or [''])[0]}) [{e['gain']:.3g}{'' if e['counts'] else ', does not count'}]"
              for e in truth["effects"]]
    hidden += [f"{p['name']} ×{p['true'] / p['stated']:.3g} [{p['gain']:.3g}]" for p in truth["parameters"]]
    ratio = simulation_ratio(result)
    return (f"{truth['seed']} {truth['plant']}, {truth['class']}: {', '.join(hidden) or 'nothing'} → {said(result)} "
            f"[{classify(result)}, {result['time_s']:.1f} s{'' if ratio is None else f', ×{ratio:.3g}'}]")


def summary(results):
    return {"scenarios": len(results), "bars": bars(results), "by_plant": grouped(results, "plant"), "by_class": grouped(results, "class"),
            "not_right": [describe(r) for r in results if classify(r) not in ("exact", "declared")]}


def group_table(name, rows):
    return score.table([name, "n", *CLASSES, "sites right", "s median"],
                       [[r["group"], r["n"], *(r[c] for c in CLASSES), r["sites"], score.number(r["median_s"], "{:.1f}")] for r in rows])


def text(s):
    return tables(s, EXACT, group_table("plant", s["by_plant"]), group_table("class", s["by_class"]))
