/// Diagrams written inside a test, run and judged.
#pragma once
#include "engine/plan/load.h"
#include "tests/engine/written_diagram.h"
#include "tools/run/judged_run.h"

namespace loopwright {

/// A mass of 2 kg that a force of at most 1 N moves to 1 m.
inline constexpr std::string_view limited_servo =
    R"("reference": {"type": "Step", "time": 0.1, "after": {"value": 1, "unit": "m"}},
  "error": {"type": "Sum", "signs": "+-", "in": {"terms": ["reference.y", "stage.position"]}},
  "gain": {"type": "Gain", "gain": {"value": 4, "unit": "N/m"}, "in": {"u": "error.sum"}},
  "limit": {"type": "Saturation", "low": {"value": -1, "unit": "N"}, "high": {"value": 1, "unit": "N"}, "in": {"u": "gain.y"}},
  "stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "limit.y"}})";
inline constexpr std::string_view three_seconds = R"("stop": 3, "step": 0.001)";

/// The file lives as long as the run: what is to follow what is read from it again.
inline JudgedRun judged(std::string_view blocks, std::string_view more = "", const RunOptions& options = {}) {
  DiagramFolder folder;
  const std::string path = folder.with("top.json", diagram(blocks, three_seconds, more)).path("top.json");
  const LoadedDiagram loaded = load_diagram_and_plan(path);
  return run_and_judge(loaded.diagram.get(), *loaded.plan, options);
}

}  // namespace loopwright
