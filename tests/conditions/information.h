#ifndef CONDITIONS_INFORMATION_H
#define CONDITIONS_INFORMATION_H

#include "simulate.h"

/// How much the record gains in −2 ln L by each effect: the true model against the one without the effect,
/// with the strengths of the others fitted again.
///
/// The prediction errors of a linear model (Kalman filter of the true masses, dampings and springs, with the
/// noise of the record) change by e with the force f of an effect, where δ[k + 1] = A (δ[k] − K C δ[k]) + B
/// f[k], e[k] = C δ[k]/√S. The gain is Σ e² after a projection onto what the others leave. Only rows in
/// motion carry force: friction at rest is not determined.
void information(const Setting* setting, const Physics stages[], const Effect effects[], int count,
                 const Log* log, double gains[]);

#endif
