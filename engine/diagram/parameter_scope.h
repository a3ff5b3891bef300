/// The parameters of one diagram, and the values in its file that are expressions over them.
#pragma once
#include <string>
#include <unordered_map>
#include <vector>
#include "engine/diagram/diagram.h"
#include "engine/diagram/expression.h"
#include "engine/json/reader.h"

namespace loopwright {

/// A value that replaces the value of a parameter.
struct Override {
  std::string name;
  Place place;  ///< of the name
  Value value;
};

class ParameterScope {
 public:
  /// `block`: path of the subdiagram that has these parameters, empty at the top level.
  ParameterScope(std::string block, Problems& problems) : reader_{problems, std::move(block)} {}

  /// Reads the object "parameters" of a diagram file, which must outlive the scope.
  void declare(const Value& parameters);
  /// Gives a declared parameter another value; an expression in it may use the names of this scope.
  void override_with(Override replacement);
  bool declares(std::string_view name) const { return index_.contains(std::string(name)); }
  /// The present value of a declared parameter, from the file or an override; expressions are not evaluated.
  const Value& given_value(std::string_view name) const;
  /// Evaluates every parameter. Before this, `evaluate` knows no names.
  void resolve();

  /// The value with every expression in it replaced by its result. {"value": 25, "unit": "mm"} becomes the
  /// number 0.025.
  Value evaluate(const Value& value, const std::string& block);
  std::vector<Parameter> take_parameters();
  const std::vector<std::string>& names() const { return names_; }

 private:
  enum class Progress { untouched, in_work, done };
  struct Entry {
    Parameter parameter;
    Value written;  // without its unit
    std::optional<Override> replacement;
    Progress progress = Progress::untouched;
    std::vector<size_t> needs;  // indices of other parameters, during resolution
    size_t next_need = 0;
    std::optional<Quantity> quantity;  // of a number, for use in expressions
  };

  void declare_one(const Value::Member& member);
  void resolve_from(size_t first);
  void collect_needs(const Value& value, std::vector<size_t>& needs) const;
  void report_cycle(const std::vector<size_t>& stack, size_t again);
  void work_out(Entry& entry);
  bool fits(const Value& value, const Entry& entry);
  void convert(Value& value, const std::optional<Unit>& unit, const std::string& name);

  Value evaluate_text(const Value& text, const std::string& block);
  Value number_with_unit(const Value& object, const std::string& block);
  Entry* find(const NameUse& use, const Place& place, const Value& text, const std::string& block);

  Reader reader_;
  std::vector<Entry> entries_;
  std::unordered_map<std::string, size_t> index_;
  /// Results of expressions by their text: large diagrams repeat the same axis many times. A result does not
  /// change, because an expression is evaluated after the parameters in it.
  std::unordered_map<std::string, Quantity> computed_;
  std::vector<std::string> names_;
  KnownNames known_;
};

}  // namespace loopwright
