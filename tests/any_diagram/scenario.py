"""Draws a plant with what it hides, and writes its record, diagram, experiment and truth."""

import csv
import json
import math
import pathlib
import random
import sys

import mechanical
import process
import simulate
from laws import LAWS, rms

PLANTS = (*mechanical.PLANTS, *process.PLANTS)
CLASSES = ("clean", "one", "parameter", "two", "one", "clean", "outside", "one", "three", "one_and_parameter")
HELD_OUT = 0.25
LEAST_GAIN = 50  # in -2 ln L, of a draw that counts
LEAST_SHARE, MOST_SHARE = 0.05, 0.5  # [rms of the site]
FASTEST, SLOWEST = 20, 300  # [samples] time constants of disturbances


def chosen_places(plant, kind, draw):
    outside = [p for p in plant.places if not LAWS[p.law].shapes]
    draw_from, places = [p for p in plant.places if LAWS[p.law].shapes], []
    count = {"clean": 0, "parameter": 0, "outside": 1, "one": 1, "one_and_parameter": 1, "two": 2, "three": 3}[kind]
    if kind == "outside" and outside:
        places = [draw.choice(outside)]
        draw_from = beside(places[0], draw_from)
        count = 2 if draw.random() < 0.3 else 1
    while len(places) < count and draw_from:
        place = draw.choice(draw_from)
        places.append(place)
        draw_from = beside(place, draw_from)
    return places


def beside(place, others):
    """Those that can be told from it."""
    return [p for p in others if not (p.site == place.site and have_one_name(p, place))]


def have_one_name(place, other):
    """Two laws at one port whose sum may have another name: of the same variable, distortions, or a constant that the other one contains, as
    radiation and a function without a name do."""
    laws = {place.law, other.law}
    contains_a_constant = "radiation" in laws or any(not LAWS[law].shapes for law in laws)
    return place.names == other.names or LAWS[place.law].is_distortion or ("constant" in laws and contains_a_constant)


def sized(place, nominal, memory, draw, sample_time):
    """The hidden law, so large that it has a share of the site's rms along the run without it."""
    law = LAWS[place.law]
    values = nominal.sites[place.site] if law.is_distortion else [place.signal(x, u) for x, u in zip(nominal.x, nominal.u)]
    q = law.draw(values, draw)
    if law.is_distortion:
        return simulate.Hidden(place, q, 1.0)
    share = LEAST_SHARE * (MOST_SHARE / LEAST_SHARE) ** draw.random()
    sign = place.sign or draw.choice((-1, 1))
    size = sign * share * rms(nominal.sites[place.site])
    if law.rate:  # q is a share of the displacement, z is near ±1
        return simulate.Hidden(place, q * displacement(values, sample_time), size, memory)
    return simulate.Hidden(place, q, size / rms([law.phi(v, q) for v in values]))


def displacement(speeds, sample_time):
    total, path = 0.0, []
    for v in speeds:
        total += v * sample_time
        path.append(total)
    mean = sum(path) / len(path)
    return rms([s - mean for s in path])


def disturbances(seed, noise, nominal, share):
    """A slow one at a site of noise, of this share of the signal there."""
    draw = random.Random(f"disturbance {seed}")
    site = draw.choice(sorted(noise))
    time = FASTEST * (SLOWEST / FASTEST) ** draw.random()
    return {site: simulate.Slow(share * rms(nominal.sites[site]), math.exp(-1 / time))}


