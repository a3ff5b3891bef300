"""A plant: its equations, and the diagram by which a user would describe it without what is hidden."""

import dataclasses
import math
from collections.abc import Callable


@dataclasses.dataclass(frozen=True)
class Place:
    """A law that the plant may hide. `signal(x, u)` is its variable; `names` are names of the variable, `sites` those of the port, that are
    right: the same law of motion can often be written in several ways. `sign` is 0 where both directions make sense."""
    law: str
    sites: tuple
    names: tuple
    signal: Callable
    sign: int = -1
    also: tuple = ()  # further answers that state the same law: (site, shape, variable)

    @property
    def site(self):
        return self.sites[0]


@dataclasses.dataclass(frozen=True)
class Plant:
    kind: str
    parameters: dict  # name: (value, unit)
    blocks: dict
    drives: tuple  # (port, unit), columns u0, u1 …
    outputs: tuple  # (port, unit, index of the state), columns y0, y1 …
    initial: tuple
    rate: Callable  # (x, u, p, at) -> list; at(port, value) returns the value with what is hidden there
    drive: Callable  # (random) -> (t, y) -> list
    sample_time: float
    places: tuple
    noise: dict  # [rms of the port] process noise, held over a sample
    sensor: tuple  # [rms of the output] white noise
    rows: int = 2400
    substeps: int = 8
    fixed: tuple = ()  # parameters that are never wrong: only others tell them apart
    anchor: tuple = ()  # a parameter that fixes the scale, where all together could be scaled with what is hidden


def steps(random, hold, size, offset=0.0):
    """Random levels, each held for a while; a function of time."""
    levels = [random.uniform(-1, 1) for _ in range(4096)]
    return lambda t: offset + size * levels[int(t / hold + 1e-9) % len(levels)]


def tones(random, low, high, size, count=12):
    parts = [(low * (high / low) ** random.random(), random.uniform(0, 2 * math.pi)) for _ in range(count)]
    return lambda t: size / count**0.5 * sum(math.sin(2 * math.pi * f * t + phase) for f, phase in parts)


def quantity(value, unit):
    return {"value": value, "unit": unit}


def total(signs, *terms):
    return {"type": "Sum", "signs": signs, "in": {"terms": list(terms)}}


def gain(value, source):
    return {"type": "Gain", "gain": value, "in": {"u": source}}


def formula(text, **names):
    return {"type": "Expression", "formula": text, "names": list(names), "in": {"arguments": list(names.values())}}


def mass(parameter, force):
    return {"type": "Mass", "mass": parameter, "in": {"force": force}}


def integral(source, unit=None, initial=0):
    return {"type": "Integrator", "in": {"u": source}, **({"initial": quantity(initial, unit)} if unit else {})}


def viscous(parameter, velocity):
    return {"type": "ViscousFriction", "damping": parameter, "in": {"velocity": velocity}}


def source(unit):
    """What the record replaces, and the gain of one in front of which it does so."""
    return {"type": "Constant", "value": quantity(0, unit)}
