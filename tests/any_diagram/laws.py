"""What a plant may hide: laws of one signal, with the shapes of the product's answer that name them.

A law is phi(s, q): s the signal, q its own parameter, drawn from the signal's values along a run without it. `shapes` are the names that are
right; a law without any is outside the catalogue. A law with memory has a rate of its own state z instead: z' = rate(z, s), phi = z.
"""

import dataclasses
import math
from collections.abc import Callable


@dataclasses.dataclass(frozen=True)
class Law:
    phi: Callable
    shapes: tuple = ()
    draw: Callable = lambda values, random: 0.0
    rate: Callable = None  # of a law with memory: z' = rate(z, s, q)
    is_distortion: bool = False  # phi(s, q) is added to the signal s itself, at its own size
    has_front: bool = False  # it changes its side while s goes through zero, within some q


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def quantile(values, part):
    return sorted(values)[int(part * (len(values) - 1))]


def span(values):
    return max(values) - min(values)


def largest(values):
    return max(abs(v) for v in values)


def clipped(s, q):
    return max(-q, min(q, s))


def bump(s, q):
    x = (s - q[0]) / q[1]
    return math.exp(-x * x)


LAWS = {
    "constant": Law(lambda s, q: 1.0, ("constant",)),
    "linear": Law(lambda s, q: s, ("linear",)),
    "sign": Law(lambda s, q: math.tanh(s / q), ("sign",), lambda v, r: 0.01 * rms(v), has_front=True),
    "signed_square": Law(lambda s, q: s * abs(s), ("signed_square",)),
    "square": Law(lambda s, q: s * s, ("square",)),
    "cube": Law(lambda s, q: s**3, ("cube",)),
    "periodic": Law(lambda s, q: math.sin(2 * math.pi * s / q[0] + q[1]), ("periodic",),
                    lambda v, r: (span(v) / r.uniform(2, 20), r.uniform(0, 6.28))),
    "overflow": Law(lambda s, q: max(0.0, s - q), ("overflow",), lambda v, r: quantile(v, r.uniform(0.5, 0.85))),
    "square_root": Law(lambda s, q: math.copysign(math.sqrt(abs(s)), s), ("square_root",)),
    "soft_sign": Law(lambda s, q: math.tanh(s / q), ("soft_sign",), lambda v, r: r.uniform(0.2, 0.6) * rms(v)),
    "radiation": Law(lambda s, q: (s / 300) ** 4 - (q / 300) ** 4, ("radiation",), lambda v, r: 293.0),
    "convection": Law(lambda s, q: math.copysign(abs(s) ** 1.25, s), ("convection",)),
    "saturation": Law(lambda s, q: clipped(s, q) - s, ("saturation",), lambda v, r: r.uniform(0.45, 0.85) * largest(v), is_distortion=True),
    "dead_zone": Law(lambda s, q: -clipped(s, q), ("dead_zone",), lambda v, r: r.uniform(0.03, 0.2) * largest(v), is_distortion=True),
    # Dahl's friction: z goes to 1 or -1 over displacements of the size q; s is the velocity.
    "hysteresis": Law(None, ("hysteresis",), lambda v, r: r.uniform(0.05, 0.3), rate=lambda z, s, q: (s - abs(s) * z) / q),
    # Outside the catalogue: the site and the variable can be found, a name cannot.
    "bump": Law(bump, (), lambda v, r: (quantile(v, r.uniform(0.3, 0.7)), r.uniform(0.1, 0.2) * span(v))),
    "beats": Law(lambda s, q: math.sin(s / q) + math.sin(1.37 * s / q), (), lambda v, r: r.uniform(0.05, 0.15) * span(v)),
}
