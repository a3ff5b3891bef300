"""Runs of a plant with what it hides: integration, noise, and what a record can tell about it at best."""

import dataclasses
import math

import numpy as np

from laws import LAWS

MOST_STATE = 1e9  # of any state, in its unit: more is a divergence
REACH_OF_FRONT = 4  # [q] beyond it a tanh(s/q) is constant within a thousandth
STEPS_AT_FRONT = 16  # [of a step] where a law changes its side: dry friction does so within less than a step


@dataclasses.dataclass
class Hidden:
    """A law at its place, with its own parameter, size and, if it has memory, the index of its state."""
    place: object
    q: object
    size: float
    memory: int = -1

    @property
    def law(self):
        return LAWS[self.place.law]


class Ports:
    """What is hidden at the ports of a plant, and the noise there."""

    def __init__(self, hidden):
        self.at = {}
        for effect in hidden:
            self.at.setdefault(effect.place.site, []).append(effect)
        self.x, self.u, self.noise, self.seen = None, None, {}, None

    def __call__(self, port, value):
        if self.seen is not None:
            self.seen.setdefault(port, []).append(value)
        added = self.noise.get(port, 0.0)
        for effect in self.at.get(port, ()):
            added += effect.size * self.value(effect, value)
        return value + added

    def value(self, effect, own):
        if effect.law.is_distortion:
            return effect.law.phi(own, effect.q)
        if effect.memory >= 0:
            return self.x[effect.memory]
        return effect.law.phi(effect.place.signal(self.x, self.u), effect.q)


class Motion:
    """The plant with parameters `p` and what it hides, from one row to the next."""

    def __init__(self, plant, p, hidden, substeps):
        self.plant, self.p, self.hidden, self.substeps = plant, p, list(hidden), substeps
        self.ports = Ports(self.hidden)
        self.with_memory = [e for e in self.hidden if e.memory >= 0]
        self.with_front = [e for e in self.hidden if e.law.has_front]

    def initial(self):
        return [*self.plant.initial, *(0.0 for _ in self.with_memory)]

    def rate(self, x, u):
        self.ports.x, self.ports.u = x, u
        slope = self.plant.rate(x, u, self.p, self.ports)
        for e in self.with_memory:
            slope.append(e.law.rate(x[e.memory], e.place.signal(x, u), e.q))
        return slope

    def flow(self, x, u):
        h = self.plant.sample_time / self.substeps
        for _ in range(self.substeps):
            there = self.step(x, u, h)
            if self.meets_front(x, there, u):
                there = x
                for _ in range(STEPS_AT_FRONT):
                    there = self.step(there, u, h / STEPS_AT_FRONT)
            x = there
        return x

    def step(self, x, u, h):
        a = self.rate(x, u)
        b = self.rate([s + h / 2 * r for s, r in zip(x, a)], u)
        c = self.rate([s + h / 2 * r for s, r in zip(x, b)], u)
        d = self.rate([s + h * r for s, r in zip(x, c)], u)
        return [s + h / 6 * (i + 2 * j + 2 * k + l) for s, i, j, k, l in zip(x, a, b, c, d)]

    def meets_front(self, x, there, u):
        for e in self.with_front:
            begin, end = e.place.signal(x, u), e.place.signal(there, u)
            if begin * end <= 0 or min(abs(begin), abs(end)) < REACH_OF_FRONT * e.q:
                return True
        return False


@dataclasses.dataclass
class Slow:
    """A disturbance at a port that is alike for many rows: d ← kept d + white noise, with the standard deviation `size`."""
    size: float
    kept: float

    @property
    def step(self):
        return self.size * math.sqrt(1 - self.kept**2)


@dataclasses.dataclass
class Record:
    u: list
    y: list
    x: list
    sites: dict  # values at the ports, at the rows


def run(plant, p, hidden, drive, random, process=None, sensor=None, slow=None):
    """`process` and `sensor` are absolute; without them there is no noise. `slow` are disturbances, by port."""
    motion = Motion(plant, p, hidden, plant.substeps)
    disturbed = {site: random.gauss(0, s.size) for site, s in (slow or {}).items()}
    x, record = motion.initial(), Record([], [], [], {})
    for k in range(plant.rows):
        y = [x[i] + (random.gauss(0, sensor[j]) if sensor else 0.0) for j, (_, _, i) in enumerate(plant.outputs)]
        u = drive(k * plant.sample_time, y)
        record.u.append(u), record.y.append(y), record.x.append(x)
        motion.ports.noise, motion.ports.seen = {}, record.sites
        motion.rate(x, u)
        motion.ports.seen = None
        if process:
            motion.ports.noise = {site: random.gauss(0, size) for site, size in process.items()}
        for site, d in disturbed.items():
            motion.ports.noise[site] = motion.ports.noise.get(site, 0.0) + d
            disturbed[site] = slow[site].kept * d + random.gauss(0, slow[site].step)
        try:
            x = motion.flow(x, u)
        except OverflowError:  # within the step
            return None
        if not all(math.isfinite(s) and abs(s) < MOST_STATE for s in x):
            return None
    return record


class Diverged(Exception):
    """Of the filter with the true equations: what the record shows of them cannot be measured."""