def attempt(seed, retry, disturbance):
    draw = random.Random(f"any diagram {seed} {retry}")
    plant = PLANTS[seed % len(PLANTS)]()
    kind = CLASSES[seed // len(PLANTS) % len(CLASSES)]
    p = {name: value * math.exp(draw.gauss(0, 0.15) if name not in plant.fixed else 0) for name, (value, _) in plant.parameters.items()}
    stated = dict(p)
    if "parameter" in kind:
        name = draw.choice([n for n in p if n not in plant.fixed])
        stated[name] = p[name] / (1 + draw.choice((-1, 1)) * draw.uniform(0.05, 0.35))
    inputs = draw.getrandbits(32)
    nominal = simulate.run(plant, p, [], plant.drive(random.Random(inputs)), None)
    if nominal is None:
        return None
    hidden = []
    for place in chosen_places(plant, kind, draw):
        memory = len(plant.initial) + sum(e.memory >= 0 for e in hidden)
        hidden.append(sized(place, nominal, memory, draw, plant.sample_time))
    noise = {site: size * rms(nominal.sites[site]) for site, size in plant.noise.items()}
    sensor = [size * rms([x[i] - plant.initial[i] for x in nominal.x]) for size, (_, _, i) in zip(plant.sensor, plant.outputs)]
    slow = disturbances(seed, noise, nominal, disturbance) if disturbance else {}
    record = simulate.run(plant, p, hidden, plant.drive(random.Random(inputs)), draw, noise, sensor, slow)
    return record and (plant, kind, p, stated, hidden, noise, sensor, slow, record)


def diagram(plant, stated):
    return {"loopwright": 1, "title": plant.kind.replace("_", " ").capitalize(),
            "parameters": {n: {"value": stated[n], "unit": unit} for n, (_, unit) in plant.parameters.items()},
            "solver": {"method": "rk4", "step": plant.sample_time / 4, "stop": plant.sample_time * plant.rows}, "blocks": plant.blocks}


def experiment(plant):
    return {"loopwright": 1, "data": "record.csv", "time": "t",
            "drive": {port: {"column": f"u{i}", "unit": unit} for i, (port, unit) in enumerate(plant.drives)},
            "compare": {port: {"column": f"y{j}", "unit": unit} for j, (port, unit, _) in enumerate(plant.outputs)},
            "hold_out": {"fraction": HELD_OUT}}


def constants_beside_zero(plant, effect, record):
    """A dead zone that its signal never enters is a constant, at any port where a constant is the same."""
    values, port = record.sites[effect.place.site], effect.place.site
    if effect.place.law != "dead_zone" or min(values) < 0 < max(values) or min(map(abs, values)) <= effect.q:
        return []
    return [(site, "constant", "") for place in plant.places if place.law == "constant" and port in place.sites for site in place.sites]


def truth_of(seed, plant, kind, p, stated, hidden, noise, sensor, slow, record):
    fitted = int(round(plant.rows * (1 - HELD_OUT)))
    moved = {name: stated[name] / p[name] - 1 for name in p if stated[name] != p[name]}
    filter_ = simulate.Filter(plant, p, hidden, record, noise, sensor, slow)
    gained = simulate.gains(filter_, p, hidden, moved, [n for n in p if n not in plant.fixed + plant.anchor], fitted) if hidden or moved else []
    site_rms = {e.place.site: rms(record.sites[e.place.site]) for e in hidden}
    return {"seed": seed, "plant": plant.kind, "class": kind,
            "effects": [{"law": e.place.law, "shapes": e.law.shapes, "sites": e.place.sites, "variables": e.place.names,
                         "also": [*e.place.also, *constants_beside_zero(plant, e, record)],
                         "q": e.q, "size": e.size, "site_rms": site_rms[e.place.site], "gain": g, "counts": g >= LEAST_GAIN}
                        for e, g in zip(hidden, gained)],
            "parameters": [{"name": n, "stated": stated[n], "true": p[n], "gain": g, "counts": g >= LEAST_GAIN}
                           for n, g in zip(moved, gained[len(hidden):])],
            "disturbances": {site: {"size": d.size, "kept": d.kept} for site, d in slow.items()},
            "simulation": filter_.simulation_error(fitted), "outputs": [port for port, _, _ in plant.outputs]}


def write_record(path, plant, record):
    with open(path, "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["t", *(f"u{i}" for i in range(len(plant.drives))), *(f"y{j}" for j in range(len(plant.outputs)))])
        for k, (u, y) in enumerate(zip(record.u, record.y)):
            rows.writerow([f"{v:.12g}" for v in (k * plant.sample_time, *u, *y)])


def judged_attempt(seed, retry, disturbance):
    drawn = attempt(seed, retry, disturbance)
    try:
        return drawn and (drawn, truth_of(seed, *drawn))
    except simulate.Diverged:
        return None


def generate(seed, folder, disturbance=0.0):
    """`disturbance` is the size of a slow one, as a share of the signal where it acts."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    drawn, truth = next(d for d in (judged_attempt(seed, retry, disturbance) for retry in range(20)) if d)
    plant, _, _, stated, *_, record = drawn
    write_record(folder / "record.csv", plant, record)
    for name, content in {"diagram": diagram(plant, stated), "record.experiment": experiment(plant), "truth": truth}.items():
        (folder / f"{name}.json").write_text(json.dumps(content, indent=1) + "\n")
    return truth


if __name__ == "__main__":
    generate(int(sys.argv[1]), sys.argv[2])
