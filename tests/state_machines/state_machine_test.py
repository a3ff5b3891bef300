"""Thousands of random state machines give the states and outputs of a plain interpreter, bit for bit."""

import csv
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

from reference import Machine

LOOPWRIGHT = sys.argv[1]
SAMPLES, MACHINES, DIAGRAMS = 80, 40, int(os.environ.get("LOOPWRIGHT_MACHINES", "2400")) // 40
PARAMETERS = {"level": 0.3, "wait": 4.0}


class Guards:
    """Random guards, as text and as functions of inputs and of the time since the state was entered."""

    def __init__(self, chance, inputs, period):
        self.chance, self.inputs, self.period = chance, inputs, period

    def number(self, depth=0):
        kind = self.chance.randrange(6 if depth < 2 else 4)
        if kind < 2:
            name = self.chance.choice(self.inputs)
            return name, lambda x, t: x[name]
        if kind == 2:
            value = self.chance.choice([0, 0.25, 0.5, 1, 0.1])
            return repr(value), lambda x, t: value
        if kind == 3:
            return "level", lambda x, t: PARAMETERS["level"]
        (a, f), (b, g) = self.number(depth + 1), self.number(depth + 1)
        if kind == 4:
            return f"({a} + {b})", lambda x, t: f(x, t) + g(x, t)
        return f"{a} * {b}", lambda x, t: f(x, t) * g(x, t)

    def comparison(self):
        (a, f), (b, g) = self.number(), self.number()
        return self.chance.choice([
            (f"{a} > {b}", lambda x, t: f(x, t) > g(x, t)), (f"{a} < {b}", lambda x, t: f(x, t) < g(x, t)),
            (f"{a} >= {b}", lambda x, t: f(x, t) >= g(x, t)), (f"{a} <= {b}", lambda x, t: f(x, t) <= g(x, t)),
            (f"{a} == {b}", lambda x, t: f(x, t) == g(x, t)), (f"{a} != {b}", lambda x, t: f(x, t) != g(x, t))])

    def after(self):
        samples = self.chance.randrange(7)
        seconds = self.chance.choice([samples * self.period, (samples + 0.5) * self.period])
        choice = self.chance.randrange(4)
        if choice == 0:
            return f"after({seconds!r} s)", lambda x, t: has_passed(t, seconds)
        if choice == 1:
            return f"after( {1000 * seconds!r} ms )", lambda x, t: has_passed(t, 1000 * seconds * 1e-3)
        if choice == 2:
            return f"after({seconds!r})", lambda x, t: has_passed(t, seconds)
        return "after(2*wait/2)", lambda x, t: has_passed(t, 2 * PARAMETERS["wait"] / 2)

    def truth(self, depth=0):
        kind = self.chance.randrange(8 if depth < 3 else 4)
        if kind < 2:
            return self.comparison()
        if kind == 2:
            return self.after()
        if kind == 3:
            name = self.chance.choice(self.inputs)
            return f"{name} > 0.5", lambda x, t: x[name] > 0.5
        (a, f), (b, g) = self.truth(depth + 1), self.truth(depth + 1)
        if kind < 6:
            return f"({a}) && ({b})", lambda x, t: f(x, t) and g(x, t)
        return f"({a}) || ({b})", lambda x, t: f(x, t) or g(x, t)


def has_passed(elapsed, duration):
    return elapsed * (1 + 2.0**-50) >= duration


