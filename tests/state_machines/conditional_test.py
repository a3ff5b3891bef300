"""Subdiagrams that are enabled or triggered, nested and at several rates, against a simulation in plain Python."""

import csv
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

LOOPWRIGHT = sys.argv[1]
TICKS, DIAGRAMS = 60, int(os.environ.get("LOOPWRIGHT_CONDITIONS", "300"))
TICK = 0.01


class Part:
    """One subdiagram: y = gain · u, a delay, a sum, and an integrator that is sampled or continuous. It may contain another."""

    def __init__(self, chance, depth, outer_triggered, columns):
        self.triggered = chance.random() < 0.3
        self.edge = chance.choice(["rising", "falling", "either"])
        self.column = chance.choice(columns)
        self.resets_states, self.resets_outputs = chance.random() < 0.5, chance.random() < 0.5
        if self.triggered:
            self.resets_states = self.resets_outputs = False
        one_rate = self.triggered or outer_triggered
        self.every = 1 if one_rate else chance.choice([1, 2, 3])
        self.continuous = not one_rate and chance.random() < 0.5
        self.gain, self.initial = chance.choice([2.0, -0.7]), chance.choice([0.0, 1.5])
        self.inner = Part(chance, depth + 1, one_rate, columns) if depth < 2 and chance.random() < 0.5 else None
        self.restart()
        self.on, self.runs, self.last = False, False, None
        self.gained, self.delayed, self.summed, self.integral = 0.0, 0.0, 0.0, 0.0
        if self.continuous:
            self.integral = self.x
        self.shown = [0.0] * len(self.names())
        if not self.resets_outputs:
            self.shown = self.values()

    def restart(self):
        self.memory, self.x = self.initial, self.initial

    def block(self, outer):
        every = self.every * TICK
        integrator = ({"type": "Integrator"} if self.continuous else
                      {"type": "DiscreteIntegrator", "method": "forward", "sample_time": every})
        blocks = {
            "gain": {"type": "Gain", "gain": self.gain, "in": {"u": "u"}},
            "delay": {"type": "UnitDelay", "initial": self.initial, "sample_time": every, "in": {"u": "gain.y"}},
            "sum": {"type": "Sum", "in": {"terms": ["gain.y", "delay.y"]}},
            "integrator": dict(integrator, initial=self.initial, **{"in": {"u": "sum.sum"}})}
        inputs = {name: "" for name in ["u", "p", "q"]}
        outputs = {"gained": "gain.y", "delayed": "delay.y", "summed": "sum.sum", "integral": "integrator.y"}
        if self.inner:
            blocks["inner"] = self.inner.block("sum.sum")
            outputs.update({f"inner_{name}": f"inner.{name}" for name in self.inner.names()})
        entry = {"diagram": {"inputs": inputs, "blocks": blocks, "outputs": outputs},
                 "in": {"u": outer, "p": "p", "q": "q"}}
        if self.triggered:
            return dict(entry, triggered_by=self.column, edge=self.edge)
        choice = {True: "reset", False: "hold"}
        return dict(entry, enabled_by=self.column,
                    while_disabled={"states": choice[self.resets_states], "outputs": choice[self.resets_outputs]})

    def names(self):
        own = ["gained", "delayed", "summed", "integral"]
        return own + ([f"inner_{name}" for name in self.inner.names()] if self.inner else [])

    def restart_everything(self):
        self.restart()
        if self.inner:  # it starts with what contains it
            self.inner.on, self.inner.last = False, None
            self.inner.restart_everything()

    def decide(self, signals):
        """Whether its own signal lets it run, if what is around it runs."""
        before, now = self.on, signals[self.column] > 0.5
        if self.triggered:
            rises, falls = now and self.last is False, not now and self.last is True
            self.on = {"rising": rises, "falling": falls, "either": rises or falls}[self.edge]
        else:
            self.on = now
        self.last = now
        if self.on and not before and self.resets_states:
            self.restart_everything()

    def output(self, k, u, signals, surroundings_run, last=True):
        """`last`: the surroundings run, or are switched off at this instant, at which what is continuous is still computed."""
        before = self.on
        if surroundings_run:
            self.decide(signals)
        self.runs = surroundings_run and self.on
        if self.runs:
            self.gained = self.gain * u
            if k % self.every == 0:
                self.delayed = self.memory
            self.summed = self.gained + self.delayed
            if not self.continuous and k % self.every == 0:
                self.integral = self.x
        if self.continuous:
            self.integral = self.x
        if self.inner:
            self.inner.output(k, self.summed, signals, self.runs, last and (self.on or before))
        if not self.resets_outputs:
            self.shown = self.values()
        else:
            for i, (value, is_continuous) in enumerate(zip(self.values(), self.continuity())):
                if surroundings_run or (last and is_continuous):
                    self.shown[i] = value if self.on else 0.0

    def continuity(self):
        return [False, False, False, self.continuous] + (self.inner.continuity() if self.inner else [])

    def values(self):
        own = [self.gained, self.delayed, self.summed, self.integral]
        return own + (self.inner.shown if self.inner else [])

    def update(self, k):
        if self.runs and k % self.every == 0:
            self.memory = self.gained
            if not self.continuous:
                self.x = self.x + self.every * TICK * self.summed
        if self.continuous and self.runs:
            self.x = self.x + TICK * self.summed
        if self.inner:
            self.inner.update(k)


