/// Laws of one variable share what it explains. Added one at a time, each bends to what the others lack, and
/// a wrong law with too many parameters can stand for two right ones.
#pragma once
#include <optional>
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// All members that are laws of a variable, or functions of it without a name, replaced by other laws of it,
/// best first. None that is promised to lose more than `most_loss`, or has a candidate that was refused.
std::vector<Proposal> other_laws(const Trials& trials, const Estimate& estimate,
                                 const std::vector<Candidate>& candidates, LawOf variable, double most_loss,
                                 const std::vector<const Candidate*>& refused = {});

/// All members, with the most promising of them.
std::vector<std::vector<Member>> with_other_laws(const Trials& trials, const Estimate& estimate,
                                                 const std::vector<Candidate>& candidates, LawOf variable);

/// Several names for what depends on the velocity alone, if a function without a name explains much more.
/// `trail` receives what was tried.
std::optional<Estimate> function_of_velocity(Trials& trials, const Estimate& best,
                                             const std::vector<Candidate>& unknown, size_t catalogue,
                                             std::vector<std::string>& trail);

}  // namespace loopwright::diagnosis
