/// Whether the errors of a pass are white.
#pragma once
#include "tools/diagnose/predict/site_filter.h"

namespace loopwright::diagnosis {

/// ρ of the whitened errors of an output at one to criteria::portmanteau_lags lags, in the first rows.
std::vector<double> correlations_of(const SitePass& pass, size_t output, size_t rows);
/// n Σ ρ² of the whitened errors of an output over criteria::portmanteau_lags lags, in the first rows; near
/// the number of lags when white.
double portmanteau_of(const SitePass& pass, size_t output, size_t rows);
/// Of the worst output, over all rows of the pass, without those that are predicted to within the counts of
/// their sensors: what counts leave has a pattern of its own.
double portmanteau_beside_counts(const SitePass& pass, const SignalRecord& record);
/// Largest rms error of predictions that counts alone may make; 0: no resolution is stated.
double most_error_of_counts(const RecordedOutput& output);

}  // namespace loopwright::diagnosis
