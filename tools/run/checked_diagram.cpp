#include "tools/run/checked_diagram.h"
#include <fmt/format.h>

namespace loopwright {

std::string CheckedDiagram::summary() const {
  if (is_part()) return fmt::format("a subdiagram of {} blocks", diagram->blocks.size());
  return plan ? fmt::format("{} blocks, {} states", plan->blocks.size(), plan->states) : "";
}

CheckedDiagram check_diagram(std::shared_ptr<const Diagram> diagram, Problems& problems) {
  CheckedDiagram checked{std::move(diagram), nullptr, {}};
  if (!checked.diagram) return checked;
  if (checked.is_part()) {
    checked.without_unit = check_part(*checked.diagram, problems);
  } else if ((checked.plan = compile(*checked.diagram, problems))) {
    checked.without_unit = checked.plan->without_unit;
  }
  return checked;
}

}  // namespace loopwright
