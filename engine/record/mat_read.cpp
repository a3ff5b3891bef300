#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "engine/record/recorded_bytes.h"
#include "engine/record/mat.h"
#include "engine/record/mat_logs.h"
#include "engine/record/mat_names.h"
#include "engine/record/mat_variables.h"
#include "engine/json/problem_limit.h"
#include "engine/record/text.h"

namespace loopwright {
namespace {

using mat::Variable;

std::string count_of(size_t number, std::string_view noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

/// Sorts the variables of a file into columns and facts.
class Assembly {
 public:
  Assembly(Place place, ProblemLimit& problems, const ReadOptions& options)
      : place_(std::move(place)), problems_(problems), options_(options) {}

  Recording assemble(std::vector<Variable>& variables);

 private:
  void restore_our_lists(const std::vector<Variable>& variables);
  void add(Variable& variable);
  void add_numbers(Variable& variable);
  void add_log_of_matrices(Variable& variable);
  void add_matrix(const Variable& variable, bool upright);
  void misfit(const Variable& variable, const std::string& what);
  void check(Column& column);

  Place place_;
  ProblemLimit& problems_;
  const ReadOptions& options_;
  size_t rows_ = 0;                           ///< of the longest variable
  std::map<std::string, size_t> our_places_;  ///< from the MATLAB name to the index in our list of names
  std::map<size_t, Column> ours_;             ///< in the order of our list, with gaps for removed variables
  std::vector<Column> others_;
  std::vector<std::pair<std::string, std::string>> facts_, our_names_;
};

Recording Assembly::assemble(std::vector<Variable>& variables) {
  restore_our_lists(variables);
  for (const std::string& error : mat::unfold_logs(variables)) problems_.error(place_, error);
  rows_ = mat::length_of_columns(variables);
  for (Variable& variable : variables) add(variable);

  Recording recording;
  for (auto& [place, column] : ours_) recording.columns.push_back(std::move(column));
  for (Column& column : others_) recording.columns.push_back(std::move(column));
  for (Column& column : recording.columns) column.origin = place_.file->name;
  recording.is_ordered = others_.empty();
  recording.facts = std::move(facts_);
  std::unordered_set<std::string_view> names;
  for (Column& column : recording.columns) {
    check(column);
    if (!names.insert(column.name).second)
      problems_.error(place_, fmt::format("two columns are named \"{}\"", excerpt(column.name)));
  }
  if (recording.rows() == 0 && !problems_.has_errors())
    problems_.error(place_, "the file has no numbers", "vectors or matrices of numbers");
  return problems_.has_errors() ? Recording{} : std::move(recording);
}

/// Names, units and facts of a file of write_mat(). Lists that contradict each other are treated like any
/// other cell.
void Assembly::restore_our_lists(const std::vector<Variable>& variables) {
  const auto find = [&](const char* name) -> const Variable* {
    const auto found = std::ranges::find(variables, name, &Variable::name);
    return found != variables.end() && found->kind == Variable::Kind::texts ? &*found : nullptr;
  };
  const Variable* const names = find(mat::names_variable);
  const Variable* const units = find(mat::units_variable);
  const Variable* const facts = find(mat::facts_variable);
  if (!names || !units || !facts || names->texts.size() != units->texts.size() || facts->columns != 2) return;
  const std::vector<std::string> legal = mat::legal_names(names->texts);
  for (size_t i = 0; i < legal.size(); ++i) {
    our_places_[legal[i]] = i;
    our_names_.emplace_back(names->texts[i], units->texts[i]);
  }
  for (size_t i = 0; i < facts->rows; ++i)
    facts_.emplace_back(facts->texts[i], facts->texts[facts->rows + i]);
  for (const char* const name : {mat::names_variable, mat::units_variable, mat::facts_variable})
    our_places_[name] = our_names_.size();  // known, but not a column
}

void Assembly::add(Variable& variable) {
  const bool is_our_list = variable.kind == Variable::Kind::texts && our_places_.contains(variable.name);
  if (is_our_list) return;
  switch (variable.kind) {
    case Variable::Kind::numbers:
      return add_numbers(variable);
    case Variable::Kind::text:
      facts_.emplace_back(variable.name, variable.texts.front());
      return;
    case Variable::Kind::texts:
      return misfit(variable, "a cell array");
    case Variable::Kind::other:
      return misfit(variable, variable.texts.front());
  }
}

void Assembly::add_numbers(Variable& variable) {
  if (variable.is_log_of_matrices) return add_log_of_matrices(variable);
  const bool is_vector = variable.rows == 1 || variable.columns == 1;
  const auto ours = our_places_.find(variable.name);
  if (is_vector && variable.numbers.size() == rows_) {
    Column column{variable.name, variable.unit, std::move(variable.numbers)};
    if (ours == our_places_.end() || ours->second >= our_names_.size()) {
      others_.push_back(std::move(column));
    } else {
      std::tie(column.name, column.unit) = our_names_[ours->second];
      ours_[ours->second] = std::move(column);
    }
  } else if (variable.numbers.size() == 1) {
    std::string number;
    append_number(number, variable.numbers.front());
    facts_.emplace_back(variable.name, number);
  } else if (variable.numbers.empty()) {
    misfit(variable, "an empty matrix");
  } else if (variable.rows == rows_ && variable.columns == rows_) {
    misfit(variable, fmt::format("a matrix of {0} rows and {0} columns: either may be the signals", rows_));
  } else if (variable.rows == rows_ || variable.columns == rows_) {
    add_matrix(variable, variable.rows == rows_);
  } else {
    misfit(variable, fmt::format("a {}×{} matrix beside columns of {}", variable.rows, variable.columns,
                                 count_of(rows_, "row")));
  }
}

/// Of one number at each instant: one column.
void Assembly::add_log_of_matrices(Variable& variable) {
  if (variable.columns != rows_)
    return misfit(variable, fmt::format("an array of 3 dimensions, and the last of them are not the {}",
                                        count_of(rows_, "row")));
  if (variable.rows == 1)
    others_.push_back({variable.name, variable.unit, std::move(variable.numbers)});
  else
    add_matrix(variable, false);
}

/// `upright`: a row of the matrix is a row of the recording. Transposed matrices come from Simulink's "To
/// File".
void Assembly::add_matrix(const Variable& variable, bool upright) {
  const size_t count = upright ? variable.columns : variable.rows;
  for (size_t i = 0; i < count; ++i) {
    Column& column = others_.emplace_back();
    column.name = fmt::format("{}[{}]", variable.name, i);
    column.unit = variable.unit;
    column.values.reserve(rows_);
    for (size_t row = 0; row < rows_; ++row)
      column.values.push_back(variable.numbers[upright ? i * rows_ + row : row * count + i]);
  }
}

void Assembly::misfit(const Variable& variable, const std::string& what) {
  const std::string message = fmt::format("variable \"{}\" is {}", excerpt(variable.name), what);
  if (options_.leave_out_misfits) {
    problems_.warning(place_, message, "it is left out");
  } else {
    problems_.error(place_, message, "vectors or matrices of real numbers with the same number of rows", {},
                    what == mat::object
                        ? "in MATLAB: s = struct('Time', ts.Time, 'Data', ts.Data), and save s"
                        : "save the file without it");
  }
}

void Assembly::check(Column& column) {
  if (column.name.empty()) problems_.error(place_, "a variable has no name");
  if (options_.allow_not_finite) return;
  const auto is_not_finite = [](double value) { return !std::isfinite(value); };
  const auto first = std::ranges::find_if(column.values, is_not_finite);
  if (first == column.values.end()) return;
  Problem problem;
  problem.place = place_;
  problem.message = fmt::format("column \"{}\": {} not finite, the first in row {}", excerpt(column.name),
                                count_of(std::ranges::count_if(column.values, is_not_finite), "value"),
                                first - column.values.begin() + 1);
  problem.expected = "numbers", problem.found = fmt::format("{}", *first);
  problem.hint = "leave out the rows with holes";
  if (options_.allow_holes)
    column.holes = {1, {std::move(problem)}};  // told together: rows of a MAT file have no places
  else
    problems_.error(place_, problem.message, problem.expected, problem.found, problem.hint);
}

}  // namespace

Recording read_mat(const std::string& path, Problems& problems, const ReadOptions& options) {
  const std::shared_ptr<const SourceFile> file = read_recorded_bytes(path, problems);
  if (!file) return {};

  // A location without text: lines and columns have no meaning in a binary file.
  const Place place{std::make_shared<SourceFile>(SourceFile{path, {}}), 0};
  mat::Variables variables = mat::read_all_variables(*file, options);
  if (!variables.failure.empty()) {
    problems.error(place, {}, {}, variables.failure).hint = variables.hint;
    return {};
  }
  ProblemLimit limit(problems, options.most_problems);
  return Assembly(place, limit, options).assemble(variables.list);
}

}  // namespace loopwright
