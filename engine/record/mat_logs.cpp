#include "engine/record/mat_logs.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <set>

#include "engine/record/time_names.h"

namespace loopwright::mat {
namespace {

const Variable* find(const std::vector<Variable>& variables, const std::string& name) {
  const auto found = std::ranges::find(variables, name, &Variable::name);
  return found == variables.end() ? nullptr : &*found;
}

std::string text_at(const std::vector<Variable>& variables, const std::string& name) {
  const Variable* const found = find(variables, name);
  return found && found->kind == Variable::Kind::text ? found->texts.front() : "";
}

/// "log" of "log.time".
std::string structure_with(const Variable& variable, std::string_view field) {
  if (!variable.name.ends_with(field)) return {};
  return variable.name.substr(0, variable.name.size() - field.size());
}

/// TimeInfo.Units of MATLAB's timeseries; empty: another.
std::string unit_of_time(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> units = {{{"seconds", "s"},
                                                                                   {"milliseconds", "ms"},
                                                                                   {"microseconds", "us"},
                                                                                   {"nanoseconds", "ns"},
                                                                                   {"minutes", "min"},
                                                                                   {"hours", "h"},
                                                                                   {"days", "day"},
                                                                                   {"weeks", "week"}}};
  for (const auto& [name, unit] : units)
    if (text == name) return std::string(unit);
  return {};
}

/// The variables of one structure: some are kept, with other names, and the rest is dropped.
class Structure {
 public:
  Structure(std::vector<Variable>& variables, std::string name)
      : variables_(variables), prefix_(std::move(name) + ".") {}

  void keep(const std::string& path, std::string name, std::string unit = {}) {
    for (Variable& variable : variables_)
      if (variable.name == path) kept_.push_back({&variable, std::move(name), std::move(unit)});
  }
  void drop_the_rest(std::string_view below) {
    std::vector<Variable> rest;
    const std::string dropped = prefix_ + std::string(below);
    for (Variable& variable : variables_) {
      const auto kept = std::ranges::find(kept_, &variable, &Kept::variable);
      if (kept == kept_.end() && variable.name.starts_with(dropped)) continue;
      rest.push_back(std::move(variable));
      if (kept == kept_.end()) continue;
      rest.back().name = kept->name;
      rest.back().unit = kept->unit;
    }
    variables_ = std::move(rest);
  }

 private:
  struct Kept {
    const Variable* variable;
    std::string name, unit;
  };
  std::vector<Variable>& variables_;
  std::string prefix_;
  std::vector<Kept> kept_;
};

void unfold_structure_with_time(std::vector<Variable>& variables, const std::string& log,
                                std::vector<std::string>& errors) {
  if (find(variables, log + ".time")->numbers.empty()) {
    errors.push_back(
        fmt::format("\"{}\" is a log without time: choose the format \"Structure With Time\"", log));
    return;
  }
  std::vector<std::string> signals;  // their paths without ".values"
  for (const Variable& variable : variables)
    if (variable.name.starts_with(log + ".signals") && variable.name.ends_with(".values"))
      signals.push_back(structure_with(variable, ".values"));
  std::vector<std::string> labels;
  for (const std::string& signal : signals) labels.push_back(text_at(variables, signal + ".label"));
  Structure structure(variables, log);
  for (size_t i = 0; i < signals.size(); ++i) {
    const bool is_named =
        !labels[i].empty() && labels[i] != "time" && std::ranges::count(labels, labels[i]) == 1;
    structure.keep(signals[i] + ".values",
                   is_named ? log + "." + labels[i] : fmt::format("{}.signals[{}]", log, i));
  }
  structure.drop_the_rest("signals");
}

void unfold_timeseries(std::vector<Variable>& variables, const std::string& log,
                       std::vector<std::string>& errors) {
  const std::string stated = text_at(variables, log + ".TimeInfo.Units"), unit = unit_of_time(stated);
  if (!stated.empty() && unit.empty())
    errors.push_back(fmt::format("the time of \"{}\" is in \"{}\", which is not known", log, stated));
  const std::string data_unit = text_at(variables, log + ".DataInfo.Units");
  Structure structure(variables, log);
  structure.keep(log + ".Time", log + ".Time", unit);
  structure.keep(log + ".Data", log + ".Data", data_unit);
  structure.drop_the_rest("");
}

}  // namespace

std::vector<std::string> unfold_logs(std::vector<Variable>& variables) {
  std::set<std::string> with_time, timeseries;
  for (const Variable& variable : variables) {
    if (const std::string log = structure_with(variable, ".time"); !log.empty())
      for (const Variable& other : variables)
        if (other.name.starts_with(log + ".signals") && other.name.ends_with(".values"))
          with_time.insert(log);
    if (const std::string log = structure_with(variable, ".Time");
        !log.empty() && find(variables, log + ".Data"))
      timeseries.insert(log);
  }
  std::vector<std::string> errors;
  for (const std::string& log : with_time) unfold_structure_with_time(variables, log, errors);
  for (const std::string& log : timeseries) unfold_timeseries(variables, log, errors);
  return errors;
}

size_t length_of_columns(const std::vector<Variable>& variables) {
  size_t longest_vector = 0, longest_side = 0, of_time = 0;
  std::ptrdiff_t times = 0;
  for (const Variable& variable : variables) {
    if (variable.kind != Variable::Kind::numbers) continue;
    const bool is_vector = !variable.is_log_of_matrices && (variable.rows == 1 || variable.columns == 1);
    const size_t length =
        variable.is_log_of_matrices ? variable.columns : std::max(variable.rows, variable.columns);
    longest_side = std::max(longest_side, length);
    if (!is_vector || length < 2) continue;
    longest_vector = std::max(longest_vector, length);
    if (is_called_time(last_part(variable.name))) ++times, of_time = length;
  }
  return times == 1 ? of_time : longest_vector > 0 ? longest_vector : longest_side;
}

}  // namespace loopwright::mat
