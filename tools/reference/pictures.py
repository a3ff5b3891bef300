"""Draws the small pictures of the block reference from runs of the blocks' examples.

    PYTHONPATH=build/release/lib/python /usr/bin/python3 tools/reference/pictures.py [--to docs/images/blocks]

Every picture is a run of diagrams/examples/NAME.json: signals over time, or one signal over another. Runs have the same bits
on every machine, and coordinates are rounded: so are the files.
"""
import argparse
import json
import math
import pathlib

import loopwright

ROOT = pathlib.Path(__file__).resolve().parents[2]
WIDTH, HEIGHT = 300, 150  # [px] of the area of a plot
LEFT, RIGHT, TOP, BOTTOM = 54, 14, 8, 22  # [px] around it
LINE = 15  # [px] height of a line of the legend
TOLERANCE = 0.35  # [px] by which a curve may leave its points
COLOURS = ["first", "second", "third", "fourth", "fifth"]
STYLE = """<style>
text{font:11px sans-serif;fill:#444}.frame{fill:none;stroke:#bbb}.grid{stroke:#ddd}path{fill:none;stroke-width:1.5}
.first{stroke:#0b62a8}.second{stroke:#c8501e}.third{stroke:#2b8a3e}.fourth{stroke:#8a3ea8}.fifth{stroke:#7a6a00}
text.first{fill:#0b62a8}text.second{fill:#c8501e}text.third{fill:#2b8a3e}text.fourth{fill:#8a3ea8}text.fifth{fill:#7a6a00}
text[class]{stroke:none}
@media(prefers-color-scheme:dark){text{fill:#bbb}.frame{stroke:#666}.grid{stroke:#444}
.first{stroke:#6cb6ff}.second{stroke:#ff9d6c}.third{stroke:#7ddc8f}.fourth{stroke:#d29bf0}.fifth{stroke:#e0cf5a}
text.first{fill:#6cb6ff}text.second{fill:#ff9d6c}text.third{fill:#7ddc8f}text.fourth{fill:#d29bf0}text.fifth{fill:#e0cf5a}}
</style>"""


def nice_step(span, count):
    """A round distance (1, 2 or 5 times a power of ten) of about `count` parts of the span."""
    raw = span / count
    power = 10.0 ** math.floor(math.log10(raw))
    return next(power * part for part in (1, 2, 5, 10) if power * part >= raw * 0.999)


class Axis:
    """Maps values to pixels, and chooses round labels."""

    def __init__(self, values, begin, length, margin):
        finite = [v for v in values if math.isfinite(v)]
        low, high = min(finite), max(finite)
        if high - low <= 1e-12 * max(abs(low), abs(high)):
            low, high = low - (abs(low) or 1), high + (abs(high) or 1)
        extra = margin * (high - low)
        self.low, self.high, self.begin, self.length = low - extra, high + extra, begin, length

    def pixel(self, value):
        return self.begin + self.length * (value - self.low) / (self.high - self.low)

    def labels(self, count):
        step = nice_step(self.high - self.low, count)
        first = math.ceil(self.low / step - 1e-9)
        last = math.floor(self.high / step + 1e-9)
        return [(n * step, f"{n * step:.6g}".replace("-", "\u2212")) for n in range(first, last + 1)]


def simplified(points):
    """The points that a curve needs to stay within TOLERANCE of all (Douglas and Peucker 1973)."""
    kept = [False] * len(points)
    kept[0] = kept[-1] = True
    parts = [(0, len(points) - 1)]
    while parts:
        a, b = parts.pop()
        (xa, ya), (xb, yb) = points[a], points[b]
        length = math.hypot(xb - xa, yb - ya)
        worst, at = TOLERANCE, None
        for i in range(a + 1, b):
            x, y = points[i][0] - xa, points[i][1] - ya
            away = abs(x * (yb - ya) - y * (xb - xa)) / length if length > 1e-9 else math.hypot(x, y)
            if away > worst:
                worst, at = away, i
        if at is not None:
            kept[at] = True
            parts += [(a, at), (at, b)]
    return [p for p, keep in zip(points, kept) if keep]


def path_of(xs, ys, x_axis, y_axis):
    points = [(round(x_axis.pixel(x), 1), round(y_axis.pixel(y), 1)) for x, y in zip(xs, ys)]
    points = [p for i, p in enumerate(points) if i == 0 or p != points[i - 1]]
    return "M" + " ".join(f"{x:g} {y:g}" for x, y in simplified(points))


def unit_text(unit):
    return f" [{unit}]" if unit and unit != "1" else ""