class Filter:
    """An extended Kalman filter with the true equations, whose last states are the slow disturbances; its gains serve all responses."""

    def __init__(self, plant, p, hidden, record, process, sensor, slow=None):
        self.plant, self.record, self.sensor, self.slow = plant, record, np.array(sensor), slow or {}
        self.process, self.index = process, [i for _, _, i in plant.outputs]
        self.substeps = max(2, plant.substeps // 2)
        self.motion = Motion(plant, p, hidden, self.substeps)
        self.run()

    def run(self):
        motion, record = self.motion, self.record
        scale, sizes = np.std(np.array(record.x), axis=0) + 1e-12, [s.size for s in self.slow.values()]
        P, x = np.diag(np.concatenate([(0.1 * scale) ** 2, np.square(sizes)])), self.beginning(motion)
        n = len(x)
        C = np.zeros((len(self.index), n))
        for j, i in enumerate(self.index):
            C[j, i] = 1
        R = np.diag(self.sensor**2)
        self.gains, self.roots, self.filtered, self.errors = [], [], [], []
        for u, y in zip(record.u, record.y):
            e = np.array(y) - x[self.index]
            S = C @ P @ C.T + R
            K = P @ C.T @ np.linalg.inv(S)
            root = np.linalg.inv(np.linalg.cholesky(S))
            self.gains.append(K), self.roots.append(root), self.errors.append(e)
            x = x + K @ e
            P = P - K @ S @ K.T
            self.filtered.append(x)
            P, x = self.predicted(P, x, u, scale)
            if not np.all(np.abs(x) < MOST_STATE):
                raise Diverged

    def beginning(self, motion):
        return np.array([*motion.initial(), *(0.0 for _ in self.slow)])

    def flow(self, motion, x, u, more=None):
        """The next states; `more` is the noise within this sample, by port."""
        own = len(x) - len(self.slow)
        motion.ports.noise = dict(zip(self.slow, x[own:]))
        for site, size in (more or {}).items():
            motion.ports.noise[site] = motion.ports.noise.get(site, 0.0) + size
        try:
            there = motion.flow(list(map(float, x[:own])), u)
        except OverflowError:  # within the step
            raise Diverged from None
        motion.ports.noise = {}
        return np.array([*there, *(s.kept * d for s, d in zip(self.slow.values(), x[own:]))])

    def predicted(self, P, x, u, scale):
        motion = self.motion
        there = self.flow(motion, x, u)
        A = np.empty((len(x), len(x)))
        steps = [*(1e-6 * scale), *(s.size for s in self.slow.values())]
        for i, step in enumerate(steps):
            moved = x.copy()
            moved[i] += step
            A[:, i] = (self.flow(motion, moved, u) - there) / step
        P = A @ P @ A.T
        for site, size in self.process.items():
            G = self.flow(motion, x, u, {site: size}) - there
            P = P + np.outer(G, G)
        P = P + np.diag([*(0.0 for _ in scale), *(s.step**2 for s in self.slow.values())])
        return (P + P.T) / 2, there

    def whitened(self, p, hidden, rows):
        """The errors of another model with these gains."""
        motion = Motion(self.plant, p, hidden, self.substeps)
        x, list_ = self.beginning(motion), []
        for k in range(rows):
            e = np.array(self.record.y[k]) - x[self.index]
            list_.append(self.roots[k] @ e)
            x = self.flow(motion, x + self.gains[k] @ e, self.record.u[k])
        return np.concatenate(list_)

    def simulation_error(self, first, parts=10):
        """rms for each output, begun anew from the filtered state `parts` times."""
        rows, squares = len(self.record.y), []
        length = (rows - first) // parts + 1
        for begin in range(first, rows, length):
            x = list(map(float, self.filtered[begin][:len(self.motion.initial())]))
            for k in range(begin, min(rows, begin + length)):
                squares.append([(self.record.y[k][j] - x[i]) ** 2 for j, i in enumerate(self.index)])
                x = self.motion.flow(x, self.record.u[k])
        return [float(s) for s in np.sqrt(np.mean(squares, axis=0))]


def gains(filter_, p, hidden, moved, others, rows):
    """In -2 ln L: what each hidden law and moved parameter gains, with all other tunable parameters fitted in its absence. Linearized."""
    base = filter_.whitened(p, hidden, rows)
    step = 1e-5

    def without(i):
        less = [dataclasses.replace(e, size=e.size * (1 - step)) if k == i else e for k, e in enumerate(hidden)]
        return (filter_.whitened(p, less, rows) - base) / step

    def changed(name):
        return (filter_.whitened(p | {name: p[name] * (1 + step)}, hidden, rows) - base) / step

    of_laws = [without(i) for i in range(len(hidden))]
    of_parameters = {name: changed(name) for name in {*others, *moved}}
    result = []
    for i, column in enumerate(of_laws):
        result.append(left_of(column, [c for k, c in enumerate(of_laws) if k != i] + list(of_parameters.values())))
    for name, change in moved.items():
        rest = of_laws + [c for k, c in of_parameters.items() if k != name]
        result.append(change**2 * left_of(of_parameters[name], rest))
    return result


def left_of(column, others):
    others = [c / np.linalg.norm(c) for c in others if np.linalg.norm(c) > 0]
    if others:
        basis = np.array(others).T
        column = column - basis @ np.linalg.lstsq(basis, column, rcond=1e-5)[0]
    return float(column @ column)
