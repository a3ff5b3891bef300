"""Files that use every key of their kind, and the files that these refer to. The program accepts them all."""
import math

MOTION = "".join(f"{i * 0.01:.2f},{math.sin(i * 0.05):.9g},{5 * math.cos(i * 0.05):.9g},{math.cos(i * 0.3):.9g}\n" for i in range(400))
# To and fro at a constant velocity, with a force that depends on the position.
CRUISE = "".join(f"{i * 0.01:.2f},{0.1 * i * 0.01:.9g},0.1,{math.sin(2 * math.pi * i * 0.001 / 0.02):.9g}\n" for i in range(400))

BESIDE = {
    "motion.csv": "time,x (m),v (m/s),u (N)\n" + MOTION,
    "cruise.csv": "time,x (m),v (m/s),d (N)\n" + CRUISE,
    "map.csv": "x (m),u (N)\n" + "".join(f"{i / 100},{math.sin(i)}\n" for i in range(50)),
    "loop.json": """{"loopwright": 1, "solver": {"method": "rk4", "step": 0.01, "stop": 0.1}, "parameters": {"level": 2},
      "blocks": {"c": {"type": "Constant", "value": "=level"}, "g": {"type": "Gain", "gain": 2, "in": {"u": "c.y"}},
                 "v": {"variants": {"a": {"type": "Gain", "gain": 1}, "b": {"type": "Gain", "gain": 2}}, "in": {"u": "g.y"}}}}""",
    "part.json": """{"loopwright": 1, "parameters": {"k": 1}, "inputs": {"u": "1"}, "outputs": {"y": "g.y"},
      "blocks": {"g": {"type": "Gain", "gain": "=k", "in": {"u": "u"}}}}""",
    "gains.json": '{"k": 3, "list": [1, 2]}',
}

HEAD = {"$schema": "x.schema.json", "loopwright": 1, "title": "A sample"}
STATED = [5, "5 mm", {"value": 5, "unit": "mm"}]

EXPERIMENTS = [
    {**HEAD, "description": "All keys", "data": "motion.csv", "time": "time",
     "drive": {"a.u": {"column": "u", "unit": "N", "interpolation": "band_limited"}},
     "compare": {"a.x": {"column": "x", "unit": "m", "resolution": {"value": 1, "unit": "um"}},
                 "a.v": {"column": "v", "resolution": "1 mm/s"}, "a.z": {"column": "z", "resolution": 0.1}},
     "roles": {"position": "a.x", "velocity": "a.v", "acceleration": "a.a", "force": "a.f", "input": "a.u"},
     "set": {"a.mass": {"value": 1, "unit": "kg"}, "load": "=1/2", "gains.1": 3, "way": "5 mm"},
     "hold_out": {"fraction": 0.25}, "rows": "samples",
     "columns": {"z": {"column": "x", "unit": "m", "scale": 2, "offset": "3 mm", "rows_late": 1}},
     "excerpt": {"from": "0.5 s", "to": 3, "skip": 1, "decimate": 2}},
    {**HEAD, "data": "motion.csv", "compare": {"a.x": {"column": "x"}}, "sites": ["a.f", "a.g"]},
    {**HEAD, "data": "map.csv", "compare": {"a.x": {"column": "x"}}, "drive": {"a.u": {"column": "u"}}, "rows": "balances",
     "roles": {"position": "a.x", "input": "a.u"}},
]

SWEEPS = [
    {**HEAD, "description": "All keys", "diagram": "loop.json", "set": {"solver.stop": 0.05, "g.gain": "=1+1"},
     "variants": {"v": "a"}, "seed": 3,
     "axes": {"c.value": {"values": [1, {"value": 2, "unit": "1"}], "unit": "1"},
              "g.gain": {"linear": {"from": 1, "to": 2, "count": 2}},
              "level": {"logarithmic": {"from": 1, "to": 2, "count": 2}}},
     "paired": [["c.value", "g.gain"]],
     "metrics": {"a": {"rms": "g.y", "unit": "1", "from": "10 ms", "to": 0.04, "least": 0, "most": 10}, "b": {"mean": "g.y"},
                 "c": {"maximum": "g.y"}, "d": {"minimum": "g.y"}, "e": {"peak": "=2*g.y"}, "f": {"final": "g.y"},
                 "g": {"settling_time": "g.y", "target": 1, "band": 0.1}, "h": {"overshoot": "g.y", "target": 1},
                 "i": {"percentile": "g.y", "percent": 90}, "j": {"first_violation": "g.y", "threshold": 3}},
     "keep": {"worst": 2, "of": "a"}},
    {**HEAD, "diagram": "loop.json", "axes": {"c.value": {"uniform": {"from": 1, "to": 2}}, "g.gain": {"log_uniform": {"from": 1, "to": 2}},
                                              "level": {"normal": {"mean": 1, "deviation": 0.1}}, "v": {"variants": ["a", "b"]}},
     "samples": {"method": "sobol", "count": 4}, "metrics": {"a": {"rms": "g.y"}}, "keep": {"runs": [0, 1]}},
    {**HEAD, "diagram": "loop.json", "axes": {"c.value": {"values": [1]}}, "metrics": {"a": {"rms": "g.y"}}, "keep": "failed"},
]

