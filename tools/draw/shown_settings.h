/// The effective parameters of a block as a picture shows them.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>
#include "engine/block/registry.h"

namespace loopwright {

/// Effective parameters of a plan: path → value as JSON, perhaps with a unit.
using EffectiveSettings = std::map<std::string_view, std::string_view>;

class ShownSettings {
 public:
  /// `units` turns the unit of a parameter, "$y/$u", into the one at hand, "N/V"; empty if it is not known.
  ShownSettings(const BlockType& type, std::string path, const EffectiveSettings& effective,
                std::function<std::string(std::string_view)> units);

  const std::string& type() const { return type_.info.type; }
  const std::string& room() const { return type_.info.room; }
  std::string text(std::string_view parameter) const;             ///< without quotes; empty if there is none
  double number(std::string_view parameter) const;                ///< SI; NaN if there is none
  std::vector<double> numbers(std::string_view parameter) const;  ///< of a flat list; empty otherwise
  /// "4 N/m", "40 mm": short, with the unit at hand; empty if it is no number.
  std::string quantity(std::string_view parameter) const;
  /// All parameters, "gain = 4 N/m", one a line; long lists are shortened.
  std::string all() const;

 private:
  std::string_view effective(std::string_view parameter) const;
  std::string unit_of(std::string_view parameter, std::string_view value) const;

  const BlockType& type_;
  std::string path_;
  const EffectiveSettings& effective_;
  std::function<std::string(std::string_view)> units_;
};

}  // namespace loopwright