def plot(result, panel, left, top):
    """The text of one plot of a picture, whose frame begins `left` and `top` pixels from the edges, less its labels."""
    over, names, window = panel
    time = list(result.time)
    rows = [i for i, t in enumerate(time) if window is None or window[0] <= t <= window[1]]
    xs = [float((result.time if over is None else result[over])[i]) for i in rows]
    curves = [[float(result[name][i]) for i in rows] for name in names]
    x_axis = Axis(xs, left + LEFT, WIDTH, 0.0 if over is None else 0.04)
    y_axis = Axis([y for curve in curves for y in curve], top + HEIGHT, -HEIGHT, 0.06)
    parts = []
    for value, label in y_axis.labels(4):
        y = round(y_axis.pixel(value), 1)
        parts.append(f'<line class="grid" x1="{left + LEFT}" x2="{left + LEFT + WIDTH}" y1="{y:g}" y2="{y:g}"/>')
        parts.append(f'<text x="{left + LEFT - 4}" y="{y + 4:g}" text-anchor="end">{label}</text>')
    label_of_axis = f"{over or 'time'}{unit_text('s' if over is None else result.units[over])}"
    room = WIDTH - 7 * len(label_of_axis) - 8
    for value, label in x_axis.labels(5):
        x = round(x_axis.pixel(value), 1)
        parts.append(f'<line class="grid" x1="{x:g}" x2="{x:g}" y1="{top}" y2="{top + HEIGHT}"/>')
        if x - left - LEFT < room:
            parts.append(f'<text x="{x:g}" y="{top + HEIGHT + 15}" text-anchor="middle">{label}</text>')
    parts.append(f'<text x="{left + LEFT + WIDTH}" y="{top + HEIGHT + 15}" text-anchor="end">{label_of_axis}</text>')
    parts.append(f'<rect class="frame" x="{left + LEFT}" y="{top}" width="{WIDTH}" height="{HEIGHT}"/>')
    for number, (name, curve) in enumerate(zip(names, curves)):
        parts.append(f'<path class="{COLOURS[number]}" d="{path_of(xs, curve, x_axis, y_axis)}"/>')
        parts.append(f'<text class="{COLOURS[number]}" x="{left + LEFT}" y="{top - LINE * (len(names) - number - 1) - 5}">'
                     f"{name}{unit_text(result.units[name])}</text>")
    return "\n".join(parts)


def picture(name, panels):
    """The SVG text of a block: its example, run with a fixed step."""
    file = ROOT / "diagrams" / "examples" / f"{name}.json"
    diagram = loopwright.load(str(file))
    result = diagram.run()
    top = TOP + LINE * max(len(names) for _, names, _ in panels)
    texts = [plot(result, panel, i * (LEFT + WIDTH + RIGHT), top) for i, panel in enumerate(panels)]
    width, height = len(panels) * (LEFT + WIDTH + RIGHT), top + HEIGHT + BOTTOM
    title = json.loads(file.read_text(encoding="utf-8"))["title"].replace("&", "&amp;").replace("<", "&lt;")
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}">\n<title>{title}</title>\n{STYLE}\n' + "\n".join(texts) + "\n</svg>\n")


def over_time(*names, window=None):
    return (None, names, window)


def over(signal, *names, window=None):
    return (signal, names, window)


