"""A scenario of the conditions benchmark: the generator's record and truth, and the diagram and experiment of a user who knows only what
the diagram contains.

    scenario.py GENERATOR SEED FOLDER [--quiet] [CONDITION [EFFECT…]]
"""

import json
import math
import pathlib
import subprocess
import sys

LINEAR = {"position": "m", "velocity": "m/s", "force": "N", "mass": "kg", "damping": "N*s/m", "stiffness": "N/m"}
ROTARY = {"position": "rad", "velocity": "rad/s", "force": "N*m", "mass": "kg*m^2", "damping": "N*m*s/rad", "stiffness": "N*m/rad"}


def quantity(value, unit):
    return {"value": value, "unit": unit}


def summed(terms):
    """A Sum of signed wires, ["+force", "-viscous.force"]."""
    return {"type": "Sum", "signs": "".join(t[0] for t in terms), "in": {"terms": [t[1:] for t in terms]}}


def resisting(machine, units):
    """The blocks of the laws that a diagram may contain, and their terms in the sum of forces on `carriage`."""
    blocks = {"viscous": {"type": "ViscousFriction", "damping": quantity(machine["damping"], units["damping"]),
                          "in": {"velocity": "carriage.velocity"}}}
    terms = ["-viscous.force"]
    if "cogging" in machine:
        wave = machine["cogging"]
        blocks["cogging"] = {"type": "CoggingForce", "pole_pitch": quantity(wave["pitch"], units["position"]),
                             "harmonics": [{"order": 1, "amplitude": quantity(wave["amplitude"], units["force"]),
                                            "phase": wave["phase"]}],
                             "in": {"position": "carriage.position"}}
        terms.append("-cogging.force")
    if "gravity" in machine:
        blocks["gravity"] = {"type": "ConstantForce", "level": quantity(machine["gravity"], units["force"])}
        terms.append("-gravity.force")
    if "stribeck" in machine:
        law = machine["stribeck"]
        blocks["friction"] = {"type": "PreslidingFriction", "level": quantity(law["level"], units["force"]),
                              "static_level": quantity(law["static_level"], units["force"]),
                              "stribeck_speed": quantity(law["speed"], units["velocity"]),
                              "transition_distance": quantity(machine["transition"], units["position"]),
                              "in": {"position": "carriage.position", "velocity": "carriage.velocity"}}
        terms.append("-friction.force")
    return blocks, terms


def coupling(motor, load, law, units):
    ends = {f"{end}_{what}": f"{block}.{what}" for end, block in (("motor", motor), ("load", load)) for what in ("position", "velocity")}
    return {"type": "ElasticCoupling", "stiffness": quantity(law["stiffness"], units["stiffness"]),
            "damping": quantity(law["damping"], units["damping"]), "in": ends}


def axis_blocks(machine, motor, units, source):
    """The blocks of an axis whose motor is driven by the wire `source`: a force, or a voltage if there is a motor."""
    blocks, terms = resisting(machine, units)
    force = source
    if motor:
        constant = motor["constant"]
        if units is ROTARY:
            per_speed, per_current = "V*s/rad", "N*m/A"
        else:
            per_speed, per_current = "V*s/m", "N/A"
        # The damping of the truth contains that of the back-EMF.
        blocks["viscous"]["damping"]["value"] -= constant**2 / motor["resistance"]
        blocks["back_emf"] = {"type": "Gain", "gain": quantity(constant, per_speed), "in": {"u": "carriage.velocity"}}
        blocks["voltage_drop"] = summed(["+" + source, "-back_emf.y"])
        blocks["current"] = {"type": "Gain", "gain": quantity(1 / motor["resistance"], "A/V"), "in": {"u": "voltage_drop.sum"}}
        blocks["magnets"] = {"type": "Gain", "gain": quantity(constant, per_current), "in": {"u": "current.y"}}
        force = "magnets.y"
    if "motor" in machine:  # it drives the carriage through a spring
        blocks["coupling"] = coupling("rotor", "carriage", machine["motor"], units)
        blocks["rotor_force"] = summed(["+" + force, "-coupling.force"])
        blocks["rotor"] = {"type": "Mass", "mass": quantity(machine["motor"]["mass"], units["mass"]), "in": {"force": "rotor_force.sum"}}
        force = "coupling.force"
    if "load" in machine:
        blocks["coupling"] = coupling("carriage", "load", machine["load"], units)
        blocks["load"] = {"type": "Mass", "mass": quantity(machine["load"]["mass"], units["mass"]), "in": {"force": "coupling.force"}}
        terms.append("-coupling.force")
    blocks["net_force"] = summed(["+" + force, *terms])
    blocks["carriage"] = {"type": "Mass", "mass": quantity(machine["mass"], units["mass"]), "in": {"force": "net_force.sum"}}
    return blocks


def add_counter(blocks, truth, units):
    if truth["sensor"]["unit"] == "count":
        blocks["counter"] = {"type": "Gain", "gain": quantity(1 / truth["sensor"]["resolution"], "1/" + units["position"]),
                             "in": {"u": "carriage.position"}}


