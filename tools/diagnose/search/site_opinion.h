/// The search at the sites, made again where noise decides: beside slow disturbances, and by simulation.
#pragma once
#include "tools/diagnose/search/site_search.h"

namespace loopwright::diagnosis {

/// Predictions of one sample blame what they miss on noise in the states. If a state is not measured, so much
/// of it may be found that it stands for a missing effect. The search is then made again for simulations,
/// whose errors may be slow but in which no noise moves a state. What is found there is the answer if it
/// simulates clearly better. Before that, what is left or has no name is searched again beside slow
/// disturbances: see site_disturbance.h. Null when the model diverges along the record, whatever its noise.
std::optional<SiteSearchResult> search_with_second_opinion(
    SiteFitter& fitter, const std::function<void(const char*, double)>& progress);

}  // namespace loopwright::diagnosis
