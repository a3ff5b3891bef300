#include "engine/plan/units.h"
#include <fmt/format.h>
#include <algorithm>
#include <set>
#include "engine/plan/groups.h"
#include "engine/plan/unit_equations.h"
#include "engine/plan/unit_system.h"
#include "engine/unit/scaled_rate.h"

namespace loopwright {
namespace {

class UnitSolver {
 public:
  UnitSolver(const FlatDiagram& flat, const Diagram& diagram, Problems& problems)
      : flat_(flat),
        problems_(problems),
        said_(flat, diagram),
        equations_(said_.list()),
        variables_(said_.variables()) {
    readers_ = Groups(variables_.size(), [this](const auto& tell) { each_occurrence(tell); });
  }

  PortUnits run() {
    // A contradiction is reported at the wire that connects its ends. Units written at blocks and
    // declarations are used first, then units passed from sources to readers, then units required by readers
    // of their sources.
    for (const Phase phase : {Phase::written, Phase::forward, Phase::any}) propagate(phase);
    solve_together();
    for (const Equation& equation : equations_) check(equation);
    if (!problems_.has_errors())  // which may be the cause
      for (size_t b = 0; b < flat_.blocks.size(); ++b) check_position(int(b));
    PortUnits units;
    units.first.reserve(flat_.blocks.size());
    for (size_t b = 0; b < flat_.blocks.size(); ++b) {
      units.first.push_back(units.outputs.size());
      for (size_t o = 0; o < flat_.blocks[b].type->info.outputs.size(); ++o)
        units.outputs.push_back(in_si(value({int(b), &said_.types_of(int(b)).of_output(o), {}})));
    }
    return units;
  }

 private:
  enum class Phase { written, forward, any };

  // ---- One unknown at a time ----

  /// f(end, power) for every end of an equation: the product of all is 1.
  template <class F> static void each_end(const Equation& equation, const F& f) {
    f(equation.left, 1.0);
    f(equation.right, -1.0);
    if (equation.rule)
      for (const Rule::Argument& argument : equation.rule->arguments) f(argument.end, -argument.power);
  }
  /// Variables with the equations in which they occur.
  template <class F> void each_occurrence(const F& f) const {
    for (size_t i = 0; i < equations_.size(); ++i)
      each_end(equations_[i], [&](const End& end, double) {
        for (const UnitFactor& factor : end.expression->factors)
          f(said_.variable_of(end.block, factor), int(i));
      });
  }

  /// Signals are in SI. Only a rate such as 1/min keeps its scale.
  static Unit of_signal(Unit unit) {
    if (!is_scaled_rate(unit)) unit.scale = 1;
    return unit;
  }
  static std::optional<Unit> in_si(const std::optional<Unit>& unit) {
    return unit ? std::optional(unit->in_si()) : std::nullopt;
  }
  std::optional<Unit> value(const End& end) const {
    Unit unit = end.expression->constant;
    for (const UnitFactor& factor : end.expression->factors) {
      const auto& known = variables_[said_.variable_of(end.block, factor)];
      if (!known) return {};
      unit = unit * power(*known, factor.exponent);
    }
    return of_signal(unit);
  }
  /// The unit of the right end, or the result of its rule.
  std::optional<Unit> right_value(const Equation& equation) const {
    if (!equation.rule) return value(equation.right);
    if (equation.rule->is_formula) {
      const auto& found = equation.rule->unit;
      return found && found->finding == UnitFinding::known ? std::optional(found->unit) : std::nullopt;
    }
    Unit product;
    for (const Rule::Argument& argument : equation.rule->arguments) {
      const auto unit = value(argument.end);
      if (!unit) return {};
      product = product * power(*unit, argument.power);
    }
    return of_signal(product);
  }

  /// The unit of a formula, once the units of its arguments are known.
  void find_formula_unit(const Equation& equation) {
    Rule& rule = *equation.rule;
    if (rule.unit) return;
    std::vector<Unit> units;
    for (const Rule::Argument& argument : rule.arguments) {
      const auto unit = value(argument.end);
      if (!unit) return;
      units.push_back(*unit);
    }
    const FlatBlock& block = flat_.blocks[size_t(equation.left.block)];
    rule.unit = block.type->info.formula_unit(block.value.get(), units);
  }

