/// A diagram and its plan together, for those who show the structure of the file beside the results.
#pragma once
#include "engine/plan/plan.h"

namespace loopwright {

struct LoadedDiagram {
  std::shared_ptr<const Diagram> diagram;
  std::shared_ptr<const Plan> plan;
};

/// As load_plan, but keeps the diagram.
LoadedDiagram load_diagram_and_plan(const std::string& path, const LoadOptions& options = {});

}  // namespace loopwright