def random_machine(chance, inputs, period):
    guards, functions = Guards(chance, inputs, period), {}
    names = [f"s{i}" for i in range(chance.randrange(1, 9))]
    outputs = [f"y{i}" for i in range(chance.randrange(0, 4))]
    states = []
    for i, name in enumerate(names):
        state = {"name": name}
        if i and chance.random() < 0.5:
            state["inside"] = chance.choice(names[:i])
        if outputs and chance.random() < 0.8:
            some = chance.sample(outputs, chance.randrange(1, len(outputs) + 1))
            state["set"] = {output: chance.choice([0, 1, -0.1, chance.uniform(-5, 5)]) for output in some}
        transitions = []
        for t in range(chance.randrange(4)):
            transition = {"to": chance.choice(names)}
            if chance.random() < 0.95:
                transition["when"], functions[name, t] = guards.truth()
            else:
                functions[name, t] = lambda x, waited: True
            transitions.append(transition)
        if transitions:
            state["transitions"] = transitions
            if chance.random() < 0.4:
                for transition, priority in zip(transitions, chance.sample(range(1, 9), len(transitions))):
                    transition["priority"] = priority
        states.append(state)
    for state in states:
        inside = [other["name"] for other in states if other.get("inside") == state["name"]]
        if inside and chance.random() < 0.5:
            state["initial"] = chance.choice(inside)
    settings = {"type": "StateMachine", "sample_time": period, "inputs": inputs,
                "outputs": [{"name": name} for name in outputs], "states": states}
    outermost = [state["name"] for state in states if "inside" not in state]
    if chance.random() < 0.5:
        settings["initial"] = chance.choice(outermost)
    if chance.random() < 0.3:
        chance.shuffle(states)  # a state may stand before the one that contains it
    return settings, functions


def random_inputs(chance):
    rows, row = [], [0.0, 0.0, 0.0]
    for _ in range(SAMPLES + 1):
        row = [chance.choice([0, 1, 0.3, 0.5, chance.random()]) if chance.random() < 0.4 else x for x in row]
        rows.append([float(x) for x in row])
    return rows


class RandomMachines(unittest.TestCase):
    def compare(self, seed, folder):
        chance = random.Random(seed)
        period = chance.choice([1, 0.25, 0.1, 0.001])
        rows, inputs = random_inputs(chance), ["a", "b", "c"]
        lines = ["time [s],a,b,c"] + [f"{k * period!r}," + ",".join(map(repr, row)) for k, row in enumerate(rows)]
        (folder / "inputs.csv").write_text("\n".join(lines) + "\n")
        blocks = {name: {"type": "RecordedColumn", "file": "inputs.csv", "column": name, "sample_time": period}
                  for name in inputs}
        machines = {}
        for m in range(MACHINES):
            settings, functions = random_machine(chance, inputs, period)
            machines[f"m{m}"] = settings, functions
            blocks[f"m{m}"] = dict(settings, **{"in": {name: f"{name}.value" for name in inputs}})
        diagram = {"loopwright": 1, "parameters": {"level": PARAMETERS["level"],
                                                   "wait": {"value": PARAMETERS["wait"], "unit": "s"}},
                   "solver": {"stop": SAMPLES * period, "record_step": period}, "blocks": blocks,
                   "log": [f"{name}.*" for name in machines]}
        (folder / "diagram.json").write_text(json.dumps(diagram, indent=1))
        run = subprocess.run([LOOPWRIGHT, "run", folder / "diagram.json", "-o", folder / "out.csv"], capture_output=True,
                             text=True)
        self.assertEqual(run.returncode, 0, f"seed {seed}:\n{run.stderr}")
        lines = (folder / "out.csv").read_text().splitlines()
        table = list(csv.reader(line for line in lines if not line.startswith("#")))
        column = {name.split(" ")[0]: i for i, name in enumerate(table[0])}
        self.assertEqual(len(table), SAMPLES + 2)
        changes = 0
        for name, (settings, functions) in machines.items():
            outputs = [output["name"] for output in settings["outputs"]]
            reference = Machine(settings["states"], outputs, settings.get("initial"),
                                lambda state, t, x, samples: functions[state, t](x, samples * period))
            last = None
            for k, row in enumerate(table[1:]):
                expected = reference.sample(dict(zip(inputs, rows[k])))
                found = [float(row[column[f"{name}.{port}"]]) for port in ["state"] + outputs]
                self.assertEqual(found, expected, f"seed {seed}, {name}, sample {k}:\n{json.dumps(settings, indent=1)}")
                changes += last is not None and expected != last
                last = expected
        return changes

    def test_against_the_interpreter(self):
        changes = 0
        with tempfile.TemporaryDirectory() as name:
            for seed in range(DIAGRAMS):
                changes += self.compare(seed, pathlib.Path(name))
        self.assertGreater(changes, 5 * DIAGRAMS * MACHINES, "the machines hardly move")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
