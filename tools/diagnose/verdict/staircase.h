/// The effects ordered by weight, and the error after each, for presentation. The order in which the search
/// found them is not shown, because it is often wrong.
#pragma once
#include "tools/diagnose/search/conclude.h"
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/search/remaining_force.h"

namespace loopwright::diagnosis {

struct Staircase {
  std::vector<size_t> order;                 ///< of the members, largest weight first
  std::vector<DiagnosisStep> steps;          ///< the nominal diagram, then one step per effect
  std::vector<std::vector<Member>> members;  ///< of each step, all that it has, fitted together
  std::vector<std::vector<size_t>> added;    ///< to each step: indices of the conclusion's members

  /// Steps up to the last one that is not optional.
  size_t necessary() const;
};

/// "cogging", "an unknown force of position".
std::string shown_name(const Candidate& candidate);
/// The same with the instant of a jump, by the clock of the record.
std::string shown_name(const Member& member, const Trials& trials);

/// Removes the members again, each time the least important one; the remaining ones are fitted again.
/// Corrections of the nominal diagram's own mass and damping are removed with the effect without which they
/// have no benefit.
Staircase climb(Trials& trials, const Conclusion& conclusion, const std::vector<InverseDynamics>& inverse,
                size_t catalogue);

}  // namespace loopwright::diagnosis
