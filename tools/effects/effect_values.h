/// The numbers behind an effect's expressions.
#pragma once
#include <map>
#include <string>
#include <string_view>
#include "tools/effects/effect.h"

namespace loopwright {

/// Names and numbers in SI; units were checked when the effect was loaded and when its blocks were compiled.
class EffectValues {
 public:
  explicit EffectValues(const RecordSizes& sizes);
  void set(std::string_view name, double value) { numbers_[std::string(name)] = value; }
  double at(std::string_view name) const { return numbers_.find(name)->second; }
  /// Computes every parameter that is not fitted from the fitted ones.
  void work_out(const Effect& effect);
  /// A number as written, or the result of an expression; NaN if it cannot be computed.
  double evaluate(const Value& value) const;
  /// A number or an expression as the text of a quantity with the unit that follows from those of the effect's
  /// parameters on this machine: {"value": 3, "unit": "N*s/m"}. A bare number where there is none.
  std::string with_unit(const Value& value, const Effect& effect, const MachineUnits& units) const;

 private:
  std::map<std::string, double, std::less<>> numbers_;
};

/// Quantities, the given fitted values (in the order of the fitted parameters), and the values computed from
/// them.
EffectValues values_of(const Effect& effect, const RecordSizes& sizes, const std::vector<double>& fitted);

}  // namespace loopwright
