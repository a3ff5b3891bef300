#include "engine/plan/units.h"
#include <fmt/format.h>
#include <charconv>
#include <unordered_map>

namespace loopwright {
namespace {

/// constant · Π variable^exponent, as a port's description says it.
struct UnitExpression {
  Unit constant;
  std::vector<std::pair<std::string, double>> variables;
};

/// "$command*s^2/m": factors split at * and /, those with $ are variables.
UnitExpression parse_expression(std::string_view text) {
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
      expression.variables.emplace_back(factor.substr(1, std::min(caret, factor.size()) - 1),
                                        before == '/' ? -exponent : exponent);
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
  const std::string* pointer;
  std::string declared;  // the path of a subdiagram's port, if that is its left end
  bool is_wire() const { return left.block >= 0 && right.block >= 0; }
  bool is_parameter() const { return left.block >= 0 && right.block < 0; }
};

class Solver {
 public:
  Solver(const FlatDiagram& flat, const Diagram& diagram, Problems& problems)
      : flat_(flat), problems_(problems) {
    variables_.resize(flat.blocks.size());
    for (size_t b = 0; b < flat.blocks.size(); ++b) add_block(int(b));
    for (const FlatName& name : flat.names) declared_[name.name] = &name.wire;
    add_declarations(diagram, "");
  }

  PortUnits run() {
    propagate();
    for (const Equation& equation : equations_) check(equation);
    PortUnits units(flat_.blocks.size());
    for (size_t b = 0; b < flat_.blocks.size(); ++b)
      for (const PortInfo& port : flat_.blocks[b].type->info.outputs)
        units[b].push_back(value({int(b), expression(port.unit), {}}));
    return units;
  }

 private:
  const UnitExpression* expression(std::string_view text) {
    const auto found = parsed_.find(std::string(text));
    if (found != parsed_.end()) return &found->second;
    return &parsed_.emplace(std::string(text), parse_expression(text)).first->second;
  }
  const UnitExpression* constant(const Unit& unit) {
    const std::string key = "=" + to_string(unit);
    return &parsed_.emplace(key, UnitExpression{unit, {}}).first->second;
  }

  void add_block(int b) {
    const FlatBlock& block = flat_.blocks[size_t(b)];
    const BlockInfo& info = block.type->info;
    for (size_t i = 0; i < info.inputs.size(); ++i)
      for (const FlatWire& wire : block.inputs[i]) {
        if (!wire.is_resolved() || info.inputs[i].unit == any_unit) continue;
        const FlatBlock& source = flat_.blocks[size_t(wire.block)];
        const PortInfo& output = source.type->info.outputs[size_t(wire.output)];
        add({{b, expression(info.inputs[i].unit), info.inputs[i].name},
             {wire.block, expression(output.unit), output.name},
             &wire.place,
             &wire.pointer,
             {}});
      }
    for (const ParameterInfo& parameter : info.parameters)
      if (const Value::Member* member = block.entry->settings.find(parameter.name))
        add_parameter(b, parameter, member->value);
  }

  void add_parameter(int b, const ParameterInfo& info, const Value& value) {
    add_parameter(b, info, info.name, value);
  }
  void add_parameter(int b, const ParameterInfo& info, std::string_view name, const Value& value) {
    if (value.kind == Value::Kind::number && value.unit)
      add({{b, expression(info.unit), name},
           {-1, constant(*value.unit), value.text},
           &value.place,
           &value.pointer,
           {}});
    if (!info.element.empty())
      for (const Value& item : value.items) add_parameter(b, info.element[0], name, item);
    for (const Value::Member& member : value.members)
      for (const ParameterInfo& field : info.fields)
        if (field.name == member.name) add_parameter(b, field, member.value);
  }

  /// Inputs and outputs that subdiagrams declare with a unit.
  void add_declarations(const Diagram& diagram, const std::string& prefix) {
    const auto declare = [&](const std::string& name, const std::string& unit_text, const Place& place,
                             const std::string& pointer) {
      if (unit_text.empty()) return;
      const auto unit = parse_unit(unit_text);
      const auto wire = declared_.find(prefix + name);
      if (!unit || wire == declared_.end() || !wire->second->is_resolved()) return;
      const FlatBlock& source = flat_.blocks[size_t(wire->second->block)];
      const PortInfo& output = source.type->info.outputs[size_t(wire->second->output)];
      add({{-1, constant(*unit), {}},
           {wire->second->block, expression(output.unit), output.name},
           &place,
           &pointer,
           prefix + name});
    };
    if (!prefix.empty()) {
      for (const DiagramInput& input : diagram.inputs)
        declare(input.name, input.unit, input.place, input.pointer);
      for (const DiagramOutput& output : diagram.outputs)
        declare(output.name, output.unit, output.place, output.pointer);
    }
    for (const BlockEntry& block : diagram.blocks)
      if (block.subdiagram) add_declarations(*block.subdiagram, prefix + block.name + ".");
  }

