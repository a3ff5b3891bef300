/// A formula as the list of its operations, as they are written and in the order in which muParser executes
/// them: what occurs more than once is computed once, and what depends on constants alone before the run.
/// muParser joins some of its numbers first (x + 1 + 2 as x + 3, 2*x as 2*x + 0), which may change the last
/// bit or the sign of a zero. A formula of which tried values differ is left to it.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace loopwright {

class FormulaSteps {
 public:
  /// Nothing for a formula that muParser cannot read, or that computes some of its parts only sometimes
  /// (`c ? a : b`) or other than these steps.
  static std::optional<FormulaSteps> of(const std::string& formula,
                                        const std::vector<std::string_view>& names);

  /// The values of the variables, in the order of their names.
  std::span<double> variables() { return std::span(values_).first(variables_); }
  /// From this variable on they are constant until the next call: what follows from them is computed.
  void keep_constant_from(size_t first);
  /// At the values of the variables.
  double value();

 private:
  friend class FormulaNotes;
  enum class Kind { add, subtract, multiply, divide, one, two, many };
  struct Step {
    Kind kind;
    int to = 0, first = 0, second = 0;  // of the values; of many: of `arguments_`, and their number
    union {
      double (*one)(double);
      double (*two)(double, double);
      double (*many)(const double*, int);
    };
    bool operator==(const Step& other) const;
  };
  void execute(const Step& step);

  size_t variables_ = 0;
  std::vector<double> values_;  // of the variables, numbers and steps
  std::vector<Step> steps_;     // that depend on what is not constant
  std::vector<Step> all_;
  std::vector<int> arguments_;     // of functions of many numbers
  std::vector<double> collected_;  // their values
  int result_ = 0;
};

}  // namespace loopwright
