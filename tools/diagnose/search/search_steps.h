/// The steps of a search for the effects of one set.
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/search.h"
#include "tools/diagnose/search/trail.h"

namespace loopwright::diagnosis {

/// Grows the set step by step: one effect more, or two, others in their place, those that are not needed
/// taken out. What it takes is its best set.
class Search {
 public:
  Search(Trials& trials, const std::vector<Candidate>& candidates, const std::vector<Shape>& shapes,
         const std::vector<Candidate>& unknown, const Motion& motion);

  SearchResult run();

  SearchResult run_on(const std::vector<Member>& members);

 private:
  /// In the noise of the present state of the search.
  double mean_square_now(const Estimate& e) const;
  /// The mean square after so many further steps, if each takes away as much as the last one did.
  double promised_mean_square(const Estimate& before, size_t further) const;
  double score(const Estimate& e) const { return criterion(trials_, e, candidates_.size()); }
  Estimate refined(const std::vector<Member>& members, int iterations);
  void note(const char* what);
  void note(const std::vector<Proposal>& proposals) { trail_.push_back(described(proposals)); }
  void take(Estimate better);

  /// What names for all gain over the best set, or what it loses for want of them.
  double worth_of_names(const std::vector<Member>& members) const;
  /// Improvement of the criterion of a trial over the best set, on the same rows, with the worth of names.
  double gain_of(Estimate& trial);
  Estimate refined_further(const Estimate& e) { return fit_members(trials_, e.members, noise_, e.motion, 2); }

  /// Shapes on the grid, and at the pitches and the instants that the present errors ask for. A jump has no
  /// name, but as few parameters as an effect: it need not wait until names have stood in for it.
  std::vector<const Shape*> all_shapes();
  /// All named effects, in addition to the best set.
  Evidence& evidence();

  /// Before it is compared; of a load on a spring, the best of its starts, once the large effects are found.
  Estimate first_fit(const Proposal& proposal);
  bool is_spent() const { return trials_.work->is_spent(most_work_); }
  bool is_much_left() const { return best_.mean_square >= criteria::much_left; }

  /// False when nothing more was found.
  bool grow(size_t most);
  bool extend();

  /// Beside a true maximum of how far back friction remembers there are narrow ones.
  void leave_narrow_maximum();

  /// A member that would be removed at the end is not accepted.
  bool adds_material(Estimate& trial);

  /// Forces that the catalogue does not contain.
  std::vector<const Shape*> shapes_without_name();
  /// The best two.
  std::vector<Proposal> without_name();
  void take_nameless(Estimate better);

  /// And the effects that had substituted for it.
  bool explain_without_name();

  /// Alternative initial sets: the best function of the variables alone, and with one effect.
  std::vector<std::vector<Member>> starts_without_name();

  /// The effects found first may only have substituted for an unnamed force: start again with that force
  /// included first. Whether the best set is one from which nothing more was found.
  bool start_from_what_has_no_name();

  /// False when nothing more was found. Not to the end if it cannot leave less than another set.
  bool grow_beside_function(const Estimate& other, const std::vector<std::vector<Member>>& starts);

  /// What has no name, for another function, with which no start begins: beside the effects that were found
  /// since, the errors may ask for one that they hid.
  void exchange_function(const std::vector<std::vector<Member>>& starts);

  /// Laws of one variable, for others of it that do better together.
  bool exchange_laws();

  /// The best of other sets, without what each does not need, if it gains more than `best_gain`.
  Estimate best_of(const std::vector<std::vector<Member>>& others, double& best_gain);

  /// A member, or two, for another: also an equally good one, if it makes others unnecessary.
  bool exchange();

  /// Whether one more member gains more than an exchange for as many does: it comes next.
  bool is_surpassed_by_extension(double gain);
  void prune();

  /// Once little is left to find, the noise level can be estimated from the remainder.
  void sharpen_noise();

  /// If what is left looks like noise that is louder than assumed, it is taken for that: gains of the
  /// predictor that are too small colour the errors, and bend what is fitted to them.
  bool rest_is_noise();

  const std::vector<Candidate>& unknown_;
  Trials& trials_;
  const std::vector<Candidate>& candidates_;
  const std::vector<Shape>& shapes_;
  Noise noise_;
  Motion motion_;  // motion along which the shapes were computed
  std::vector<Shape> timed_, nameless_;
  Estimate best_;
  std::optional<Evidence> evidence_;  // of best_
  double most_work_ = criteria::work_of_search;
  std::vector<std::string> trail_;
};

}  // namespace loopwright::diagnosis
