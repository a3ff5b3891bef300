// The shapes of a diagnosis without roles as expressions in a diagram.
#include "tools/diagnose/search/shape.h"
#include <gtest/gtest.h>
#include "engine/diagram/formula_parser.h"
#include "engine/diagram/in_memory.h"
#include "engine/plan/plan.h"

namespace loopwright::diagnosis::shape_test {
namespace {

constexpr double reference = 300;

struct Filled {
  explicit Filled(const TermShape& s) : shape(s) {
    for (int c = 0; c < shape.columns && shape.of != TermShape::Of::own; ++c)
      numbers.emplace_back(shape.coefficients[size_t(c)], 0.7 + c);
    for (int p = 0; p < shape.nonlinear_count(); ++p)
      numbers.emplace_back(shape.nonlinear[size_t(p)], own[size_t(p)]);
    numbers.emplace_back("reference", reference);
  }
  double evaluated(double signal) const {
    double columns[most_columns], sum = 0;
    shape.evaluate(signal, own.data(), columns);
    if (shape.of == TermShape::Of::own) return columns[0];
    for (int c = 0; c < shape.columns; ++c) sum += numbers[size_t(c)].second * columns[c];
    return sum;
  }
  double as_formula(double signal) const {
    std::vector<double> values{signal};
    for (const auto& number : numbers) values.push_back(number.second);
    FormulaParser parser;
    parser.DefineConst("pi", 3.14159265358979323846);
    parser.DefineVar("signal", &values[0]);
    for (size_t i = 0; i < numbers.size(); ++i)
      parser.DefineVar(std::string(numbers[i].first), &values[i + 1]);
    parser.set_formula(std::string(shape.formula));
    return parser.Eval();
  }

  const TermShape& shape;
  const std::vector<double> own{0.3, 0.8};
  std::vector<std::pair<std::string_view, double>> numbers;
};

TEST(Shape, TheFormulaIsWhatTheSearchEvaluates) {
  for (const TermShape& shape : named_shapes()) {
    if (shape.formula.empty()) continue;
    const Filled filled(shape);
    for (const double signal : {-2.1, -0.4, -0.05, 0.0, 0.02, 0.33, 0.9, 3.7})
      EXPECT_NEAR(filled.as_formula(signal), filled.evaluated(signal), 1e-12)
          << shape.name << " of " << signal;
  }
}

/// A speed makes a force; a distortion keeps the unit of its signal.
TEST(Shape, TheFormulaHasTheUnitOfItsSite) {
  for (const TermShape& shape : named_shapes()) {
    if (shape.formula.empty()) continue;
    const bool is_distortion = shape.of == TermShape::Of::own;
    const std::string unit = is_distortion ? "m/s" : "N";
    std::string constants;
    const auto add = [&](std::string_view name, const std::string& of) {
      constants += (constants.empty() ? "" : ", ") +
                   fmt::format(R"({{"name": "{}", "value": 0.7, "unit": "{}"}})", name, of);
    };
    for (int c = 0; c < shape.columns && !is_distortion; ++c)
      add(shape.coefficients[size_t(c)], shape.power == 0 ? "N" : fmt::format("N*(m/s)^{}", -shape.power));
    for (int p = 0; p < shape.nonlinear_count(); ++p) add(shape.nonlinear[size_t(p)], "m/s");
    if (shape.formula.find("reference") != shape.formula.npos) add("reference", "m/s");
    const std::string text = fmt::format(
        R"({{"loopwright": 1, "solver": {{"method": "rk4", "step": 0.01, "stop": 1}}, "blocks": {{
      "speed": {{"type": "Constant", "value": {{"value": 2, "unit": "m/s"}}}},
      "other": {{"type": "Constant", "value": {{"value": 1, "unit": "{}"}}}},
      "term": {{"type": "Expression", "formula": "{}", "names": ["signal"], "constants": [{}], "in": {{"arguments": ["speed.y"]}}}},
      "net": {{"type": "Sum", "in": {{"terms": ["other.y", "term.y"]}}}}}}}})",
        unit, shape.formula, constants);
    Problems problems;
    const auto diagram =
        load_diagram_text(std::make_shared<SourceFile>(SourceFile{"shape.json", text}), {}, problems);
    const auto plan = diagram ? compile(*diagram, problems) : nullptr;
    EXPECT_EQ(problems.text(), "") << text;
    ASSERT_TRUE(plan) << shape.name;
    EXPECT_EQ(plan->without_unit.count, 0u) << shape.name;
  }
}

}  // namespace
}  // namespace loopwright::diagnosis::shape_test
