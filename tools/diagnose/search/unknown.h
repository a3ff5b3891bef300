/// Unnamed forces: any smooth function of a few variables, for effects that the catalogue does not contain.
#pragma once
#include <utility>
#include "tools/diagnose/search/candidate.h"
#include "tools/effects/effect.h"

namespace loopwright::diagnosis {

/// Functions of position, of velocity, of time, of position with the direction (a position-dependent dry
/// friction), with the velocity (a position-dependent damping) or with the acceleration (a position-dependent
/// mass), a tone and a jump in time. `form` lists the variables, separated by commas. For a map of balances,
/// only position and direction. `has_mass`: the diagram has one to which the mean of a position-dependent
/// mass can be added; otherwise all of it is a force.
std::vector<Candidate> unknown_forces(const RecordSizes& sizes, bool is_map, bool has_mass);

/// [s] From the first row: over which a function of time is fitted. Before it no row counts.
std::pair<double, double> range_of_time(const RecordSizes& sizes);
/// [s] From the first row, of each row, and of the end of the last one.
std::vector<double> times_of(const Path& path);

constexpr size_t spline_degree = 3;
/// A function's value from its levels at a fraction of its range: a cubic spline over levels - 3 uniform
/// intervals.
double spline_at(const std::vector<double>& levels, double fraction);
/// [position] The distance over which "direction" changes its sign.
double transition_of_direction(const RecordSizes& sizes);

}  // namespace loopwright::diagnosis
