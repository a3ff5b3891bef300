/// Whether prediction errors are white.
#pragma once
#include "tools/diagnose/search/maximum_likelihood.h"

namespace loopwright::diagnosis {

/// Σ e(k) e(k - lag) over the fitted rows, for lags from 0 to 40. Where rows are left out a lag has fewer
/// pairs: its sum is scaled so that white errors give it the variance that it has with a pair for every row.
struct LaggedProducts {
  std::vector<double> sum;
  double rows = 0;
};
/// Of one port, with this many rows added up.
LaggedProducts lagged_products(const Trials& trials, const std::vector<Fitted>& fitted, size_t port,
                               size_t together);
/// As many as make a lag of criteria::portmanteau_lag_s.
size_t rows_in_a_lag(const Trials& trials);

/// n Σ ρ² over 40 lags, of the port and the spacing at which it is greatest: rows, and sums of rows over a
/// millisecond. Near 40 when the errors are white.
double portmanteau(const Trials& trials, const std::vector<Fitted>& fitted);

/// Whether a set leaves small errors that are white, as far as a search can tell.
bool seems_explained(const Trials& trials, const Estimate& estimate);

/// The same of the squares of the errors: how much large errors keep together in time. Noise makes none of
/// it; a load that rattles, or anything that happens now and then, does.
double portmanteau_of_squares(const Trials& trials, const std::vector<Fitted>& fitted);

/// Whitened errors of each record, samples × ports.
using WhitenedErrors = std::vector<std::vector<double>>;
/// Those that the counts of the first sensor and the noise of this estimate would give if nothing were
/// missing. At slow or steady speeds counts are not white, and resemble a pattern or a mode: the smoothed
/// motion is counted anew, and goes through the predictor with random noise of every other kind. Noise of the
/// sensor may cover the pattern of the counts or not, and the noise forces may be smaller than they seem
/// beside coarse counts, whichever leaves more of it. Empty if the sensor states no resolution.
WhitenedErrors errors_of_counts(const Trials& trials, const Estimate& estimate);
/// What they add to the portmanteau.
double portmanteau_of_counts(const Trials& trials, const WhitenedErrors& errors);
/// The portmanteau of their squares: at steady speeds they may be none, and large between these.
double bursts_of_counts(const Trials& trials, const WhitenedErrors& errors);

}  // namespace loopwright::diagnosis
