/// The states and transitions of a state machine, with indices in place of names.
#pragma once
#include <memory>
#include "blocks/logic/guard.h"

namespace loopwright::blocks {

struct ChartTransition {
  int to = 0;
  std::shared_ptr<const Guard> guard;
  std::vector<int> enters{};  ///< from the outermost to the one that is then active
};
struct ChartState {
  int parent = -1;
  int initial = -1;          ///< the state inside it that is entered with it; -1: there is none inside
  std::vector<int> chain{};  ///< the states that are active with it, from the outermost to itself
  std::vector<std::pair<int, double>> set{};   ///< outputs and their values on entry
  std::vector<ChartTransition> transitions{};  ///< in the order in which they are tested
};

struct StateChart {
  std::vector<ChartState> states;
  std::vector<int> enters;  ///< at the first sample

  /// A state with the states inside it that are entered by default.
  void add_defaults(int state, std::vector<int>& to) const {
    for (; state >= 0; state = states[size_t(state)].initial) to.push_back(state);
  }
  /// What a transition enters: all states inside the innermost one that contains both its ends, down to its
  /// target, and the defaults of that. A state is not inside itself: a transition to the same or to a
  /// containing state leaves that state and enters it again.
  std::vector<int> entered(int from, int to) const {
    const auto &a = states[size_t(from)].chain, &b = states[size_t(to)].chain;
    size_t common = 0;
    while (common + 1 < a.size() && common + 1 < b.size() && a[common] == b[common]) ++common;
    std::vector<int> result(b.begin() + ptrdiff_t(common), b.end() - 1);
    add_defaults(to, result);
    return result;
  }
};

}  // namespace loopwright::blocks
