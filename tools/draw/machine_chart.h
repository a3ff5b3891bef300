/// The states and transitions of a StateMachine block, for its drawing.
#pragma once
#include "tools/draw/shown_settings.h"
#include "tools/report/graph.h"

namespace loopwright {

/// `settings`: of a StateMachine. Without states if its settings are not known.
report::GraphChart machine_chart(const ShownSettings& settings);

/// The same from the texts of its settings as JSON: numbers in SI units, as effective parameters have them.
report::GraphChart machine_chart(const std::string& states, const std::string& outputs,
                                 const std::string& initial);

}  // namespace loopwright
