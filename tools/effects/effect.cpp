#include "tools/effects/effect.h"
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include "tools/effects/effect_files.h"
#include "tools/effects/effect_values.h"

namespace loopwright {

const std::vector<NamedSize> record_sizes = {
    {"stroke", "$position", &RecordSizes::stroke},
    {"lowest_position", "$position", &RecordSizes::lowest_position},
    {"highest_position", "$position", &RecordSizes::highest_position},
    {"top_speed", "$position/s", &RecordSizes::top_speed},
    {"top_acceleration", "$position/s^2", &RecordSizes::top_acceleration},
    {"force_level", "$force", &RecordSizes::force_level},
    {"input_level", "$input", &RecordSizes::input_level},
    {"machine_mass", "$force*s^2/$position", &RecordSizes::machine_mass},
    {"machine_damping", "$force*s/$position", &RecordSizes::machine_damping},
    {"resolution", "$position", &RecordSizes::resolution},
    {"duration", "s", &RecordSizes::duration},
    {"record_start", "s", &RecordSizes::start},
    {"sample_time", "s", &RecordSizes::sample_time},
    {"initial_position", "$position", &RecordSizes::initial_position},
    {"initial_velocity", "$position/s", &RecordSizes::initial_velocity},
    {"second", "s", &RecordSizes::second},
};

const EffectParameter* Effect::find(std::string_view parameter) const {
  const auto found = std::ranges::find(parameters, parameter, &EffectParameter::name);
  return found == parameters.end() ? nullptr : &*found;
}

std::string catalogue_folder() {
  const char* variable = std::getenv("LOOPWRIGHT_EFFECTS");
  if (variable && *variable) return variable;
  return installed_catalogue();
}

FitRange range_of(const EffectParameter& parameter, const RecordSizes& sizes) {
  const EffectValues values(sizes);
  FitRange range{values.evaluate(parameter.low), values.evaluate(parameter.high),
                 values.evaluate(parameter.start)};
  range.high = std::max(range.high, range.low);
  range.start = std::clamp(range.start, range.low, range.high);
  return range;
}

void fix(Effect& effect, std::string_view name, double value) {
  for (EffectParameter& parameter : effect.parameters) {
    if (parameter.name != name) continue;
    parameter.is_fitted = parameter.is_linear = parameter.is_period = false;
    parameter.value = Value{};
    parameter.value.kind = Value::Kind::number;
    parameter.value.number = value;
    parameter.value.place = parameter.place;
  }
}

std::string unit_in(std::string_view unit, const MachineUnits& units) {
  std::string text;
  const auto by_role = [&](std::string_view name, const std::string& replacement) {
    if (!unit.starts_with(name)) return false;
    text += "(" + replacement + ")";
    unit.remove_prefix(name.size());
    return true;
  };
  while (!unit.empty()) {
    if (by_role("$position", units.position) || by_role("$force", units.force) ||
        by_role("$input", units.input))
      continue;
    text += unit.front();
    unit.remove_prefix(1);
  }
  return text;
}

}  // namespace loopwright
