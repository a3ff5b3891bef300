/// Other names for what terms do: a constant and a proportion for a law beyond a level, an offset of a sensor
/// for a constant, and an error of a sensor for all that was found.
#pragma once
#include <optional>
#include <span>
#include <vector>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// Whether the term's level is near an end of the range of its signal: see criteria::edge_of_level.
bool is_at_edge(const SiteTerm& term);

/// The hypothesis with a constant and a proportion, its last terms, in the place of a law beyond a level.
/// Nothing if the term is none.
std::optional<SiteHypothesis> with_constant_and_proportion(SiteFitter& fitter, const SiteHypothesis& at,
                                                           size_t term);

struct OffsetOfSensor {
  SiteHypothesis hypothesis;  ///< all parameters as stated; its last term is the offset
  size_t of;                  ///< the constant in whose place
};
/// Of sensors that the search does not look at, for each constant that was found.
std::vector<OffsetOfSensor> offsets_of_sensors(SiteFitter& fitter, const SiteHypothesis& at);

/// Each hypothesis with one sensor that the search does not look at with an offset, with another scale, or
/// with both, which are its last terms; those that come near what was found. A plant that is fed back on what
/// it measures answers such an error with several laws. `least_gain` in -2 ln L: of a second term.
std::vector<SiteHypothesis> with_error_of_one_sensor(SiteFitter& fitter, const SiteHypothesis& found,
                                                     std::span<const SiteHypothesis> hypotheses,
                                                     double least_gain);

}  // namespace loopwright::diagnosis
