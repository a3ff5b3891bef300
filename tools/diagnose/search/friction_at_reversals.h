/// Which law of dry friction the rows right after the reversals show. The fit leaves them out: the instant at
/// which friction turns is known only to within a sample or two, and whatever is wrong there is wrong for
/// some time. But it is there that the laws differ: presliding hysteresis builds up over a distance, and
/// friction that falls with speed is largest.
#pragma once
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

class FrictionAtReversals {
 public:
  /// The estimate is only read. `shapes`: where the fits of other laws begin; of those that were refused none
  /// is asked.
  FrictionAtReversals(Trials& trials, const Estimate& estimate, const std::vector<Shape>& shapes,
                      size_t catalogue, const std::vector<const Candidate*>& refused);

  /// With another law in place of the present one: it explains the rows after reversals, and the present one
  /// does not. These rows count from then on, until forget_reversals(): they determine its parameters.
  std::optional<Estimate> better();
  /// Laws that do a little better, or with a parameter at the end of its range, or that only rows show which
  /// nothing explains: not found, and not excluded either.
  struct Law {
    size_t member;
    const Candidate* candidate;
  };
  const std::vector<Law>& not_excluded() const { return not_excluded_; }
  /// Whether friction falls with speed so slowly that more than the first moments of a motion show it.
  bool is_resolved(const Member& law) const;
  /// Whether the present law explains the rows after reversals, and that of `other` in its place does not.
  /// `other`: fitted to the rows that count, and like the estimate but for the law.
  bool is_refuted(size_t member, const Candidate& law, const Estimate& other);

 private:
  struct Rows {
    Estimate fitted;              ///< to all of them
    double mean_square = 0;       ///< after reversals
    std::vector<double> squares;  ///< after each reversal
  };
  /// Where the rows after reversals are a large part of the motion, and the present law does not explain
  /// them, one that differs from it only there may be the true one.
  void exclude_none();
  Rows on_all_rows(const std::vector<Member>& members, int iterations);
  std::vector<std::vector<double>> best_shapes(size_t member, const Candidate& law);
  Rows with_law(size_t member, const Candidate& law);
  double gain(const Rows& from, const Rows& to) const;
  bool explains(const Rows& one, const Rows& other, double least_gain) const;

  Trials& trials_;
  const Estimate& estimate_;
  const std::vector<Shape>& shapes_;
  size_t catalogue_;
  const std::vector<const Candidate*>& refused_;
  std::vector<std::vector<char>> rows_;  ///< those that count, and those after reversals
  size_t after_reversals_ = 0;
  Rows present_;
  std::vector<Law> not_excluded_;
};

/// Leaves the rows after reversals out again, as for a set without the law that they chose. Whether any
/// counted.
bool forget_reversals(Trials& trials);

}  // namespace loopwright::diagnosis
