/// Unit expressions in the description of a block type: products of SI units and $names.
#pragma once
#include <deque>
#include <string_view>
#include <unordered_map>
#include <vector>
#include "engine/block/info.h"

namespace loopwright {

struct UnitFactor {
  int variable;  // of the block type
  double exponent;
};
/// constant · Π variable^exponent, as in the description of a port.
struct UnitExpression {
  Unit constant;
  std::vector<UnitFactor> factors;
};

/// The unit variables in the description of a block type, numbered.
class TypeUnits {
 public:
  explicit TypeUnits(const BlockInfo& info);
  const UnitExpression& of_input(size_t input) const { return *inputs_[input]; }
  const UnitExpression& of_output(size_t output) const { return *outputs_[output]; }
  const UnitExpression& of(std::string_view unit) const { return parsed_.at(unit); }
  size_t variables() const { return names_.size(); }
  /// Whether a variable is the position of a moving part. If it is dimensionless, it is an angle.
  bool is_position(int variable) const { return variable == position_; }
  int position() const { return position_; }  ///< that variable; -1: none

 private:
  void add_parameter(const ParameterInfo& parameter);
  const UnitExpression& add(std::string_view text);
  UnitExpression parse(std::string_view text);
  int variable(std::string_view name);

  std::vector<std::string_view> names_;
  std::unordered_map<std::string_view, UnitExpression> parsed_;
  std::vector<const UnitExpression*> inputs_, outputs_;
  int position_ = -1;  // none
};

}  // namespace loopwright
