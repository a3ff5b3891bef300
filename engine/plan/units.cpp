#include "engine/plan/units.h"
#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <deque>
#include <unordered_map>
#include "engine/plan/groups.h"

namespace loopwright {
namespace {

struct UnitFactor {
  int variable;  // of the block type
  double exponent;
};
/// constant · Π variable^exponent, as a port's description says it.
struct UnitExpression {
  Unit constant;
  std::vector<UnitFactor> factors;
};

/// The units that a block type's description names; their variables are counted.
class TypeUnits {
 public:
  explicit TypeUnits(const BlockInfo& info) {
    for (const PortInfo& port : info.inputs) inputs_.push_back(&add(port.unit));
    for (const PortInfo& port : info.outputs) outputs_.push_back(&add(port.unit));
    for (const ParameterInfo& parameter : info.parameters) add_parameter(parameter);
  }
  const UnitExpression& of_input(size_t input) const { return *inputs_[input]; }
  const UnitExpression& of_output(size_t output) const { return *outputs_[output]; }
  const UnitExpression& of(const ParameterInfo& parameter) const { return parsed_.at(parameter.unit); }
  size_t variables() const { return names_.size(); }

 private:
  void add_parameter(const ParameterInfo& parameter) {
    add(parameter.unit);
    for (const ParameterInfo& element : parameter.element) add_parameter(element);
    for (const ParameterInfo& field : parameter.fields) add_parameter(field);
  }
  const UnitExpression& add(std::string_view text) {
    const auto [entry, is_new] = parsed_.try_emplace(text);
    if (is_new) entry->second = parse(text);
    return entry->second;
  }

  /// "$command*s^2/m": factors split at * and /, those with $ are variables.
  UnitExpression parse(std::string_view text) {
    UnitExpression expression;
    if (text.find('$') == text.npos) {
      expression.constant = parse_unit(text).value_or(Unit{});
      return expression;
    }
    std::string plain = "1";
    char before = '*';
    for (size_t i = 0; i <= text.size();) {
      const size_t end = std::min(text.find_first_of("*/", i), text.size());
      const std::string_view factor = text.substr(i, end - i);
      if (factor.starts_with('$')) {
        const size_t caret = factor.find('^');
        double exponent = 1;
        if (caret != factor.npos)
          std::from_chars(factor.data() + caret + 1, factor.data() + factor.size(), exponent);
        expression.factors.push_back({variable(factor.substr(1, std::min(caret, factor.size()) - 1)),
                                      before == '/' ? -exponent : exponent});
      } else {
        plain += before;
        plain += factor;
      }
      before = end < text.size() ? text[end] : '*';
      i = end + 1;
    }
    expression.constant = parse_unit(plain).value_or(Unit{});
    return expression;
  }
  int variable(std::string_view name) {
    const auto index = std::ranges::find(names_, name) - names_.begin();
    if (index == std::ssize(names_)) names_.push_back(name);
    return int(index);
  }

  std::vector<std::string_view> names_;
  std::unordered_map<std::string_view, UnitExpression> parsed_;
  std::vector<const UnitExpression*> inputs_, outputs_;
};

/// Unit expressions of one end of an equation: of a port or parameter of a block, or a plain unit.
struct End {
  int block = -1;  // its variables are this block's
  const UnitExpression* expression = nullptr;
  std::string_view name;  // of the port or parameter; a plain unit's is what the file says
};
/// Points into the diagram: texts are written for the equations that do not hold, and there are many that do.
struct Equation {
  End left, right;
  const Place* place;
  const std::string* declared;  // the path of a subdiagram's port, if that is its left end
  bool is_wire() const { return left.block >= 0 && right.block >= 0; }
  bool is_parameter() const { return left.block >= 0 && right.block < 0; }
  /// Nothing to be solved, and nothing wrong.
  bool is_settled() const {
    return left.expression->factors.empty() && right.expression->factors.empty() &&
           left.expression->constant.same_dimension(right.expression->constant);
  }
};

class Solver {
 public:
  Solver(const FlatDiagram& flat, const Diagram& diagram, Problems& problems)
      : flat_(flat), problems_(problems) {
    number_variables();
    for (size_t b = 0; b < flat.blocks.size(); ++b) add_block(int(b));
    add_declarations(diagram, "");
    readers_ = Groups(variables_.size(), [this](const auto& tell) { each_occurrence(tell); });
  }

