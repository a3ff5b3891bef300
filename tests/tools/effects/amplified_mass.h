/// A mass that a command drives through an amplifier.
#pragma once

namespace loopwright {

inline constexpr const char* amplified_mass =
    R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.0001, "stop": 0.1}, "blocks": {
    "push": {"type": "Constant", "value": {"value": 0, "unit": "N"}},
    "amp": {"type": "Gain", "gain": 1, "in": {"u": "push.y"}},
    "net": {"type": "Sum", "in": {"terms": ["amp.y"]}},
    "mass": {"type": "Mass", "mass": 1, "in": {"force": "net.sum"}}},
    "log": ["amp.y"]})";

}  // namespace loopwright
