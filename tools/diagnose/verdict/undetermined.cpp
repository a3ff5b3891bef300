#include "tools/diagnose/verdict/undetermined.h"
#include <fmt/format.h>
#include <algorithm>

namespace loopwright::diagnosis {
namespace {

/// Its amplitude, or its only size; null: it has none, or several.
const DiagnosedParameter* size_of(const DiagnosedEffect& effect) {
  if (!effect.wave.empty()) return &effect.wave.front();
  const auto& list = effect.parameters;
  if (std::ranges::count_if(list, &DiagnosedParameter::is_linear) != 1) return nullptr;
  return &*std::ranges::find_if(list, &DiagnosedParameter::is_linear);
}

}  // namespace

std::string why_not_determined(const DiagnosedEffect& effect, double duration_s) {
  if (effect.is_optional) return {};
  if (const DiagnosedParameter* size = size_of(effect); size && size->low < 0 && size->high > 0)
    return fmt::format("the size of {} is not determined: the interval of its {} contains zero", effect.name,
                       size->name);
  const auto is_open_time = [&](const DiagnosedParameter& p) {
    return p.is_open && p.unit == "s" && p.high > duration_s;
  };
  const auto time = std::ranges::find_if(effect.parameters, is_open_time);
  if (time == effect.parameters.end()) return {};
  return fmt::format(
      "the {} of {} may be as long as any that is looked for: what changes over the record, and how it "
      "goes on, is not determined",
      time->name, effect.name);
}

}  // namespace loopwright::diagnosis
