/// The guards of the transitions of a state machine: formulas over signals and parameters, with after(0.5 s).
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "blocks/math/formula.h"
#include "engine/block/instance_units.h"

namespace loopwright::blocks {

/// What a guard may name: the inputs of the machine, and parameters of the diagram.
struct GuardNames {
  std::vector<std::string> inputs;
  std::vector<NamedNumber> constants;
};

/// A text that is no guard.
struct GuardError {
  std::string message, found, hint;
  size_t offset = 0;  ///< in the text
};

/// A guard, checked and compiled. An empty text is always true. after(…) is true once the state that has the
/// transition has been active for the duration, which is a number with a unit of time or an expression over
/// parameters.
class Guard {
 public:
  Guard() = default;
  /// Throws GuardError.
  Guard(const std::string& text, const GuardNames& names);

  /// The values of the inputs must have been set. `samples`: since the state was entered, at least 1.
  double value(double samples, double sample_time) const;
  void set_input(size_t i, double value) const { formula_.variables[i] = value; }
  size_t inputs() const { return inputs_; }  ///< 0 of an empty text

  /// Whether it depends on neither inputs nor time.
  bool is_constant() const { return is_constant_; }
  bool reads(const std::string& input) const;
  bool waits() const { return !durations_.empty(); }
  const std::string& text() const { return text_; }
  /// Whether its comparisons are between equal units. `of_inputs` in the order of the names.
  UnitFinding compare_units(std::span<const Unit> of_inputs, const GuardNames& names) const;

 private:
  std::vector<std::string_view> variables(const GuardNames& names) const;

  std::string text_, formula_text_;
  std::vector<std::string> waiting_names_;  // variables in place of after(…)
  std::vector<double> durations_;           // s
  size_t inputs_ = 0, constants_ = 0;
  bool is_constant_ = true;
  mutable Formula formula_;  // belongs to one run: muParser has its own evaluation stack
};

}  // namespace loopwright::blocks