TRAININGS = [
    {**HEAD, "description": "All keys", "recordings": ["cruise.csv"], "time": "time", "position": {"column": "x", "unit": "m"},
     "velocity": {"column": "v", "unit": "m/s"}, "label": {"columns": ["d"], "unit": "N", "lag": 0},
     "velocities": [0.1], "velocity_tolerance": 0.05, "settling": 0, "window_length": {"value": 200, "unit": "mm"},
     "window_centers": [0.2], "pair_with": "plateau", "kernel": "terms",
     "terms": [{"position": "periodic"}, {"position": "constant", "velocity": "squared_exponential"}],
     "period": "=0.01*2", "fit_period": False, "period_search": 0.1, "homing_offset": 0, "most_samples": 100,
     "priors": [{"parameter": "noise", "median": 1, "log_deviation": 1, "low": 0.1, "high": 10}]},
    {**HEAD, "recordings": ["motion.csv"], "position": {"column": "x"}, "slowest": {"value": 0.01, "unit": "m/s"},
     "label": {"command": "u", "unit": "N", "mass": 1, "damping": 0.1, "cutoff": 20, "delay": 0}, "kernel": "ps", "period": 0.5},
]

CHANNEL = {"kind": "encoder", "channel": 0, "unit": "m", "scale": 2e-7}
DEVICES = [
    {**HEAD, "description": "All keys", "driver": "quanser",
     "quanser": {"board": "qpid_e", "identifier": "0", "library": "libhil.so", "clock": 0, "analog_outputs": 8, "options": ""},
     "inputs": {"x": {**CHANNEL, "offset": {"value": 1, "unit": "mm"}, "quadrature": 4, "counter_bits": 24, "preset": 0, "filter": 0,
                      "maximum_rate": 3},
                "f": {"kind": "analog", "channel": 1, "unit": "N", "scale": "=2*2", "low": -5, "high": 5}},
     "outputs": {"u": {"channel": 0, "unit": "V", "scale": 1, "offset": 0, "low": -10, "high": 10, "minimum": -8, "maximum": 8,
                       "maximum_rate": 20000, "initial": 0, "safe": 0}},
     "clock": {"source": "device", "buffer": 2, "overflow": "error", "time": "real"}, "watchdog": {"timeout": 0.01},
     "policy": {"on_overrun": "fault", "most_overruns": 3, "on_lost": "fault", "most_lost": 3, "most_skipped": 20, "on_invalid": "fault",
                "most_invalid": 3}},
    {**HEAD, "driver": "udp", "udp": {"address": "127.0.0.1", "port": 8001, "patience": 0.1}, "inputs": {"x": CHANNEL}},
]

EFFECT = {
    **HEAD, "effect": "sample", "physics": "None", "repeatable": False, "at_rest": "free", "equivalents": ["another"],
    "parameters": {"height": {"description": "Of it", "unit": "$force", "linear": True, "range": ["=-3*force_level", "=3*force_level"],
                              "start": "=0.1*force_level"},
                   "width": {"unit": "$position", "period": True, "scale": "logarithmic", "range": ["=0.002*stroke", "=0.2*stroke"],
                             "start": "=0.02*stroke", "points": 5},
                   "half": {"unit": "$position", "value": "=width/2", "range": [0, "=stroke"], "description": "Of the width"}},
    "blocks": {"k": {"type": "Constant", "value": "=1/half"},
               "scaled": {"type": "Product", "in": {"factors": ["position", "k.y"]}},
               "force": {"type": "Gain", "gain": "=height", "in": {"u": "scaled.product"}}},
    "attach": [{"to": "force", "from": "force.y", "slope": "scaled.product"}],
    "needs": {"text": "motion", "directions": 1, "speeds": 1, "accelerations": 0, "reversals": 0, "passes": 1, "periods": 0,
              "duration_s": 0, "varied_force": False},
    "confusable": [{"with": "spring", "when": "always", "experiment": {
        "text": "Go slowly", "speeds": [0.1], "distance": 1, "acceleration": 1, "passes": 5, "pause_s": 0.2, "added_mass": 0,
        "chirp_amplitude": 0, "chirp_from_hz": 1, "chirp_to_hz": 100}}]}
