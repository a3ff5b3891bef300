/// Laws of one variable share what it explains. Added one at a time, each bends to what the others lack, and
/// a wrong law with too many parameters can stand for two right ones.
#pragma once
#include <optional>
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// All members that are laws of a variable ("velocity", "position"), or functions of it without a name,
/// replaced by other laws of it, best first. None that loses more than `most_loss`. Empty: there are none.
std::vector<Proposal> other_laws(const Trials& trials, const Estimate& estimate,
                                 const std::vector<Candidate>& candidates, const std::string& variable,
                                 double most_loss);

/// The best of them with noise of its own, if it is better; `trail` receives what was tried.
std::optional<Estimate> better_laws(Trials& trials, const Estimate& best,
                                    const std::vector<Candidate>& candidates, const std::string& variable,
                                    std::vector<std::string>& trail);

/// Several names for what depends on the velocity alone, if a function without a name explains much more.
std::optional<Estimate> function_of_velocity(Trials& trials, const Estimate& best,
                                             const std::vector<Candidate>& unknown, size_t catalogue,
                                             std::vector<std::string>& trail);

}  // namespace loopwright::diagnosis
