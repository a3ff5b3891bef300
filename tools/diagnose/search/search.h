/// From the empty set to a set of effects: extension, exchange and removal, each step confirmed by running
/// the diagram.
#pragma once
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

struct SearchResult {
  Estimate estimate;               ///< noise used in the search
  std::vector<std::string> trail;  ///< what was tried and accepted, as information for the user
};

/// Starts from the motion of the first prediction, on which the shapes were computed. `unknown`: unnamed
/// forces, tried when no further effect helps. Effects that become unnecessary are removed.
SearchResult search(Trials& trials, const std::vector<Candidate>& candidates,
                    const std::vector<Shape>& shapes, const std::vector<Candidate>& unknown,
                    const Motion& motion);

/// Goes on from an answer that leaves something, with the members it has.
SearchResult search_on(Trials& trials, const std::vector<Candidate>& candidates,
                       const std::vector<Shape>& shapes, const std::vector<Candidate>& unknown,
                       const Motion& motion, const std::vector<Member>& members);

}  // namespace loopwright::diagnosis
