#include "tools/studio/session/machine_picture.h"
#include "engine/json/json.h"
#include "tools/draw/machine_chart.h"

namespace loopwright::studio {

Json machine_json(const std::string& type, const Value& written, const Value* evaluated) {
  if (type != "StateMachine") return nullptr;
  const Value& settings = evaluated ? *evaluated : written;
  const auto text_of = [&](std::string_view name) {
    const Value::Member* member = settings.find(name);
    return member ? to_json(member->value) : std::string();
  };
  report::GraphChart chart =
      machine_chart(text_of("states"), text_of("outputs"), std::string(text_in(settings, "initial")));
  if (!evaluated)
    for (report::ChartState& state : chart.states) state.entries.clear();
  return Json::parse(report::chart_json(chart));
}

}  // namespace loopwright::studio
