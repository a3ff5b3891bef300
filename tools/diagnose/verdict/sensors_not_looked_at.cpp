#include "tools/diagnose/verdict/sensors_not_looked_at.h"
#include <fmt/format.h>
#include <algorithm>
#include "tools/diagnose/wording.h"

namespace loopwright::diagnosis {

void tell_sensors_not_looked_at(SiteModel& model, const SiteHypothesis& found, Diagnosis& result) {
  std::vector<std::string> sensors;
  for (size_t i = 0; i < model.sites().size(); ++i) {
    const Site& site = model.sites()[i];
    const bool is_found = std::ranges::find(found.terms, int(i), &SiteTerm::site) != found.terms.end();
    if (site.is_sensor_not_looked_at() && !is_found) sensors.push_back(site.own_signal);
  }
  if (sensors.empty()) return;
  result.not_looked_for.push_back(
      {{fmt::format("errors of the sensors of {}{}", loopwright::joined(sensors, ", "),
                    model.work().was_short() ? "" : " beside several changes")},
       fmt::format(
           "what was found may in part stand for an offset of one; \"sites\" of the experiment may name "
           "them, as \"{} (sensor)\"",
           sensors.front())});
}

}  // namespace loopwright::diagnosis
