#include "engine/plan/unit_equations.h"
#include <algorithm>
#include "engine/unit/scaled_rate.h"

namespace loopwright {

static const UnitExpression no_unit{};

UnitEquations::UnitEquations(const FlatDiagram& flat, const Diagram& diagram)
    : flat_(flat), diagram_(diagram) {
  number_variables();
  for (size_t b = 0; b < flat.blocks.size(); ++b) add_block(int(b));
  add_declarations(diagram, "");
}

bool UnitEquations::is_position(size_t variable) const {
  const size_t block =
      size_t(std::ranges::upper_bound(first_variable_, variable) - first_variable_.begin()) - 1;
  return types_of_blocks_[block]->is_position(int(variable - first_variable_[block]));
}

void UnitEquations::number_variables() {
  types_of_blocks_.reserve(flat_.blocks.size()), first_variable_.reserve(flat_.blocks.size());
  for (const FlatBlock& block : flat_.blocks) {
    const TypeUnits& type = types_.try_emplace(block.type, block.type->info).first->second;
    types_of_blocks_.push_back(&type), first_variable_.push_back(variables_);
    variables_ += type.variables();
  }
}
void UnitEquations::add_block(int b) {
  const FlatBlock& block = flat_.blocks[size_t(b)];
  const BlockInfo& info = block.type->info;
  for (size_t i = 0; i < info.inputs.size(); ++i)
    for (const FlatWire& wire : block.inputs[i]) {
      if (info.inputs[i].unit == any_unit) continue;
      const End source = wire.is_resolved() ? output_end(wire) : open_input_end(wire);
      if (!source.expression) continue;
      Equation equation{
          {b, &types_of_blocks_[size_t(b)]->of_input(i), info.inputs[i].name}, source, &wire.at->place};
      equation.is_open_input = !wire.is_resolved();
      add_equation(equation);
    }
  if (info.unit_power || info.formula_unit) add_rule(b);
  if (info.unit_claims) add_claims(b);
  const auto& numbers = flat_.settings.with_units;
  for (; next_number_ < numbers.size() && numbers[next_number_].block == b; ++next_number_)
    add_number(numbers[next_number_]);
}

/// Equations that are already settled would only use memory; they are most of the equations.
void UnitEquations::add_equation(const Equation& equation) {
  if (!equation.is_settled()) equations_.push_back(equation);
}

void UnitEquations::add_number(const NumberWithUnit& number) {
  const UnitExpression unit{number.unit(), {}};
  const FlatBlock& block = flat_.blocks[size_t(number.block)];
  Equation equation{
      {number.block, &types_of_blocks_[size_t(number.block)]->of(number.info->unit), number.name},
      {-1, &unit, number.value ? std::string_view(number.value->text) : std::string_view()},
      number.value ? &number.value->place : &block.entry->place};
  equation.is_bare = !number.value || !number.value->unit;
  if (equation.is_settled()) return;
  equation.right.expression = &constants_.emplace_back(unit);
  equations_.push_back(equation);
}

/// The first output of a product or formula.
void UnitEquations::add_rule(int b) {
  const FlatBlock& block = flat_.blocks[size_t(b)];
  const BlockInfo& info = block.type->info;
  Rule& rule = rules_.emplace_back();
  rule.is_formula = info.formula_unit != nullptr;
  for (const auto& port : block.inputs)
    for (const FlatWire& wire : port) {
      const End source = wire.is_resolved() ? output_end(wire) : open_input_end(wire);
      if (!source.expression) return;
      const int i = int(rule.arguments.size());
      rule.arguments.push_back({source, rule.is_formula ? 1.0 : info.unit_power(block.value.get(), i)});
    }
  equations_.push_back({{b, &types_of_blocks_[size_t(b)]->of_output(0), info.outputs[0].name},
                        {-1, &no_unit, {}},
                        &block.entry->place,
                        nullptr,
                        &rule});
}

void UnitEquations::add_claims(int b) {
  const FlatBlock& block = flat_.blocks[size_t(b)];
  for (const UnitClaim& claim : block.type->info.unit_claims(block.value.get())) {
    const Value::Member* const at = block.entry->settings.find(claim.parameter);
    equations_.push_back({{b, &types_of_blocks_[size_t(b)]->of(claim.unit), claim.parameter},
                          {-1, constant(claim.is), {}},
                          at ? &at->value.place : &block.entry->place});
  }
}

End UnitEquations::output_end(const FlatWire& wire) const {
  const PortInfo& output = flat_.blocks[size_t(wire.block)].type->info.outputs[size_t(wire.output)];
  return {wire.block, &types_of_blocks_[size_t(wire.block)]->of_output(size_t(wire.output)), output.name};
}

End UnitEquations::open_input_end(const FlatWire& wire) {
  const int open = wire.open_input();
  if (open < 0) return {};
  const DiagramInput& input = diagram_.inputs[size_t(open)];
  const auto unit = input.unit.empty() ? std::nullopt : parse_unit(input.unit);
  return {-1, unit ? constant(kept_in_si(*unit)) : nullptr, input.name};
}

/// Inputs and outputs that diagrams declare with a unit.
void UnitEquations::add_declarations(const Diagram& diagram, const std::string& prefix) {
  const auto declare = [&](const std::string& name, const std::string& unit_text, const Place& place) {
    if (unit_text.empty()) return;
    const auto unit = parse_unit(unit_text);
    const FlatWire* const wire = declared(prefix + name);
    if (!unit || !wire || !wire->is_resolved()) return;
    equations_.push_back({{-1, constant(kept_in_si(*unit)), {}},
                          output_end(*wire),
                          &place,
                          &declared_paths_.emplace_back(prefix + name)});
  };
  if (!prefix.empty())
    for (const DiagramInput& input : diagram.inputs) declare(input.name, input.unit, input.place);
  for (const DiagramOutput& output : diagram.outputs) declare(output.name, output.unit, output.place);
  for (const BlockEntry& block : diagram.blocks)
    if (block.subdiagram) add_declarations(*block.subdiagram, prefix + block.name + ".");
}

/// The wire behind a port of a subdiagram.
const FlatWire* UnitEquations::declared(const std::string& path) {
  if (declared_.empty())
    for (const auto* names : {&flat_.names, &flat_.outputs})
      for (const FlatName& name : *names) declared_[name.name] = &name.wire;
  const auto found = declared_.find(path);
  return found == declared_.end() ? nullptr : found->second;
}

}  // namespace loopwright