  struct Unknown {
    size_t variable;
    double exponent;
    bool is_position;
  };
  /// The only unknown of an equation; nothing when there are none or several.
  std::optional<Unknown> only_unknown(const Equation& equation) const {
    std::optional<Unknown> unknown;
    bool has_several = false;
    each_end(equation, [&](const End& end, double power) {
      for (const UnitFactor& factor : end.expression->factors) {
        const size_t variable = said_.variable_of(end.block, factor);
        if (variables_[variable]) continue;
        if (!unknown) unknown = {variable, 0.0, said_.types_of(end.block).is_position(factor.variable)};
        has_several |= unknown->variable != variable;
        unknown->exponent += power * factor.exponent;
      }
    });
    if (has_several || (unknown && unknown->exponent == 0)) return {};
    return unknown;
  }

  void solve(const Equation& equation, Phase phase) {
    if (equation.rule && equation.rule->is_formula) return solve_formula(equation);
    if (phase == Phase::forward && (equation.is_wire() || equation.rule) && !right_value(equation)) return;
    const auto unknown = only_unknown(equation);
    if (!unknown) return;
    assign(*unknown, power(known_part(equation), -1 / unknown->exponent));
  }
  /// The product of everything in an equation that is known.
  Unit known_part(const Equation& equation) const {
    Unit product;
    each_end(equation, [&](const End& end, double end_power) {
      product = product * power(end.expression->constant, end_power);
      for (const UnitFactor& factor : end.expression->factors)
        if (const auto& known = variables_[said_.variable_of(end.block, factor)])
          product = product * power(*known, end_power * factor.exponent);
    });
    return product;
  }
  void solve_formula(const Equation& equation) {
    find_formula_unit(equation);
    const auto unit = right_value(equation);
    const auto unknown = unit ? only_unknown(equation) : std::nullopt;
    if (unknown) assign(*unknown, *unit);  // the output is a separate variable
  }

  /// A radius times rad/s is m/s, and a torque times rad/s is W; N*m/rad is kept.
  static void drop_radians_of_products(Unit& unit) {
    Unit others = unit;
    others.exponents[2] = 0;  // rad/s is kept
    if (unit.radians() > 0 && !others.same_dimension(Unit{})) unit.exponents[Unit::radian] = 0;
  }
  void assign(const Unknown& unknown, Unit unit) {
    unit = of_signal(unit);
    drop_radians_of_products(unit);
    if (unknown.is_position && unit == Unit{}) unit.exponents[Unit::radian] = 1;
    variables_[unknown.variable] = unit;
    const auto readers = readers_[unknown.variable];
    todo_.insert(todo_.end(), readers.begin(), readers.end());
  }

  void propagate(Phase phase) {
    for (size_t i = equations_.size(); i-- > 0;) todo_.push_back(int(i));
    drain(phase);
  }
  void drain(Phase phase) {
    while (!todo_.empty()) {
      const Equation& equation = equations_[size_t(todo_.back())];
      todo_.pop_back();
      if (phase != Phase::written || (!equation.is_wire() && !equation.rule)) solve(equation, phase);
    }
  }

  // ---- Many unknowns at once ----

