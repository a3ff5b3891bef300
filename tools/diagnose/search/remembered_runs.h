/// What the search asks for again and again: it returns to the same set, on the same motion and with the same
/// noise, whenever it compares it with another one, and each time a run along the records costs the most.
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include "tools/diagnose/search/hypothesis.h"

namespace loopwright::diagnosis {

struct Shape;
using Shapes = std::shared_ptr<const std::vector<Shape>>;

/// The last runs, and the sensitivities of the very last ones. They are the same numbers as computed anew.
class RememberedRuns {
 public:
  /// run_members(), unless the same is remembered.
  Results run(Trials& trials, const std::vector<Member>& members, const Motion& motion, const Noise& noise);
  /// sensitivity() of every record; `results` are of these members on this motion.
  std::shared_ptr<const std::vector<Sensitivity>> sensitivities(const Trials& trials,
                                                                const std::vector<Member>& members,
                                                                const Motion& motion, const Results& results);
  /// Shapes of candidates along a motion, made `anew` unless they are remembered.
  Shapes shapes(const std::vector<const Candidate*>& candidates, const Motion& motion,
                const std::function<std::vector<Shape>()>& anew);

 private:
  /// A result on a record of 56 s at 1 kHz has 3 MB.
  static constexpr size_t most_runs = 8;
  /// Of laws of the velocity, and of the position.
  static constexpr size_t most_shaped = 2;
  /// Each parameter has a column; functions without a name have up to sixty. In all, at most [numbers]:
  static constexpr size_t most_sensitivities = 3, most_numbers = 20'000'000;

  /// What determines a run, bit by bit.
  struct Question {
    std::vector<const Candidate*> candidates;
    std::vector<double> numbers;  ///< of the members, then of the noise
    std::vector<uint64_t> paths;
    std::vector<size_t> rows;
    bool operator==(const Question&) const = default;
  };
  struct Run {
    Question question;
    Results results;
  };
  struct Sensitive {
    Results results;
    std::vector<FreeParameter> free;  ///< a pitch may be held or fitted
    std::shared_ptr<const std::vector<Sensitivity>> sensitivities;
  };
  struct Shaped {
    std::vector<const Candidate*> candidates;
    std::vector<uint64_t> paths;
    Shapes shapes;
  };
  static std::vector<uint64_t> identities(const Motion& motion);
  /// Paths without an identity may change.
  static bool may_change(const std::vector<uint64_t>& paths);
  static Question question_of(const Trials& trials, const std::vector<Member>& members, const Motion& motion,
                              const Noise& noise);
  static size_t numbers_of(const Sensitive& sensitive);
  void keep(Sensitive sensitive);

  std::deque<Run> runs_;             // the one used last at the end
  std::deque<Sensitive> sensitive_;  // the same
  std::deque<Shaped> shaped_;        // the same
};

}  // namespace loopwright::diagnosis
