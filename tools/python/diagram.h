/// A diagram as Python holds it: its file, its options and its plan.
#pragma once
#include <memory>
#include <string>
#include "engine/plan/plan.h"

namespace loopwright::python {

struct LoadedDiagram {
  std::string path;
  LoadOptions options;
  std::shared_ptr<const Plan> plan;
};

using Settings = std::vector<std::pair<std::string, std::string>>;

/// Loads and compiles without the interpreter's lock. Throws InputError.
LoadedDiagram load(const std::string& path, LoadOptions options);

}  // namespace loopwright::python