FORM_KEYS = ("physics", "parameters", "blocks", "attach", "needs", "equivalents", "confusable", "at_rest")
MASS = {
    **HEAD, "effect": "sample", "physics": "None", "needs": {"text": ""},
    "parameters": {"mass": {"unit": "$force*s^2/$position", "range": [0, "=machine_mass"], "start": "=0.1*machine_mass"}},
    "blocks": {"force": {"type": "Gain", "gain": "=mass", "in": {"u": "acceleration"}}},
    "attach": [{"to": "parameter", "from": "force.y", "parameter": ["Mass.mass"], "add": "=mass", "optional": True}]}
DELAY = {
    **HEAD, "effect": "sample", "physics": "None", "needs": {"text": ""}, "parameters": {},
    "blocks": {"late": {"type": "Gain", "gain": 0.5, "in": {"u": "input"}}},
    "attach": [{"to": "input", "stage": "command", "from": "late.y"}]}
AT_SITE = {
    **HEAD, "effect": "sample", "physics": "None", "site": ["force", "any"], "of": "velocity", "formula": "slope * signal * tanh(signal / knee)",
    "parameters": {"slope": {"description": "Of it", "unit": "$site/$signal", "linear": True},
                   "knee": {"unit": "$signal", "linear": False, "range": ["=0.01*largest_signal", "=largest_signal"], "points": 5,
                            "scale": "logarithmic"}}}
EFFECTS = [EFFECT, MASS, DELAY, AT_SITE,
           {**{key: value for key, value in EFFECT.items() if key not in FORM_KEYS},
            "forms": {name: {key: form[key] for key in FORM_KEYS if key in form}
                      for name, form in {"full": EFFECT, "mass": MASS, "delay": DELAY}.items()}}]

DIAGRAMS = [
    {**HEAD, "description": "All keys",
     "parameters": {"k": 2, "m": {"value": "=2*k", "unit": "kg", "description": "A mass"}, "on": True, "way": "linear", "list": [1, 2],
                    "other": {"file": "gains.json", "name": "k"}},
     "solver": {"method": "rk4", "start": 0, "stop": {"value": 100, "unit": "ms"}, "step": "=0.01*1", "record_step": 0.01,
                "algebraic_loops": "error", "seed": 1},
     "inputs": {}, "outputs": {"y": "gain.y", "z": {"source": "gain.y", "unit": "1", "description": "The same"}},
     "blocks": {"c": {"type": "Constant", "value": 1, "description": "One"},
                "on": {"type": "Constant", "value": 1, "sample_time": 0.01},
                "gain": {"type": "Gain", "gain": "=k", "in": {"u": "c.y"}},
                "late": {"type": "UnitDelay", "sample_time": 0.01, "sample_offset": 0, "in": {"u": "gain.y"}},
                "part": {"diagram": "part.json", "parameters": {"k": "=k"}, "in": {"u": "c.y"}, "description": "A part",
                         "enabled_by": "on.y", "while_disabled": {"states": "hold", "outputs": "reset"}},
                "inner": {"diagram": {"inputs": {"u": {"unit": "1", "description": "In"}}, "outputs": {"y": "d.y"},
                                      "blocks": {"d": {"type": "UnitDelay", "sample_time": 0.01, "in": {"u": "u"}}}},
                          "in": {"u": "c.y"}, "triggered_by": "on.y", "edge": "rising"},
                "either": {"variants": {"a": {"type": "Gain", "gain": 1}, "b": {"diagram": "part.json"}}, "variant": "a",
                           "in": {"u": "c.y"}, "description": "One of two"}},
     "log": ["gain.*", "c.y"], "figures": [{"signal": "gain.y", "reference": "c.y", "band": {"value": 1, "unit": "1"}}]},
    {**HEAD, "solver": {"method": "dopri5", "stop": 1, "maximum_step": 0.1, "relative_tolerance": 1e-6, "absolute_tolerance": 1e-9},
     "blocks": {"c": {"type": "Constant", "value": 1}}},
]

SAMPLES = {"experiment": EXPERIMENTS, "sweep": SWEEPS, "training": TRAININGS, "device": DEVICES, "effect": EFFECTS, "diagram": DIAGRAMS}
