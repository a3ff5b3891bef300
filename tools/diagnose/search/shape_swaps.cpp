#include "tools/diagnose/search/shape_swaps.h"
#include <algorithm>

namespace loopwright::diagnosis {

std::vector<Proposal> shape_swaps(const std::vector<Member>& members,
                                  const std::vector<Candidate>& candidates) {
  std::vector<Proposal> list;
  const auto is_member = [&](const Candidate& c) {
    return std::ranges::find(members, &c, &Member::candidate) != members.end();
  };
  for (size_t m = 0; m < members.size(); ++m)
    for (const Candidate& other : candidates) {
      if (!members[m].candidate->amplitude_is_one || !other.amplitude_is_one || is_member(other)) continue;
      const CandidateParameter& range = other.nonlinear[0];
      Member member{&other, {1}, {std::clamp(members[m].nonlinear[0], range.low, range.high)}};
      std::vector<Member> rest = members;
      rest.erase(rest.begin() + std::ptrdiff_t(m));
      list.push_back({{m}, {std::move(member)}, std::vector<double>(free_parameters(rest).size()), 0});
    }
  return list;
}

}  // namespace loopwright::diagnosis
