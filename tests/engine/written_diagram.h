/// Diagrams written inside a test: compiled, run, or shown with their problems.
///
///   const auto plan = plan_of(diagram(R"("a": {"type": "Constant", "value": 3})"));
///   EXPECT_EQ(signal(simulate(*plan), "a.y").back(), 3);
#pragma once
#include <fmt/format.h>
#include "engine/run/simulation.h"
#include "tests/engine/diagram/diagram_folder.h"

namespace loopwright {

/// A whole file around the contents of "blocks" and of "solver"; `more`: further members, as in R"(, "log":
/// [])".
inline std::string diagram(std::string_view blocks, std::string_view solver = R"("stop": 1, "step": 0.1)",
                           std::string_view more = "") {
  return fmt::format("{{\"loopwright\": 1, \"solver\": {{{}}}, \"blocks\": {{\n{}\n}}{}}}\n", solver, blocks,
                     more);
}

/// Throws InputError like load_plan.
inline std::shared_ptr<const Plan> plan_of(std::string_view text, const LoadOptions& options = {}) {
  DiagramFolder folder;
  return load_plan(folder.with("top.json", text).path("top.json"), options);
}

/// Every problem of loading and compiling, including warnings, with file names relative to the folder.
inline std::string problems_in(const DiagramFolder& folder, const std::string& name = "top.json",
                               const LoadOptions& options = {}) {
  Problems problems;
  if (const auto loaded = load_diagram(folder.path(name), options, problems)) compile(*loaded, problems);
  std::string text = problems.text();
  const std::string prefix = folder.path("");
  for (size_t at = text.find(prefix); at != text.npos; at = text.find(prefix)) text.erase(at, prefix.size());
  return text;
}
inline std::string problems_of(std::string_view text, const LoadOptions& options = {}) {
  DiagramFolder folder;
  return problems_in(folder.with("top.json", text), "top.json", options);
}

inline RunResult run_of(std::string_view text, const RunOptions& options = {}) {
  return simulate(*plan_of(text), options);
}

/// A column of the recording. Throws std::invalid_argument if there is none of that name.
inline const std::vector<double>& signal(const RunResult& result, std::string_view name) {
  for (const Column& column : result.recording.columns)
    if (column.name == name) return column.values;
  throw std::invalid_argument("no column " + std::string(name));
}

inline bool has(std::string_view text, std::string_view part) { return text.find(part) != text.npos; }

}  // namespace loopwright