def random_columns(chance):
    logic, rows = [chance.choice([0.0, 1.0]), chance.choice([0.0, 1.0])], []
    for _ in range(TICKS + 1):
        logic = [chance.choice([0.0, 1.0]) if chance.random() < 0.3 else x for x in logic]
        rows.append([chance.choice([1.0, -0.5, chance.random()])] + logic)
    return rows


def table_of(file):
    rows = list(csv.reader(line for line in file.read_text().splitlines() if not line.startswith("#")))
    names = [name.split(" ")[0] for name in rows[0]]
    return [dict(zip(names, map(float, row))) for row in rows[1:]]


class Conditional(unittest.TestCase):
    def run_program(self, folder, diagram, label, *options):
        (folder / "diagram.json").write_text(json.dumps(diagram, indent=1))
        run = subprocess.run([LOOPWRIGHT, "run", folder / "diagram.json", "-o", folder / "out.csv", *options],
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, f"{label}:\n{run.stderr}\n{json.dumps(diagram, indent=1)}")
        return table_of(folder / "out.csv")

    def compare(self, seed, folder):
        chance = random.Random(seed)
        rows = random_columns(chance)
        lines = ["time [s],u,p,q"] + [f"{k * TICK!r}," + ",".join(map(repr, row)) for k, row in enumerate(rows)]
        (folder / "inputs.csv").write_text("\n".join(lines) + "\n")
        blocks = {f"{name}s": {"type": "RecordedColumn", "file": "inputs.csv", "column": name, "sample_time": TICK}
                  for name in "upq"}
        parts = {f"part{i}": Part(chance, 0, False, ["p", "q"]) for i in range(4)}
        for name, part in parts.items():
            entry = part.block("us.value")
            for key in ("enabled_by", "triggered_by"):
                if key in entry:
                    entry[key] += "s.value"
            blocks[name] = dict(entry, **{"in": {"u": "us.value", "p": "ps.value", "q": "qs.value"}})
        diagram = {"loopwright": 1, "solver": {"method": "euler", "step": TICK, "stop": TICKS * TICK, "record_step": TICK},
                   "blocks": blocks, "log": [f"{name}.{port}" for name, part in parts.items() for port in part.names()]}
        table = self.run_program(folder, diagram, f"seed {seed}")
        self.assertEqual(len(table), TICKS + 1)
        moved = 0
        for name, part in parts.items():
            for k in range(TICKS + 1):
                signals = dict(zip("upq", rows[k]))
                part.output(k, signals["u"], signals, True)
                found = [table[k][f"{name}.{port}"] for port in part.names()]
                self.assertEqual(found, part.shown,
                                 f"seed {seed}, {name}, tick {k}:\n{json.dumps(blocks[name], indent=1)}\n{rows[:k + 1]}")
                part.update(k)
                moved += part.runs
        return moved

    def test_random_subdiagrams(self):
        with tempfile.TemporaryDirectory() as name:
            moved = sum(self.compare(seed, pathlib.Path(name)) for seed in range(DIAGRAMS))
        self.assertGreater(moved, DIAGRAMS * TICKS)

    def resume(self, seed, folder):
        """A run that goes on from a checkpoint has the rows of the one that was not set aside, bit for bit."""
        self.compare(seed, folder)
        whole, sizes = table_of(folder / "out.csv"), []
        call = [LOOPWRIGHT, "run", folder / "diagram.json", "-q"]
        for ticks in (31, 50):  # more than half of them: there is one checkpoint
            for options in (["-o", folder / "first.csv", "--checkpoint", folder / "c", "--checkpoint-every", str((ticks - 0.5) * TICK)],
                            ["-o", folder / "rest.csv", "--resume", folder / "c"]):
                done = subprocess.run(call + options, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, f"seed {seed}: {done.stderr}")
                self.assertEqual(table_of(options[1]), whole, f"seed {seed}, after {ticks} ticks")
            sizes.append((folder / "c").stat().st_size)
        self.assertLess(*sizes, "a checkpoint has the rows until then")

    def test_a_run_that_is_resumed_has_the_same_bits(self):
        with tempfile.TemporaryDirectory() as name:
            for seed in range(min(DIAGRAMS, 25)):
                self.resume(seed, pathlib.Path(name))

    def oscillator(self, method, states, outputs):
        """sin t enables the integral of a constant, a cosine in passing, while it is above 0.3."""
        inside = {"inputs": {"v": ""}, "blocks": {
            "two": {"type": "Constant", "value": 2}, "integral": {"type": "Integrator", "initial": 1, "in": {"u": "two.y"}},
            "seen": {"type": "Gain", "gain": 3, "in": {"u": "v"}}},
            "outputs": {"integral": "integral.y", "seen": "seen.y"}}
        solver = {"method": method, "stop": 20, "record_step": 0.05}
        solver.update({"relative_tolerance": 1e-11, "absolute_tolerance": 1e-12} if method == "dopri5" else {"step": 0.001})
        return {"loopwright": 1, "solver": solver, "blocks": {
            "x": {"type": "Integrator", "in": {"u": "v.y"}},
            "v": {"type": "Integrator", "initial": 1, "in": {"u": "a.y"}},
            "a": {"type": "Gain", "gain": -1, "in": {"u": "x.y"}},
            "level": {"type": "Constant", "value": 0.3},
            "high": {"type": "Comparison", "operator": ">", "in": {"a": "x.y", "b": "level.y"}},
            "part": {"diagram": inside, "enabled_by": "high.y", "in": {"v": "v.y"},
                     "while_disabled": {"states": states, "outputs": outputs}}},
            "log": ["part.integral", "part.seen", "part.enabled"]}

    def expected(self, time, states, outputs):
        rise, fall, turn = math.asin(0.3), math.pi - math.asin(0.3), 2 * math.pi
        turns, phase = math.floor(time / turn), time % turn
        on = rise < phase < fall
        finished = turns + (phase >= fall)
        if states == "hold":
            integral = 1 + 2 * (finished * (fall - rise) + (phase - rise if on else 0))
        else:
            integral = 1 + 2 * (phase - rise) if on else 1 + 2 * (fall - rise) * (finished > 0)
        seen = 3 * math.cos(phase) if on else 3 * math.cos(fall) * (finished > 0)
        return (integral, seen, 1.0) if on else (0.0, 0.0, 0.0) if outputs == "reset" else (integral, seen, 0.0)

    def test_continuous_contents_stop_and_start_at_exact_instants(self):
        with tempfile.TemporaryDirectory() as name:
            for method, bound in (("dopri5", 2e-9), ("rk4", 7e-3)):
                for states in ("hold", "reset"):
                    for outputs in ("hold", "reset"):
                        table = self.run_program(pathlib.Path(name), self.oscillator(method, states, outputs),
                                                 f"{method} {states} {outputs}")
                        for row in table:
                            found = row["part.integral"], row["part.seen"], row["part.enabled"]
                            for a, b in zip(found, self.expected(row["time"], states, outputs)):
                                self.assertLess(abs(a - b), bound, (method, states, outputs, row))

    def test_rows_do_not_change_what_is_held(self):
        """A signal that only a row reads is the same whether few or many rows are recorded."""
        with tempfile.TemporaryDirectory() as name:
            for method in ("dopri5", "rk4"):
                diagram = self.oscillator(method, "hold", "hold")
                many = self.run_program(pathlib.Path(name), diagram, "many")
                diagram["solver"]["record_step"] = 5
                few = self.run_program(pathlib.Path(name), diagram, "few")
                self.assertEqual(few, many[::100])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
