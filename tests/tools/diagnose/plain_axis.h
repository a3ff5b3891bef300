/// A diagram of 0.5 kg with 7 N s/m, and a record of its force u and position x.
#pragma once
#include <fmt/format.h>
#include "tests/engine/diagram/diagram_folder.h"

namespace loopwright {

struct PlainRecord {
  std::string csv;      ///< t, u [N], x [m]
  double count = 1e-9;  ///< [m] of the position
  double solver_step = 1e-3;
  double held_out = 0;  ///< fraction; 0: as the diagnosis chooses
  std::string more{};   ///< of the experiment: R"(, "columns": {…})"
};

/// axis.json, record.csv and e.json.
inline void write_plain_axis(DiagramFolder& folder, const PlainRecord& record) {
  folder.with(
      "axis.json",
      fmt::format(R"({{"loopwright": 1, "solver": {{"method": "rk4", "step": {}, "stop": 10}}, "blocks": {{
 "u":     {{"type": "Constant", "value": {{"value": 0, "unit": "N"}}}},
 "drive": {{"type": "Gain", "gain": 1, "in": {{"u": "u.y"}}}},
 "vis":   {{"type": "ViscousFriction", "damping": {{"value": 7, "unit": "N*s/m"}}, "in": {{"velocity": "m.velocity"}}}},
 "net":   {{"type": "Sum", "signs": "+-", "in": {{"terms": ["drive.y", "vis.force"]}}}},
 "m":     {{"type": "Mass", "mass": {{"value": 0.5, "unit": "kg"}}, "in": {{"force": "net.sum"}}}}}}}})",
                  record.solver_step));
  folder.with("record.csv", record.csv);
  const std::string hold_out =
      record.held_out > 0 ? fmt::format(R"( "hold_out": {{"fraction": {}}},)", record.held_out) : "";
  folder.with(
      "e.json",
      fmt::format(
          R"({{"loopwright": 1, "data": "record.csv", "time": "t", "drive": {{"drive.u": {{"column": "u"}}}},
 "compare": {{"m.position": {{"column": "x", "resolution": "{} m"}}}},{}
 "roles": {{"position": "m.position", "velocity": "m.velocity", "force": "net.sum", "input": "drive.u"}}{}}})",
          record.count, hold_out, record.more));
}

}  // namespace loopwright
