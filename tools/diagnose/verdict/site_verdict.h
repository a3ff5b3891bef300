/// What may be said about any diagram after the search at its sites.
#pragma once
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/search/site_search.h"

namespace loopwright::diagnosis {

/// The one whose errors are told.
void show_output(const RecordedOutput& output, Diagnosis& result);

/// Effects, moved parameters, errors of prediction and simulation, verdict, and what the record cannot show.
void tell_sites(SiteFilter& filter, const SiteSearchResult& search, Diagnosis& result);

}  // namespace loopwright::diagnosis
