"""Diagrams written as Python values, run by the program."""

import json
import pathlib
import subprocess
import tempfile

import numpy

program = None  # path of loopwright


def run(blocks, solver, log):
    """Columns of the recording by name, as arrays."""
    diagram = {"loopwright": 1, "solver": solver, "blocks": blocks, "log": log}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "diagram.json").write_text(json.dumps(diagram))
        done = subprocess.run([program, "run", folder / "diagram.json", "-o", folder / "out.csv"],
                              capture_output=True, text=True)
        if done.returncode != 0:
            raise AssertionError(done.stdout + done.stderr)
        lines = [line for line in (folder / "out.csv").read_text().splitlines() if not line.startswith("#")]
    names = [name.strip('" ').split(" [")[0] for name in lines[0].split(",")]
    values = numpy.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    return dict(zip(names, values.T))


def constant(value, unit="1"):
    return {"type": "Constant", "value": {"value": value, "unit": unit}}


def variable_step(method, stop, record, **more):
    return {"method": method, "stop": stop, "record_step": record, **more}


tight = {"relative_tolerance": 1e-10, "absolute_tolerance": 1e-12}
