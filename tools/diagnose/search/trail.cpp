#include "tools/diagnose/search/trail.h"
#include <fmt/format.h>
#include <ranges>

namespace loopwright::diagnosis {

std::string names_of(const std::vector<Member>& members) {
  std::string names;
  for (const Member& member : members) {
    names += (names.empty() ? "" : " + ") + member.candidate->name;
    if (!member.candidate->form.empty()) names += " of " + member.candidate->form;
  }
  return names;
}

std::string described(const char* what, const Estimate& estimate, double criterion) {
  std::string line =
      fmt::format("{}: mean square {:.5g}, criterion {:.1f}:", what, estimate.mean_square, criterion);
  for (const Member& member : estimate.members) {
    line += fmt::format(" {}", member.candidate->name);
    if (member.candidate->is_unknown) line += " of " + member.candidate->form;
    for (double v : member.linear)
      if (!member.candidate->is_unknown) line += fmt::format(" {:.5g}", v);
    for (double v : member.nonlinear) line += fmt::format(" | {:.5g}", v);
    line += ",";
  }
  return line;
}

std::string described(const std::vector<Proposal>& proposals) {
  constexpr size_t most_told = 8;
  std::string line = "promised:";
  for (const Proposal& proposal : proposals | std::views::take(most_told))
    line += fmt::format(" {} {:.0f},", names_of(proposal.added), proposal.gain);
  return line;
}

}  // namespace loopwright::diagnosis
