/// From nothing to a set of effects: extension, exchange and removal, each step confirmed by running the
/// diagram.
#pragma once
#include "tools/diagnose/evidence.h"

namespace loopwright::diagnosis {

struct SearchResult {
  Estimate estimate;               ///< noise as in the search
  std::vector<std::string> trail;  ///< what was tried and taken, for people who want to know
};

/// From the first prediction's motion, on which the shapes were computed.
/// `unknown`: forces without a name, tried when no further effect helps; effects that they make worthless go.
SearchResult search(Trials& trials, const std::vector<Candidate>& candidates,
                    const std::vector<Shape>& shapes, const std::vector<Candidate>& unknown,
                    const Motion& motion);

}  // namespace loopwright::diagnosis
