#include "tools/diagnose/verdict/open_answers.h"
#include <fmt/format.h>
#include <algorithm>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {

std::string why_sensor_is_open(const Diagnosis& diagnosis) {
  const auto has = [&](std::string_view name, std::string_view form) {
    return std::ranges::any_of(diagnosis.effects, [&](const DiagnosedEffect& e) {
      return e.name == name && (form.empty() || e.form == form);
    });
  };
  if (!has("sensor_nonlinearity", "") || !has("direction_dependent_friction", "drag")) return {};
  return "an inertia or a force constant that changes along the way would look like sensor_nonlinearity with "
         "this drag, and is not in the catalogue: check the sensor against another one";
}

std::string why_optional_effects_are_open(const Diagnosis& diagnosis) {
  const auto is_optional = [](const DiagnosisStep& step) { return step.is_optional; };
  const bool is_nothing_necessary =
      diagnosis.steps.size() > 1 &&
      std::all_of(diagnosis.steps.begin() + 1, diagnosis.steps.end(), is_optional);
  if (!is_nothing_necessary || !(diagnosis.error_before > 0) ||
      !(diagnosis.error_after > criteria::worse_balance * diagnosis.error_before))
    return {};
  return fmt::format(
      "nothing of what is named is necessary, and the residual force is {:.2f} times that of the "
      "nominal diagram with it",
      diagnosis.error_after / diagnosis.error_before);
}

}  // namespace loopwright::diagnosis
