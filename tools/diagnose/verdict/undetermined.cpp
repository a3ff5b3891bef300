#include "tools/diagnose/verdict/undetermined.h"
#include <fmt/format.h>
#include <algorithm>

namespace loopwright::diagnosis {

std::string why_not_determined(const DiagnosedEffect& effect) {
  if (effect.is_optional) return {};
  const auto may_be_zero = [](const DiagnosedParameter& p) {
    return !p.is_linear || (p.low < 0 && p.high > 0);
  };
  const auto first = std::ranges::find_if(effect.parameters, &DiagnosedParameter::is_linear);
  if (first != effect.parameters.end() && std::ranges::all_of(effect.parameters, may_be_zero))
    return fmt::format("the size of {} is not determined: the interval of its {} contains zero", effect.name,
                       first->name);
  const auto is_open_time = [](const DiagnosedParameter& p) { return p.is_open && p.unit == "s"; };
  const auto time = std::ranges::find_if(effect.parameters, is_open_time);
  if (time == effect.parameters.end()) return {};
  return fmt::format(
      "the {} of {} may be as long as any that is looked for: what changes over the record, and how it "
      "goes on, is not determined",
      time->name, effect.name);
}

}  // namespace loopwright::diagnosis