  PortUnits run() {
    propagate();
    for (const Equation& equation : equations_) check(equation);
    PortUnits units;
    units.first.reserve(flat_.blocks.size());
    for (size_t b = 0; b < flat_.blocks.size(); ++b) {
      units.first.push_back(units.outputs.size());
      for (size_t o = 0; o < flat_.blocks[b].type->info.outputs.size(); ++o)
        units.outputs.push_back(value({int(b), &types_of_blocks_[b]->of_output(o), {}}));
    }
    return units;
  }

 private:
  void number_variables() {
    types_of_blocks_.reserve(flat_.blocks.size()), first_variable_.reserve(flat_.blocks.size());
    size_t variables = 0;
    for (const FlatBlock& block : flat_.blocks) {
      const TypeUnits& type = types_.try_emplace(block.type, block.type->info).first->second;
      types_of_blocks_.push_back(&type), first_variable_.push_back(variables);
      variables += type.variables();
    }
    variables_.resize(variables);
  }
  size_t variable_of(int block, const UnitFactor& factor) const {
    return first_variable_[size_t(block)] + size_t(factor.variable);
  }
  const UnitExpression* constant(const Unit& unit) {
    return &constants_.emplace_back(UnitExpression{unit, {}});
  }

  void add_block(int b) {
    const FlatBlock& block = flat_.blocks[size_t(b)];
    const BlockInfo& info = block.type->info;
    for (size_t i = 0; i < info.inputs.size(); ++i)
      for (const FlatWire& wire : block.inputs[i]) {
        if (!wire.is_resolved() || info.inputs[i].unit == any_unit) continue;
        add_equation({{b, &types_of_blocks_[size_t(b)]->of_input(i), info.inputs[i].name},
                      output_end(wire),
                      &wire.at->place,
                      nullptr});
      }
    const auto& numbers = flat_.settings.with_units;
    for (; next_number_ < numbers.size() && numbers[next_number_].block == b; ++next_number_)
      add_number(numbers[next_number_]);
  }

  /// Most of them are settled already; they would only fill memory.
  void add_equation(const Equation& equation) {
    if (!equation.is_settled()) equations_.push_back(equation);
  }

  void add_number(const NumberWithUnit& number) {
    const UnitExpression unit{*number.value->unit, {}};
    Equation equation{{number.block, &types_of_blocks_[size_t(number.block)]->of(*number.info), number.name},
                      {-1, &unit, number.value->text},
                      &number.value->place,
                      nullptr};
    if (equation.is_settled()) return;
    equation.right.expression = &constants_.emplace_back(unit);
    equations_.push_back(equation);
  }

  End output_end(const FlatWire& wire) const {
    const PortInfo& output = flat_.blocks[size_t(wire.block)].type->info.outputs[size_t(wire.output)];
    return {wire.block, &types_of_blocks_[size_t(wire.block)]->of_output(size_t(wire.output)), output.name};
  }

  /// Inputs and outputs that subdiagrams declare with a unit.
  void add_declarations(const Diagram& diagram, const std::string& prefix) {
    const auto declare = [&](const std::string& name, const std::string& unit_text, const Place& place) {
      if (unit_text.empty()) return;
      const auto unit = parse_unit(unit_text);
      const FlatWire* const wire = declared(prefix + name);
      if (!unit || !wire || !wire->is_resolved()) return;
      equations_.push_back({{-1, constant(*unit), {}},
                            output_end(*wire),
                            &place,
                            &declared_paths_.emplace_back(prefix + name)});
    };
    if (!prefix.empty()) {
      for (const DiagramInput& input : diagram.inputs) declare(input.name, input.unit, input.place);
      for (const DiagramOutput& output : diagram.outputs) declare(output.name, output.unit, output.place);
    }
    for (const BlockEntry& block : diagram.blocks)
      if (block.subdiagram) add_declarations(*block.subdiagram, prefix + block.name + ".");
  }

  /// What a port of a subdiagram leads to.
  const FlatWire* declared(const std::string& path) {
    if (declared_.empty())
      for (const FlatName& name : flat_.names) declared_[name.name] = &name.wire;
    const auto found = declared_.find(path);
    return found == declared_.end() ? nullptr : found->second;
  }