  void add(Equation equation) {
    const size_t index = equations_.size();
    for (const End* end : {&equation.left, &equation.right})
      if (end->block >= 0)
        for (const auto& [name, exponent] : end->expression->variables)
          readers_[{end->block, name}].push_back(index);
    equations_.push_back(std::move(equation));
  }

  std::optional<Unit> known(int block, const std::string& name) const {
    for (const auto& [n, unit] : variables_[size_t(block)])
      if (n == name) return unit;
    return {};
  }
  std::optional<Unit> value(const End& end) const {
    Unit unit = end.expression->constant;
    for (const auto& [name, exponent] : end.expression->variables) {
      const auto factor = known(end.block, name);
      if (!factor) return {};
      unit = unit * power(*factor, exponent);
    }
    return unit;
  }

  /// Solves an equation that has one unknown; true if it did.
  bool solve(const Equation& equation) {
    Unit rest;
    int unknown_block = -1;
    std::string unknown;
    double exponent = 0;
    double sign = 1;
    for (const End* end : {&equation.left, &equation.right}) {
      rest = rest * power(end->expression->constant, sign);
      for (const auto& [name, e] : end->expression->variables) {
        if (const auto unit = known(end->block, name)) {
          rest = rest * power(*unit, sign * e);
        } else {
          if (!unknown.empty() && (unknown != name || unknown_block != end->block)) return false;
          unknown = name, unknown_block = end->block, exponent += sign * e;
        }
      }
      sign = -1;
    }
    if (unknown.empty() || exponent == 0) return false;
    variables_[size_t(unknown_block)].emplace_back(unknown, power(rest, -1 / exponent));
    const auto readers = readers_.find({unknown_block, unknown});
    if (readers != readers_.end()) todo_.insert(todo_.end(), readers->second.begin(), readers->second.end());
    return true;
  }

  /// First what is written down at blocks and borders, then along the wires: a clash shows at the wire that
  /// joins its ends.
  void propagate() {
    for (const bool with_wires : {false, true}) {
      for (size_t i = equations_.size(); i-- > 0;) todo_.push_back(i);
      while (!todo_.empty()) {
        const size_t i = todo_.back();
        todo_.pop_back();
        if (with_wires || !equations_[i].is_wire()) solve(equations_[i]);
      }
    }
  }

  std::string name_of(const Equation& equation, const End& end) const {
    if (end.block >= 0) return fmt::format("{}.{}", flat_.blocks[size_t(end.block)].path, end.name);
    return equation.declared.empty() ? std::string(end.name) : equation.declared;
  }

  void check(const Equation& equation) {
    const auto left = value(equation.left), right = value(equation.right);
    if (!left || !right || left->same_dimension(*right)) return;
    const std::string left_unit = to_string(*left), right_unit = to_string(*right);
    const std::string& block =
        equation.left.block >= 0 ? flat_.blocks[size_t(equation.left.block)].path : equation.declared;
    const auto report = [&](std::string message, std::string_view what, std::string found) {
      auto& p = problems_.error(*equation.place, *equation.pointer, block, std::move(message));
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

  struct KeyHash {
    size_t operator()(const std::pair<int, std::string>& k) const {
      return std::hash<std::string>()(k.second) * 31 + size_t(k.first);
    }
  };
  const FlatDiagram& flat_;
  Problems& problems_;
  std::unordered_map<std::string, UnitExpression> parsed_;
  std::unordered_map<std::string, const FlatWire*> declared_;
  std::vector<Equation> equations_;
  std::vector<std::vector<std::pair<std::string, Unit>>> variables_;
  std::unordered_map<std::pair<int, std::string>, std::vector<size_t>, KeyHash> readers_;
  std::vector<size_t> todo_;
};

}  // namespace

PortUnits check_units(const FlatDiagram& flat, const Diagram& diagram, Problems& problems) {
  return Solver(flat, diagram, problems).run();
}

}  // namespace loopwright