  /// Solves the remaining equations, each with several unknowns or none.
  void solve_together() {
    while (true) {
      UnitSystem system;
      add_unsolved(system);
      if (system.unknowns().empty()) return;
      system.solve();
      bool found = false;
      for (const size_t variable : system.unknowns())
        if (const auto unit = system.value(variable)) {
          found = true;
          assign({variable, 1, said_.is_position(variable)}, *unit);
        }
      tell_contradictions(system);
      if (!found) return;
      drain(Phase::any);  // formulas whose arguments are now known
    }
  }
  void add_unsolved(UnitSystem& system) const {
    for (size_t i = 0; i < equations_.size(); ++i) {
      const Equation& equation = equations_[i];
      const bool is_one_way = equation.is_bare || (equation.rule && equation.rule->is_formula);
      if (is_one_way) continue;  // x' = -2 x with a bare gain is a diagram without units, not a mistake
      std::vector<UnitSystem::Term> terms;
      each_end(equation, [&](const End& end, double end_power) {
        for (const UnitFactor& factor : end.expression->factors)
          if (const size_t variable = said_.variable_of(end.block, factor); !variables_[variable])
            terms.push_back({variable, end_power * factor.exponent});
      });
      if (!terms.empty()) system.add(std::move(terms), known_part(equation), int(i));
    }
  }
  void tell_contradictions(const UnitSystem& system) {
    for (const auto& [index, rest] : system.contradictions()) {
      const Equation& equation = equations_[size_t(index)];
      const std::string& block =
          equation.left.block >= 0 ? flat_.blocks[size_t(equation.left.block)].path : *equation.declared;
      if (is_power_of_time(rest) ||
          !told_.insert({equation.place->file.get(), equation.place->offset}).second)
        continue;
      auto& p = problems_.error(
          *equation.place, equation.place->pointer(), block,
          fmt::format("the units contradict each other at {}", name_of(equation, equation.left)));
      p.found = fmt::format("a unit that would have to be itself times {}", to_string(rest));
      p.hint = "the numbers with units around it cannot all be right";
    }
  }
  /// The typical remainder of a diagram without units, in which an oscillator is two integrators in a loop.
  static bool is_power_of_time(Unit rest) {
    rest.exponents[2] = 0;
    return rest.same_dimension(Unit{});
  }

  // ---- Contradictions ----

  std::string name_of(const Equation& equation, const End& end) const {
    if (end.block >= 0) return fmt::format("{}.{}", flat_.blocks[size_t(end.block)].path, end.name);
    return equation.declared ? *equation.declared : std::string(end.name);
  }

  void check(const Equation& equation) {
    if (equation.rule && equation.rule->is_formula) check_formula(equation);
    const auto left = value(equation.left), right = right_value(equation);
    if (!left || !right || equation.agrees(*left, *right)) return;
    const std::string left_unit = to_string(*left), right_unit = to_string(*right);
    const std::string& block =
        equation.left.block >= 0 ? flat_.blocks[size_t(equation.left.block)].path : *equation.declared;
    const auto report = [&](std::string message, std::string_view what, std::string found) {
      auto& p = problems_.error(*equation.place, equation.place->pointer(), block, std::move(message));
      p.expected = fmt::format("a {} in {}", what, left_unit);
      p.found = std::move(found);
      p.hint = hint_for(equation, *left, *right);
    };
    if (equation.rule)
      return report(fmt::format("{} is [{}] by its arguments, and [{}] by what reads it",
                                name_of(equation, equation.left), right_unit, left_unit),
                    "result", right_unit);
    if (equation.is_parameter())
      return report(fmt::format("the parameter \"{}\" has the wrong unit", equation.left.name), "number",
                    equation.right.name.empty() ? right_unit
                                                : fmt::format("{} in {}", equation.right.name, right_unit));
    report(fmt::format("{} [{}] is wired to {} [{}]", name_of(equation, equation.left), left_unit,
                       name_of(equation, equation.right), right_unit),
           "signal", right_unit);
  }

  std::string hint_for(const Equation& equation, const Unit& left, const Unit& right) const {
    if (is_scaled_rate(left) || is_scaled_rate(right))
      return "revolutions per minute are rpm, and a plain rate is in 1/s: state which of them is meant";
    if (left.same_dimension(right))
      return "hertz count cycles: a Gain of {\"value\": \"=2*pi\", \"unit\": \"rad/(Hz*s)\"} makes radians "
             "of them";
    if (has_bare_factor(equation.left.block) || has_bare_factor(equation.right.block))
      return "a bare gain keeps the unit of its input; it can have one of its own, as in {\"value\": 20, "
             "\"unit\": "
             "\"N/A\"}";
    return "";
  }
  bool has_bare_factor(int block) const {
    const auto& numbers = flat_.settings.with_units;
    const auto [begin, end] = std::ranges::equal_range(numbers, block, {}, &NumberWithUnit::block);
    return block >= 0 && std::ranges::any_of(begin, end, [](const NumberWithUnit& number) {
             return number.info->plain_when_bare && !(number.value && number.value->unit);
           });
  }

