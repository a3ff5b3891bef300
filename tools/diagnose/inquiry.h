/// What can be concluded from the records of one axis.
#pragma once
#include <functional>
#include "tools/diagnose/search/catalogue.h"
#include "tools/diagnose/search/conclude.h"
#include "tools/diagnose/search/search.h"

namespace loopwright::diagnosis {

/// The records of one axis, and what can be concluded from them with the effects of a catalogue.
class Inquiry {
 public:
  Inquiry(Trials& trials, const Motion& motion, const Catalogue& catalogue, const RecordSizes& sizes,
          const std::function<void(const char*, double)>& progress);

  /// From the fitted rows; from all rows where those that were to be held out show something else.
  Conclusion with_names();
  Conclusion without_names();
  /// The same without a member, which is refused from now on. What was found beside it may have needed it.
  Conclusion without(const Conclusion& conclusion, size_t member);
  /// Nothing is held out then.
  bool fits_all_rows() const { return fits_all_rows_; }
  double held_out_mean_square() const { return mean_square(trials_, *on_all_rows_.fitted, true); }
  /// The motion of the last conclusion, including held-out rows.
  const Motion& motion_of_all_rows() const { return on_all_rows_.motion; }

 private:
  /// Of the records from these rows on.
  bool explains_rows_from(std::vector<size_t> rows, const Estimate& estimate);
  SearchResult searched();
  /// After what was tried before.
  Conclusion concluded(std::vector<std::string> trail, const Estimate& found);
  /// Where at most half of the conclusion is of the set that was `searched`, and it leaves something, or
  /// where it gives a part no name: what the search finds beside its names, if that leaves nothing and is
  /// better.
  Conclusion gone_on(Conclusion conclusion, const std::vector<Member>& searched);
  bool is_better(const Conclusion& next, const Conclusion& before);
  /// What was found in fewer rows, fitted again, where it explains all of them or no work is left; otherwise
  /// what a search finds.
  Conclusion with_all_rows(std::vector<std::string> trail, const Estimate& found);
  /// The noise of the search is known only partly.
  Estimate with_fitted_noise(Estimate estimate);
  /// Whether the held-out rows are explained much worse than the fitted rows.
  bool holds_out_something_else(const Estimate& estimate);
  /// They are computed again only if other rows are fitted.
  const std::vector<Shape>& shapes_along_fitted_rows();
  void look_at_all_rows(const Estimate& estimate);

  Trials& trials_;
  const Motion& motion_;
  const Catalogue& catalogue_;
  const std::vector<Candidate> unknown_;
  const std::function<void(const char*, double)>& progress_;
  Motion fitted_motion_;
  std::vector<Shape> shapes_;  // along it
  std::vector<size_t> rows_of_shapes_;
  std::vector<const Candidate*> refused_;
  Estimate on_all_rows_;
  bool fits_all_rows_ = false;
};

}  // namespace loopwright::diagnosis
