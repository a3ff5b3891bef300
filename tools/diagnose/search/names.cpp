#include "tools/diagnose/search/names.h"
#include <algorithm>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {

bool has_function_without_name(const std::vector<Member>& members) {
  return std::ranges::any_of(members, [](const Member& m) { return m.candidate->is_unknown; });
}

double worth_losing_names(const Trials& trials) {
  return std::max(criteria::least_gain_without_name,
                  criteria::least_gain_without_name_per_row * double(fitted_numbers(trials)));
}

}  // namespace loopwright::diagnosis
