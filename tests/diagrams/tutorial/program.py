"""The program on the diagrams of the tutorial. LOOPWRIGHT is its path."""

import json
import os
import pathlib
import subprocess
import tempfile

import numpy
import scipy.linalg

PROGRAM = os.environ["LOOPWRIGHT"]
TUTORIAL = pathlib.Path(__file__).resolve().parents[3] / "diagrams/tutorial"


def call(*arguments):
    """The program's stdout. It must succeed."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=TUTORIAL, capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{arguments}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def setting(changes):
    return [part for change in changes for part in ("--set", change)]


class Result:
    """The rows of a run: result["motor.angle"] is an array, result.units["motor.angle"] the unit of its heading."""

    def __init__(self, text):
        heading, *rows = [line for line in text.splitlines() if line and not line.startswith("#")]
        names = [name.rstrip("]").split(" [") for name in heading.split(",")]
        self.units = {name[0]: name[1] if len(name) > 1 else "" for name in names}
        self.values = numpy.array([[float(x) for x in row.split(",")] for row in rows])
        self.index = {name[0]: i for i, name in enumerate(names)}

    def __getitem__(self, name):
        return self.values[:, self.index[name]]

    def within(self, name, first, last):
        """A signal from time `first` to `last`."""
        chosen = (self["time"] > first - 1e-9) & (self["time"] < last + 1e-9)
        return self[name][chosen]

    def at(self, name, time):
        return self[name][numpy.argmin(abs(self["time"] - time))]


def run(name, *changes):
    return Result(call("run", f"{name}.json", "--strict-units", "-q", "-o", "-", *setting(changes)))


def answer(*arguments):
    """The JSON that a command gives by --json."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "answer.json"
        call(*arguments, "--json", path)
        return json.loads(path.read_text())


def poles(name, *arguments):
    """Of the linearized diagram, ordered by their real and imaginary parts."""
    matrix = answer("linearize", f"{name}.json", *arguments)["A"]
    return numpy.sort_complex(numpy.linalg.eigvals(numpy.array(matrix)))


def exact_step(A, b, duration):
    """F and g of x(t + duration) = F x(t) + g u, for x' = A x + b u with a constant u."""
    order = len(b)
    whole = numpy.zeros((order + 1, order + 1))
    whole[:order, :order], whole[:order, order] = A, b
    step = scipy.linalg.expm(duration * whole)
    return step[:order, :order], step[:order, order]


def step_response(natural, damping, time):
    """Of ω² / (s² + 2 ζ ω s + ω²) for ζ below 1, zero before time 0."""
    t, damped = numpy.maximum(time, 0), natural * (1 - damping**2) ** 0.5
    return 1 - numpy.exp(-damping * natural * t) * (numpy.cos(damped * t) + damping * natural / damped * numpy.sin(damped * t))


def step_velocity(natural, damping, time):
    """Its derivative."""
    t, damped = numpy.maximum(time, 0), natural * (1 - damping**2) ** 0.5
    return natural**2 / damped * numpy.exp(-damping * natural * t) * numpy.sin(damped * t)
