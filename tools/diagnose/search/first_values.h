/// With what the fits of shapes begin: values of their own parameters from the signal, and their ranges.
#pragma once
#include <array>
#include <span>
#include <vector>
#include "tools/diagnose/search/shape.h"

namespace loopwright::diagnosis::first_values {

using Starts = std::vector<std::array<double, most_nonlinear>>;

Starts widths(std::span<const double> signal);
Starts knees(std::span<const double> signal);
Starts stribeck_speeds(std::span<const double> signal);
Starts levels(std::span<const double> signal);
Starts levels_above(std::span<const double> signal);
Starts pitches(std::span<const double> signal);
Starts waits(std::span<const double> input);
Starts distances(std::span<const double> velocity);
TermShape::Ranges ranges_of_distance(std::span<const double> velocity);

}  // namespace loopwright::diagnosis::first_values
