/// The likelihood of noise from errors that were made with one set of gains, and its maximum.
#pragma once
#include <functional>
#include <vector>
#include "tools/diagnose/search/maximum_likelihood.h"

namespace loopwright::diagnosis {

/// Logarithms of the free parameters of a noise.
struct NoiseCoordinates {
  FreeNoise free;
  Noise start;

  std::vector<double> of(const Noise& noise) const;
  Noise at(const double* coordinates) const;
};

/// -2 ln L of the fitted rows of a record, but for a constant: the errors of `prediction`, made with the
/// gains `from`, as the gains `to` would make them. `error` is scratch.
double noise_misfit(const Trials& trials, size_t record, const LinearAxis& axis, const Prediction& prediction,
                    const Gains& from, const Gains& to, std::vector<double>& error);

/// Of all records, as the noise alone varies.
double noise_misfit(const Trials& trials, const std::vector<Fitted>& fitted, const Noise& noise,
                    std::vector<double>& error);

/// Where `misfit` is least between these bounds, without derivatives (BOBYQA, Powell 2009).
std::vector<double> least_misfit(const std::function<double(const double*)>& misfit,
                                 std::vector<double> start, const std::vector<double>& low,
                                 const std::vector<double>& high);

}  // namespace loopwright::diagnosis
