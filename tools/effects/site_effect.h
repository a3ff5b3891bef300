/// An effect that any diagram may lack, at a site of a kind: a formula of one signal (docs/effects.md).
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "engine/json/value.h"
#include "engine/json/problem.h"

namespace loopwright {

/// Numbers of a signal along a record, in its unit, over which ranges are expressions.
struct SignalSizes {
  double lowest = 0, highest = 0, largest = 0, rms = 0;  ///< largest: of the absolute values
};

struct SiteEffectParameter {
  std::string name, description;
  bool is_linear = false;  ///< the term is proportional to it
  double power = 0;        ///< of a linear one: its unit is that of the site over that of the signal^power
  Value low, high;         ///< of others, in the unit of the signal: numbers or expressions over its sizes
  int points = 0;          ///< values of the range at which a search starts
  bool is_logarithmic = false;  ///< they are spaced by a ratio
  Place place;
};

struct SiteEffect {
  std::string name, title, physics, path;
  std::vector<std::string> sites;               ///< kinds of sites, see site_kinds(); any if empty
  std::vector<std::string> signals;             ///< kinds of signals; any if empty
  bool is_distortion = false;                   ///< of the site's own signal
  std::string formula;                          ///< of "signal" and the parameters
  std::vector<SiteEffectParameter> parameters;  ///< the linear ones first
};

inline constexpr size_t most_linear_parameters = 2, most_other_parameters = 2;
inline constexpr double most_site_points = 400;  ///< of the range of a parameter

/// What a port measures, as far as its unit tells; "level" and "torque" are other words for position and
/// force.
const std::vector<std::string>& site_kinds();

/// Nothing after a problem, and for an effect of an axis, which has no "site".
std::optional<SiteEffect> load_site_effect(const std::string& path, Problems& problems);

/// Those of all effect files of the folders, sorted by name; a repeated name replaces the earlier one.
std::vector<SiteEffect> load_site_effects(const std::vector<std::string>& folders, Problems& problems);

struct SignalRange {
  double low = 0, high = 0;
};
SignalRange range_of(const SiteEffectParameter& parameter, const SignalSizes& sizes);

}  // namespace loopwright