  /// The position of a moving part is a length or an angle, whatever force and mass are given.
  void check_position(int b) {
    const int position = said_.types_of(b).position();
    if (position < 0) return;
    const auto& unit = variables_[said_.variable_of(b, {position, 1})];
    static const Unit meter = parse_unit("m").value();
    if (!unit || unit->fits(meter) || unit->fits(Unit{})) return;
    const FlatBlock& block = flat_.blocks[size_t(b)];
    auto& p = problems_.error(block.entry->place, block.entry->place.pointer(), block.path,
                              fmt::format("the position would be in {}", to_string(*unit)));
    p.expected = "m or rad";
    const auto& inputs = block.type->info.inputs;
    for (size_t i = 0; i < inputs.size(); ++i)
      if (const auto known = value({b, &said_.types_of(b).of_input(i), {}}))
        p.found += fmt::format("{}{} [{}]", p.found.empty() ? "" : ", ", inputs[i].name, to_string(*known));
    p.hint =
        "the units of its numbers and wires do not go together: is a force constant missing, such as a "
        "Gain of {\"value\": 20, \"unit\": \"N/A\"}?";
  }

  void check_formula(const Equation& equation) {
    const auto& unit = equation.rule->unit;
    if (!unit || (unit->finding != UnitFinding::mixed && unit->finding != UnitFinding::mixed_turns)) return;
    const FlatBlock& block = flat_.blocks[size_t(equation.left.block)];
    const Value::Member* const at = block.entry->settings.find(unit->parameter);
    const Place& place = unit->place ? *unit->place : at ? at->value.place : *equation.place;
    auto& p = problems_.error(place, place.pointer(), block.path,
                              unit->finding == UnitFinding::mixed
                                  ? "the formula mixes units"
                                  : "the formula adds Hz, rad/s or a rate such as 1/min");
    p.found = unit->found;
    p.hint = "a number can be given a unit as an argument: a Constant of {\"value\": 3, \"unit\": \"m\"}";
  }

  const FlatDiagram& flat_;
  Problems& problems_;
  UnitEquations said_;
  const std::vector<Equation>& equations_;
  std::vector<std::optional<Unit>> variables_;  // of all blocks
  Groups readers_;                              // equations of each variable
  std::vector<int> todo_;
  std::set<std::pair<const SourceFile*, uint32_t>> told_;
};

}  // namespace

PortUnits check_units(const FlatDiagram& flat, const Diagram& diagram, Problems& problems) {
  return UnitSolver(flat, diagram, problems).run();
}

WiresWithoutUnit wires_without_unit(const FlatDiagram& flat, const PortUnits& units) {
  WiresWithoutUnit wires;
  if (std::ranges::all_of(units.outputs, [](const auto& unit) { return unit.has_value(); })) return wires;
  std::vector<bool> is_read(units.outputs.size());
  const auto read = [&](const FlatWire& wire) {
    if (wire.is_resolved()) is_read[units.first[size_t(wire.block)] + size_t(wire.output)] = true;
  };
  for (const FlatBlock& block : flat.blocks)
    for (const auto& port : block.inputs)
      for (const FlatWire& wire : port) read(wire);
  for (const FlatLog& log : flat.log) read(log.wire);
  for (size_t b = 0; b < flat.blocks.size(); ++b) {
    const FlatBlock& block = flat.blocks[b];
    for (size_t o = 0; o < block.type->info.outputs.size(); ++o) {
      if (units.of(int(b), int(o)) || !is_read[units.first[b] + o]) continue;
      if (wires.count++ < WiresWithoutUnit::most_named)
        wires.named.push_back(
            {fmt::format("{}.{}", block.path, block.type->info.outputs[o].name), block.entry->place});
    }
  }
  return wires;
}

}  // namespace loopwright
