#!/usr/bin/env python3
"""Synchronized axes against an independent computation: synchronized_test.py PROGRAM.

Three axes follow a target and, on the way, another one. Here the cruising velocity of every axis is found on a dense grid
and by scipy's brentq, and the common time among the ends of the possible ones.
"""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

PROGRAM = sys.argv.pop(1)
GROUPS, AXES = 400, 3
STEP = 0.05


def change(v, a, end, limits):
    """Pieces (time, acceleration, jerk) of the fastest change of velocity to one without acceleration."""
    most, jerk = limits[1:]
    sign = 1.0 if end >= v + a * abs(a) / (2 * jerk) else -1.0
    gain = sign * (end - v)
    peak = np.sqrt(max(0.0, jerk * gain + a * a / 2))
    hold = 0.0
    if peak > most:
        hold, peak = (gain - (2 * most**2 - a * a) / (2 * jerk)) / most, most
    return [((peak - sign * a) / jerk, a, sign * jerk), (hold, sign * peak, 0.0), (peak / jerk, sign * peak, -sign * jerk)]


def moved(pieces, v):
    x = 0.0
    for t, a, j in pieces:
        x, v = x + v * t + a * t**2 / 2 + j * t**3 / 6, v + a * t + j * t**2 / 2
    return x


class Axis:
    def __init__(self, state, target, limits):
        self.state, self.target, self.limits = state, target, limits
        self.grid = np.unique(np.concatenate([np.linspace(-limits[0], limits[0], 801), self.corners()]))
        self.parts = [self.part(c) for c in self.grid]
        self.bounds = list(self.times())

    def corners(self):
        (_, v, a), (most, acceleration, jerk) = self.state, self.limits
        middle = v + a * abs(a) / (2 * jerk)
        wanted = [0, v, middle] + [b + s * d for s in (-1, 1) for b, d in
                                   ((v, (acceleration**2 - a * a / 2) / jerk), (0, acceleration**2 / jerk))]
        return np.clip(wanted, -most, most)

    def part(self, c):
        """Time and distance of both changes with the cruising velocity c."""
        first, last = change(*self.state[1:], c, self.limits), change(0.0, 0.0, c, self.limits)
        return sum(p[0] for p in first + last), moved(first, self.state[1]) + moved(last, 0.0)

    def left(self, c):
        return self.target - self.state[0] - self.part(c)[1]

    def times(self):
        """Where possible times may begin, each with its cruising velocity."""
        for c in (-self.limits[0], self.limits[0]):
            if self.left(c) / c >= 0:
                yield self.part(c)[0] + self.left(c) / c, c
        left = [self.target - self.state[0] - d for _, d in self.parts]
        for k in range(len(self.grid) - 1):
            if left[k] == 0 or left[k] * left[k + 1] < 0:
                c = self.grid[k] if left[k] == 0 else brentq(self.left, self.grid[k], self.grid[k + 1], xtol=1e-16)
                yield self.part(c)[0], c

    def cruise(self, time, slack=1e-9):
        """The cruising velocity for a time, or None."""
        def over(c):
            t, d = self.part(c)
            return self.state[0] + d + (time - t) * c - self.target
        best = next((c for own, c in self.bounds if own == time), None)
        if best is not None:
            return best
        values = [self.state[0] + d + (time - t) * c - self.target for c, (t, d) in zip(self.grid, self.parts)]
        fits = [t <= time + slack for t, _ in self.parts]
        for k in range(len(self.grid)):
            if abs(values[k]) < 1e-11 and fits[k]:
                return self.grid[k]
            if k + 1 < len(self.grid) and values[k] * values[k + 1] < 0 and (fits[k] or fits[k + 1]):
                c = brentq(over, self.grid[k], self.grid[k + 1], xtol=1e-16)
                if self.part(c)[0] <= time + slack:
                    best = c
        return best

    def at(self, t, time, c):
        """The state at a time t of the motion that takes `time`."""
        first = change(*self.state[1:], c, self.limits)
        last = [(d, -(a + j * d), j) for d, a, j in reversed(change(0.0, 0.0, c, self.limits))]
        x, v, a = self.state
        for d, a0, j in first + [(time - self.part(c)[0], 0.0, 0.0)] + last:
            s = min(t, max(d, 0.0))
            x, v, a = x + v * s + a0 * s**2 / 2 + j * s**3 / 6, v + a0 * s + j * s**2 / 2, a0 + j * s
            t -= s
            if t <= 0:
                return x, v, a
        return self.target, 0.0, 0.0


def common(axes):
    fastest = [min(axis.bounds)[0] for axis in axes]
    for time in sorted(t for axis in axes for t, _ in axis.bounds if t >= max(fastest)):
        cruises = [axis.cruise(time) for axis in axes]
        if None not in cruises:
            return time, cruises
    raise AssertionError('no common time')


class SynchronizedMotion(unittest.TestCase):
    def test_follows_the_reference_from_rest_and_on_the_way(self):
        random = np.random.default_rng(4)
        blocks, groups = {}, []
        for g in range(GROUPS):
            limits = 10 ** random.uniform(-0.7, 0.7, (AXES, 3))
            first, second = random.uniform(-2, 2, (2, AXES))
            at = STEP * int(random.integers(2, 30))
            groups.append((limits, first, second, at))
            for i in range(AXES):
                blocks[f't{g}_{i}'] = {'type': 'Step', 'time': at, 'before': first[i], 'after': second[i]}
            blocks[f'all{g}'] = {'type': 'Pack', 'in': {'elements': [f't{g}_{i}.y' for i in range(AXES)]}}
            blocks[f'p{g}'] = {'type': 'SynchronizedMotion', 'sample_time': STEP, 'in': {'target': f'all{g}.y'},
                               'velocity': list(limits[:, 0]), 'acceleration': list(limits[:, 1]), 'jerk': list(limits[:, 2])}
        diagram = {'loopwright': 1, 'solver': {'step': STEP, 'stop': 6, 'record_step': STEP}, 'blocks': blocks,
                   'log': [f'p{g}.position' for g in range(GROUPS)]}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / 'd.json'
            path.write_text(json.dumps(diagram))
            subprocess.run([PROGRAM, 'run', path, '-o', Path(folder) / 'r.csv', '-q'], check=True, capture_output=True)
            rows = np.genfromtxt(Path(folder) / 'r.csv', delimiter=',', comments='#', skip_header=0)
        rows = rows[~np.isnan(rows).any(axis=1)]
        self.assertEqual(rows.shape[1], 1 + GROUPS * AXES)
        moving = 0
        for g, (limits, first, second, at) in enumerate(groups):
            axes = [Axis((0.0, 0.0, 0.0), first[i], tuple(limits[i])) for i in range(AXES)]
            time, cruises = common(axes)
            states = [axis.at(at, time, c) for axis, c in zip(axes, cruises)]
            then = [Axis(states[i], second[i], tuple(limits[i])) for i in range(AXES)]
            later, second_cruises = common(then)
            moving += at < time
            for i in range(AXES):
                for row in rows[::7]:
                    t = row[0]
                    expected = (axes[i].at(t, time, cruises[i]) if t < at else then[i].at(t - at, later, second_cruises[i]))[0]
                    self.assertAlmostEqual(row[1 + g * AXES + i], expected, delta=2e-8, msg=f'group {g}, axis {i}, {t} s')
        self.assertGreater(moving, GROUPS / 2)


if __name__ == '__main__':
    unittest.main()
