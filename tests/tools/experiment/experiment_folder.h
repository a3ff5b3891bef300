/// A diagram, an experiment and data written inside a test. The data come from a closed form, not from the
/// engine.
#pragma once
#include <fmt/format.h>
#include <functional>
#include "tests/engine/written_diagram.h"
#include "tools/compare/compare.h"

namespace loopwright {

/// A mass of 2 kg that a force pushes. The experiment replaces the force by the recorded one.
class ExperimentFolder : public DiagramFolder {
 public:
  ExperimentFolder() {
    with("stage.json", diagram(R"("push": {"type": "Constant", "value": {"value": 0, "unit": "N"}},
      "stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "initial_position": {"value": 0, "unit": "m"}, "in": {"force": "push.y"}})",
                               R"("method": "rk4", "step": 0.05, "stop": 1)"));
    experiment();
  }

  /// One row for each time: t [s], F [N], x [mm].
  ExperimentFolder& data(const std::vector<double>& times, const std::function<double(double)>& force,
                         const std::function<double(double)>& position_m) {
    std::string text = "t,F,x_mm\n";
    for (double t : times)
      text += fmt::format("{:.17g},{:.17g},{:.17g}\n", t, force(t), 1000 * position_m(t));
    with("data.csv", text);
    return *this;
  }
  ExperimentFolder& experiment(
      std::string_view drive = R"("stage.force": {"column": "F", "unit": "N"})",
      std::string_view compare = R"("stage.position": {"column": "x_mm", "unit": "mm"})",
      std::string_view more = "") {
    with(
        "e.json",
        fmt::format(
            R"({{"loopwright": 1, "title": "A push", "data": "data.csv", "time": "t", "drive": {{{}}}, "compare": {{{}}}{}}})",
            drive, compare, more));
    return *this;
  }
  Comparison compared() const { return compare(path("stage.json"), path("e.json")); }
  /// The problems, with file names relative to the folder.
  std::string refusal() const {
    try {
      compared();
    } catch (const InputError& error) {
      std::string text = error.what();
      for (size_t at = text.find(path("")); at != text.npos; at = text.find(path("")))
        text.erase(at, path("").size());
      return text;
    }
    return "";
  }
};

inline std::vector<double> every(double step, int rows) {
  std::vector<double> times;
  for (int i = 0; i < rows; ++i) times.push_back(i * step);
  return times;
}

}  // namespace loopwright
