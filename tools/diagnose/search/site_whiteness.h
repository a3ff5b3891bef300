/// Whether the errors of a pass are white.
#pragma once
#include "tools/diagnose/predict/site_filter.h"

namespace loopwright::diagnosis {

/// ρ of the whitened errors of an output at one to criteria::portmanteau_lags lags, in the first rows.
std::vector<double> correlations_of(const SitePass& pass, size_t output, size_t rows);
/// n Σ ρ² of the whitened errors of an output over criteria::portmanteau_lags lags, in the first rows; near
/// the number of lags when white.
double portmanteau_of(const SitePass& pass, size_t output, size_t rows);
/// Of the worst output, over all rows of the pass.
double portmanteau_of(const SitePass& pass);

}  // namespace loopwright::diagnosis
