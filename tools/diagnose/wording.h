/// Formats quantities and lists for text and page of a diagnosis.
#pragma once
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>
#include "tools/diagnose/diagnosis.h"
#include "tools/report/typography.h"

namespace loopwright {

/// "3.2 mN"
inline std::string shown(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "–";
  const report::Quantity q = report::engineering(value, unit);
  return q.unit.empty() ? q.value : fmt::format("{} {}", q.value, q.unit);
}

struct ShownInterval {
  std::string value, low, high;
  std::string range() const { return low + " … " + high; }
};
/// With as many digits as tell the ends from the value.
inline ShownInterval shown_interval(double value, double low, double high, const std::string& unit) {
  constexpr int usual = 4, most = 10;
  const auto with = [&](double number, int digits) {
    return std::isfinite(number) ? report::shown(number, unit, digits) : shown(number, unit);
  };
  ShownInterval text{shown(value, unit), shown(low, unit), shown(high, unit)};
  const auto is_told = [&] {
    return (text.low != text.value || low == value) && (text.high != text.value || high == value);
  };
  for (int digits = usual + 1; digits <= most && !is_told(); ++digits)
    text = {with(value, digits), with(low, digits), with(high, digits)};
  return text;
}

/// The effect's name in the catalogue, as words.
inline std::string words(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// "cogging and spring", with " and "
inline std::string joined(const std::vector<std::string>& names, const char* with) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : with) + name;
  return text;
}

/// What would explain as much in the place of what was found.
inline std::string words_of(const OtherExplanation& other, const char* with) {
  return other.effects.empty() ? "something small without a name" : joined(other.effects, with);
}

/// When most of the remainder occurs; empty: it is no event.
inline std::string words_of_interval(const Diagnosis& d) {
  if (!d.remainder_interval) return {};
  const RemainderInterval& when = *d.remainder_interval;
  const std::string which = d.experiments.size() > 1 ? fmt::format("record {}", when.record) : "the record";
  return fmt::format("Most of what is left occurs between {:.4g} s and {:.4g} s of {}.", when.from_s,
                     when.to_s, which);
}

inline std::string words_of(const MovedPort& moved) {
  return fmt::format(
      "With the improved diagram, the experiment must name {} in the place of {}: otherwise it does not "
      "reach the added effect.",
      joined(moved.to, " and "), moved.from);
}

/// Effects that are there, but too small to matter.
inline std::string words_of_small_effects(const Diagnosis& d) {
  std::vector<std::string> names;
  for (const TooSmallEffect& e : d.too_small) names.push_back(e.effect);
  const TooSmallEffect& best = d.too_small.front();
  return fmt::format("Seen, but too small to matter: {}, {} rms, {:.2g} % of the driving force",
                     joined(names, " or "), shown(best.force_rms, d.force_unit), 100 * best.share);
}

/// How the improved diagram was written, if it was.
std::string words_of_improvement(const Diagnosis& diagnosis);

}  // namespace loopwright