  /// Variables, and the equations that they occur in.
  template <class F> void each_occurrence(const F& f) const {
    for (size_t i = 0; i < equations_.size(); ++i)
      for (const End* end : {&equations_[i].left, &equations_[i].right})
        for (const UnitFactor& factor : end->expression->factors) f(variable_of(end->block, factor), int(i));
  }

  std::optional<Unit> value(const End& end) const {
    Unit unit = end.expression->constant;
    for (const UnitFactor& factor : end.expression->factors) {
      const auto& known = variables_[variable_of(end.block, factor)];
      if (!known) return {};
      unit = unit * power(*known, factor.exponent);
    }
    return unit;
  }

  /// Solves an equation that has one unknown.
  void solve(const Equation& equation) {
    Unit rest;
    std::optional<size_t> unknown;
    double exponent = 0;
    double sign = 1;
    for (const End* end : {&equation.left, &equation.right}) {
      for (const UnitFactor& factor : end->expression->factors) {
        const size_t variable = variable_of(end->block, factor);
        if (variables_[variable]) continue;
        if (unknown && unknown != variable) return;
        unknown = variable, exponent += sign * factor.exponent;
      }
      sign = -1;
    }
    if (!unknown || exponent == 0) return;
    sign = 1;
    for (const End* end : {&equation.left, &equation.right}) {
      rest = rest * power(end->expression->constant, sign);
      for (const UnitFactor& factor : end->expression->factors)
        if (const auto& known = variables_[variable_of(end->block, factor)])
          rest = rest * power(*known, sign * factor.exponent);
      sign = -1;
    }
    variables_[*unknown] = power(rest, -1 / exponent);
    const auto readers = readers_[*unknown];
    todo_.insert(todo_.end(), readers.begin(), readers.end());
  }

  /// First what is written down at blocks and borders, then along the wires: a clash shows at the wire that
  /// joins its ends.
  void propagate() {
    for (const bool with_wires : {false, true}) {
      for (size_t i = equations_.size(); i-- > 0;) todo_.push_back(int(i));
      while (!todo_.empty()) {
        const size_t i = size_t(todo_.back());
        todo_.pop_back();
        if (with_wires || !equations_[i].is_wire()) solve(equations_[i]);
      }
    }
  }

  std::string name_of(const Equation& equation, const End& end) const {
    if (end.block >= 0) return fmt::format("{}.{}", flat_.blocks[size_t(end.block)].path, end.name);
    return equation.declared ? *equation.declared : std::string(end.name);
  }

  void check(const Equation& equation) {
    const auto left = value(equation.left), right = value(equation.right);
    if (!left || !right || left->same_dimension(*right)) return;
    const std::string left_unit = to_string(*left), right_unit = to_string(*right);
    const std::string& block =
        equation.left.block >= 0 ? flat_.blocks[size_t(equation.left.block)].path : *equation.declared;
    const auto report = [&](std::string message, std::string_view what, std::string found) {
      auto& p = problems_.error(*equation.place, equation.place->pointer(), block, std::move(message));
      p.expected = fmt::format("a {} in {}", what, left_unit);
      p.found = std::move(found);
    };
    if (equation.is_parameter())
      return report(fmt::format("the parameter \"{}\" has the wrong unit", equation.left.name), "number",
                    equation.right.name.empty() ? right_unit
                                                : fmt::format("{} in {}", equation.right.name, right_unit));
    report(fmt::format("{} [{}] is wired to {} [{}]", name_of(equation, equation.left), left_unit,
                       name_of(equation, equation.right), right_unit),
           "signal", right_unit);
  }

  const FlatDiagram& flat_;
  Problems& problems_;
  std::unordered_map<const BlockType*, TypeUnits> types_;
  std::vector<const TypeUnits*> types_of_blocks_;
  std::deque<UnitExpression> constants_;
  std::deque<std::string> declared_paths_;
  std::unordered_map<std::string_view, const FlatWire*> declared_;
  std::vector<Equation> equations_;
  size_t next_number_ = 0;                      // of those with units, whose block comes next
  std::vector<size_t> first_variable_;          // of each block
  std::vector<std::optional<Unit>> variables_;  // of all blocks
  Groups readers_;                              // of each variable; equations
  std::vector<int> todo_;
};

}  // namespace

PortUnits check_units(const FlatDiagram& flat, const Diagram& diagram, Problems& problems) {
  return Solver(flat, diagram, problems).run();
}

}  // namespace loopwright
