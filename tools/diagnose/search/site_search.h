/// The search for what a diagram lacks, at any of its sites: docs/diagnose.md, "Any diagram".
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/site_ranking.h"
#include "tools/diagnose/search/term_text.h"

namespace loopwright::diagnosis {

/// A term that explains the record as well as one of the found ones.
struct SiteRival {
  size_t of = 0;  ///< the found term
  SiteTerm term;
  double worse = 0;  ///< by how much its criterion is higher
};

/// Other parameters that explain the record as well.
struct ParameterRival {
  std::vector<int> moved;       ///< instead of those that moved
  std::vector<SiteTerm> terms;  ///< a term in place of all moved parameters, if not empty
  double worse = 0;
  std::optional<size_t> of = std::nullopt;  ///< and of this found term
  bool of_all_terms = false;                ///< and of all of them
  bool keeps_parameters = false;            ///< those that moved stay so
};

/// A site at which noise of this share of its size was found.
struct NoisySite {
  int site;
  double share;
};
/// What was found by simulation beside what was found by predictions, see site_opinion.h.
struct SecondOpinion {
  std::vector<NoisySite> noisy;    ///< why it was asked for
  std::vector<int> unmeasured;     ///< states on which no output depends directly
  bool is_lost = false;            ///< small deviations grow: no simulation was asked
  bool is_not_asked = false;       ///< no work was left for it
  bool is_answer = false;          ///< what was found by simulation is the answer
  std::vector<std::string> other;  ///< terms and parameters that are not the answer
  bool agrees = false;             ///< they are the same, but for these that help no simulation:
  std::vector<std::string> idle = {};
  bool predicts_worse = false;  ///< it simulates better, and predicts much worse than one that explains all
  /// Nothing tells the answer from noise that does as well.
  bool is_open() const {
    const bool is_much_worse =
        error && (!other_error || *other_error > criteria::much_worse_opinion * *error);
    return !is_lost && !is_not_asked && !is_answer && !agrees && !is_much_worse;
  }
  /// [unit of the first output] rms by which simulations with the answer and with the other miss it; nothing
  /// if one diverges.
  std::optional<double> error, other_error;
};

struct SiteSearchResult {
  SiteHypothesis nominal;     ///< the diagram as it is, with its best noise
  SiteHypothesis parameters;  ///< all parameters free
  SiteHypothesis found;
  std::vector<SiteRival> rivals;
  std::vector<ParameterRival> parameter_rivals;
  std::vector<SiteHypothesis> steps;  ///< as terms were accepted
  std::vector<std::string> trail;
  std::optional<SecondOpinion> second_opinion;
};

/// Errors by which a search judges.
enum class ErrorsOf { predictions, simulation };

/// Null when the model diverges along the record, whatever its noise. Predictions may be beside slow
/// disturbances, given as a first guess.
std::optional<SiteSearchResult> search_sites(SiteFitter& fitter,
                                             const std::function<void(const char*, double)>& progress,
                                             ErrorsOf errors = ErrorsOf::predictions,
                                             const std::vector<SlowNoise>& disturbances = {});

}  // namespace loopwright::diagnosis
