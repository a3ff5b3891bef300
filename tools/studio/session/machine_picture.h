/// State machines as charts.
#pragma once
#include "tools/studio/session/checked_text.h"

namespace loopwright::studio {

/// The states and transitions of a StateMachine as tools/report/page/chart_layout.js lays them out; null for
/// another block. `evaluated`: the settings as they were loaded; null: without the values that states set.
Json machine_json(const std::string& type, const Value& written, const Value* evaluated);

}  // namespace loopwright::studio
