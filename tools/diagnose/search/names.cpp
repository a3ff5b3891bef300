#include "tools/diagnose/search/names.h"
#include <algorithm>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {

namespace {

bool has_no_name(const Member& member) { return member.candidate->is_unknown; }

}  // namespace

bool has_function_without_name(const std::vector<Member>& members) {
  return std::ranges::any_of(members, has_no_name);
}

std::vector<Member> named_members(std::vector<Member> members) {
  std::erase_if(members, has_no_name);
  return members;
}

double worth_losing_names(const Trials& trials) {
  return std::max(criteria::least_gain_without_name,
                  criteria::least_gain_without_name_per_row * double(fitted_numbers(trials)));
}

}  // namespace loopwright::diagnosis
