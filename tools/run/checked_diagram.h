/// What can be said about a diagram before it runs.
#pragma once
#include "engine/plan/plan.h"

namespace loopwright {

struct CheckedDiagram {
  std::shared_ptr<const Diagram> diagram;  ///< null: nothing could be read
  std::shared_ptr<const Plan> plan;        ///< null: a part of a diagram, or problems
  WiresWithoutUnit without_unit;

  /// A diagram with inputs, which runs only inside another one.
  bool is_part() const { return diagram && !diagram->inputs.empty(); }
  /// "5 blocks, 2 states", "a subdiagram of 5 blocks"; empty if it does not load.
  std::string summary() const;
};

/// Compiles a diagram that was loaded, or checks what can be checked of a part. `diagram` may be null.
CheckedDiagram check_diagram(std::shared_ptr<const Diagram> diagram, Problems& problems);

}  // namespace loopwright