def subdiagram(machine, truth, units):
    input_unit = "V" if "motor" in truth else units["force"]
    blocks = axis_blocks(machine, truth.get("motor"), units, "force")
    add_counter(blocks, truth, units)
    outputs = {"position": {"source": "carriage.position", "unit": units["position"]},
               "velocity": {"source": "carriage.velocity", "unit": units["velocity"]},
               "net_force": {"source": "net_force.sum", "unit": units["force"]}}
    if "counter" in blocks:
        outputs["counts"] = {"source": "counter.y", "unit": "1"}
    return {"loopwright": 1, "title": "The axis, as believed", "inputs": {"force": {"unit": input_unit}}, "outputs": outputs,
            "blocks": blocks}


def solver(truth):
    """A user takes four steps a sample where that is a plain number, else one that is."""
    quarter = truth["sample_time_s"] / 4
    step = round(quarter, 8) if abs(quarter * 1e8 - round(quarter * 1e8)) < 1e-3 else 10.0 ** math.floor(math.log10(quarter))
    return {"method": "rk4", "step": step, "stop": truth["duration_s"]}


def whole_diagram(truth, units):
    """(files, ports): the diagrams by file name, and the ports of the roles and of what is measured."""
    input_unit = "V" if "motor" in truth else units["force"]
    nothing = {"type": "Constant", "value": quantity(0, input_unit)}
    top = {"loopwright": 1, "title": "The machine, as believed", "solver": solver(truth)}
    counts = truth["sensor"]["unit"] == "count"
    if truth["flat"] and "second" not in truth:
        blocks = axis_blocks(truth["nominal"], truth.get("motor"), units, "amplifier.y")
        add_counter(blocks, truth, units)
        top["blocks"] = {"command": nothing, "amplifier": {"type": "Gain", "gain": quantity(1, "1"), "in": {"u": "command.y"}}, **blocks}
        return {"diagram.json": top}, {"position": "carriage.position", "velocity": "carriage.velocity", "force": "net_force.sum",
                                       "input": "amplifier.u", "counts": "counter.y" if counts else None}
    files = {"axis.json": subdiagram(truth["nominal"], truth, units)}
    top["blocks"] = {"command": nothing, "axis": {"diagram": "axis.json", "in": {"force": "command.y"}}}
    if "second" in truth:
        files["bridge.json"] = subdiagram(truth["second"], truth, units)
        top["blocks"]["bridge"] = {"diagram": "bridge.json", "in": {"force": "command.y"}}
    files["diagram.json"] = top
    return files, {"position": "axis.position", "velocity": "axis.velocity", "force": "axis.net_force", "input": "axis.force",
                   "counts": "axis.counts" if counts else None}


def experiment(truth, units, ports):
    sensor = truth["sensor"]
    kind = "velocity" if sensor["quantity"] == "velocity" else "position"
    unit = {"count": "1", "m": units[kind], "rad": units[kind]}.get(sensor["unit"], sensor["unit"])
    in_column = {"mm": 1e3, "deg": 57.29577951308232}.get(sensor["unit"], 1)
    measured = {"column": "measured", "unit": unit}
    if sensor["resolution"] > 0:
        measured["resolution"] = 1 if sensor["unit"] == "count" else sensor["resolution"] * in_column
    drive = {"column": "command", "unit": "V" if "motor" in truth else units["force"], "interpolation": truth["interpolation"]}
    result = {"loopwright": 1, "title": "The machine, driven by the recorded command", "data": "record.csv", "time": "t",
              "drive": {ports["input"]: drive}, "compare": {ports["counts"] or ports[kind]: measured},
              "roles": {role: ports[role] for role in ("position", "velocity", "force", "input")}, "hold_out": {"fraction": 0.25}}
    if ports["counts"] and truth["flat"]:  # the sensor's output stands for the position, as docs/compare.md has it
        result["roles"]["position"] = ports["counts"]
    if "second" in truth:
        result["drive"]["bridge.force"] = {**drive, "column": "second_command"}
        result["compare"]["bridge.position"] = {**measured, "column": "second_measured"}
    return result


def complete(truth):
    """Facts that the diagram needs beside those of the generator: the displacement over which dry friction turns."""
    if "stribeck" in truth["nominal"]:
        truth["nominal"]["transition"] = truth["sensor"]["resolution"] or 1e-7
    return truth


def generate(generator, seed, folder, *more):
    """Writes record.csv, truth.json, the diagram's files and `record.experiment.json`; returns the truth."""
    folder = pathlib.Path(folder)
    subprocess.run([str(a) for a in (generator, seed, folder, *more)], check=True)
    truth = json.loads((folder / "truth.json").read_text())
    units = ROTARY if truth["rotary"] else LINEAR
    files, ports = whole_diagram(complete(truth), units)
    files["record.experiment.json"] = experiment(truth, units, ports)
    for name, content in files.items():
        (folder / name).write_text(json.dumps(content, indent=1) + "\n")
    return truth


if __name__ == "__main__":
    generate(*sys.argv[1:])