# The blocks whose response a picture shows better than a sentence.
PICTURES = {
    "absolute": [over("wave.y", "size.y")],
    "actuator_lag": [over_time("command.y", "actuator.force")],
    "backlash": [over("driving.y", "play.y")],
    "backlash_coupling": [over_time("motor.position", "load.position"), over_time("coupling.force")],
    "cam_table": [over("shaft.y", "pusher.slave_position"), over_time("pusher.slave_velocity")],
    "chirp": [over_time("force.y")],
    "cogging_force": [over("path.position", "cogging.force")],
    "comparison": [over_time("wave.y", "ramp.y"), over_time("above.y", "stays.y")],
    "continuous_disturbance_observer": [over_time("load.y", "observer.disturbance")],
    "continuous_lead_lag": [over_time("sine.y", "lead.y", "lag.y")],
    "continuous_notch": [over_time("signal.sum", "notch.y")],
    "coulomb_friction": [over_time("push.y", "friction.force"), over_time("mass.velocity")],
    "counter": [over_time("stage.velocity"), over_time("strokes.count", "phase.count")],
    "current_controller": [over_time("wanted_q.y", "motor.current_q", "motor.current_d"), over_time("control.voltage_d", "control.voltage_q")],
    "dahl_friction": [over("path.position", "friction.force")],
    "dc_motor": [over_time("motor.current"), over_time("rotor.velocity")],
    "dead_zone": [over("wave.y", "zone.y")],
    "delay": [over_time("sine.y", "late.y")],
    "direction_dependent_friction": [over_time("push.y", "friction.force"), over_time("mass.velocity")],
    "discrete_integrator": [over_time("forward.y", "backward.y", "trapezoidal.y")],
    "discrete_transfer_function": [over_time("step.y", "lag.y")],
    "disturbance_observer": [over_time("load.y", "observer.disturbance")],
    "eddy_current_drag": [over("mass.velocity", "brake.force")],
    "edge": [over_time("button.y", "pressed.y", "changed.y")],
    "elastic_coupling": [over_time("motor.velocity", "load.velocity")],
    "electronic_gear": [over_time("conveyor.y", "roll.position"), over_time("roll.velocity")],
    "encoder": [over("position.y", "encoder.position")],
    "end_stop": [over_time("mass.position"), over("mass.position", "stop.force")],
    "force_ripple": [over("path.y", "motor.force")],
    "force_saturation": [over("command.y", "motor.force")],
    "hardening_spring": [over("mass.position", "spring.force")],
    "integrator": [over_time("speed.y"), over_time("place.y")],
    "inverse_park_transform": [over_time("phases.a", "phases.b", "phases.c")],
    "latch": [over_time("current.y"), over_time("acknowledge.y", "fault.y")],
    "lookup_1d": [over("current.y", "lines.y", "smooth.y")],
    "low_pass": [over_time("step.y", "butterworth.y", "critically_damped.y")],
    "modulo": [over("shaft.y", "wrapped.y")],
    "motion_profile": [over_time("reference.position"), over_time("reference.acceleration")],
    "moving_average": [over_time("signal.sum", "mean.y")],
    "multisine": [over_time("excitation.y")],
    "noise": [over_time("noise.y"), over_time("walk.sum")],
    "park_transform": [over_time("a.y", "b.y", "c.y"), over_time("park.d", "park.q")],
    "pid_controller": [over_time("reference.y", "none_plant.y", "clamping_plant.y", "back_calculation_plant.y")],
    "point_to_point": [over_time("path.position", "trapezoid.position"), over_time("path.velocity", "trapezoid.velocity")],
    "presliding_friction": [over_time("push.y", "friction.force"), over_time("mass.velocity")],
    "pulse_train": [over_time("push.y"), over_time("body.velocity")],
    "q_filter": [over_time("step.y", "order_1.y", "order_2.y", "order_3.y", "order_4.y")],
    "quadratic_drag": [over("mass.velocity", "drag.force")],
    "quantizer": [over("position.y", "encoder.y")],
    "rate_limiter": [over_time("square.y", "limited.y")],
    "relay": [over("room.y", "heater.y"), over_time("room.y")],
    "repetitive_controller": [over_time("stage.position"), over_time("cogging.y", "repeat.correction")],
    "rounding": [over("wave.y", "nearest.y", "floor.y", "ceiling.y", "cut.y")],
    "sample_and_hold": [over_time("position.y", "seen.y", "tracked.y")],
    "saturation": [over("wave.y", "limit.y")],
    "scheduled_pid_controller": [over_time("target.y", "stage.position")],
    "smith_predictor": [over_time("wanted.y", "sensor.y", "smith.prediction")],
    "smooth_coulomb_friction": [over("mass.velocity", "friction.force")],
    "state_machine": [over_time("machine.state"), over_time("slide.y")],
    "stribeck_friction": [over_time("spring.force", "friction.force"), over_time("mass.position")],
    "synchronized_motion": [over_time("path.position[0]", "path.position[1]", "path.position[2]"),
                            over_time("path.velocity[0]", "path.velocity[1]", "path.velocity[2]")],
    "thermal_drift": [over_time("motor.y")],
    "thermal_node": [over_time("winding.temperature", "housing.temperature"), over_time("losses.y", "housing.loss")],
    "timer": [over_time("moves.y", "release.y", "warning.y"), over_time("warning.elapsed")],
    "transport_delay": [over_time("step.y", "plant.y", "pipe.y")],
    "unit_delay": [over_time("sine.y", "late.y")],
    "velocity_estimator": [over_time("difference.velocity", "mean.velocity", "filtered.velocity", "reference.velocity", window=(0.2, 0.26))],
    "via_points": [over("path.position[0]", "path.position[1]"), over_time("path.velocity[0]", "path.velocity[1]")],
    "zero_order_hold": [over_time("sine.y", "held.y")],
}


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--to", type=pathlib.Path, default=ROOT / "docs" / "images" / "blocks")
    folder = arguments.parse_args().to
    folder.mkdir(parents=True, exist_ok=True)
    for name, panels in PICTURES.items():
        (folder / f"{name}.svg").write_text(picture(name, panels), encoding="utf-8")


if __name__ == "__main__":
    main()
