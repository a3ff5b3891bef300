#include "engine/diagram/parameter_scope.h"

#include <algorithm>
#include <fmt/format.h>
#include "engine/diagram/value_file.h"
#include "engine/json/matrix_form.h"
#include "engine/json/take_unit.h"
#include "engine/unit/scaled_rate.h"

namespace loopwright {
namespace {

/// "==" is the name of a comparison.
bool is_expression(const Value& value) {
  return value.kind == Value::Kind::text && value.text.starts_with('=') && value.text != "==";
}

/// {"value": 25, "unit": "mm"}
bool is_number_with_unit(const Value& value) {
  return value.kind == Value::Kind::object && value.members.size() == 2 && value.find("value") &&
         value.find("unit");
}

std::string_view without_spaces(std::string_view text) {
  const size_t begin = std::min(text.find_first_not_of(' '), text.size());
  return text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

/// Gives a bare number this unit.
void give_unit(Value& number, const Unit& unit) {
  number.number = unit.to_si(number.number);
  number.whole &= unit.scale == 1 && unit.offset == 0;
  number.unit = kept_in_si(unit);
}

std::string_view kind_name(Value::Kind kind) {
  switch (kind) {
    case Value::Kind::null:
      return "null";
    case Value::Kind::boolean:
      return "true or false";
    case Value::Kind::number:
      return "a number";
    case Value::Kind::text:
      return "a text";
    case Value::Kind::list:
      return "a list";
    case Value::Kind::object:
      return "an object";
  }
  return {};
}

}  // namespace

// ---- Declaration
// -----------------------------------------------------------------------------------------------

void ParameterScope::declare(const Value& parameters) {
  if (!reader_.expect(parameters, Value::Kind::object, "\"parameters\"", "an object of named values")) return;
  entries_.reserve(parameters.members.size());
  for (const Value::Member& member : parameters.members) declare_one(member);
}

void ParameterScope::declare_one(const Value::Member& member) {
  if (!reader_.check_name(member, "a parameter")) return;
  if (is_constant_name(member.name)) {
    reader_.error(member,
                  fmt::format("\"{}\" cannot be the name of a parameter: it is a constant", member.name));
    return;
  }
  if (!index_.try_emplace(member.name, entries_.size()).second)
    return;  // a duplicate, reported by parse_json
  Entry& entry = entries_.emplace_back();
  entry.parameter.name = member.name;
  entry.parameter.place = member.place;
  names_.push_back(member.name);
  known_.add(member.name);

  if (member.value.kind != Value::Kind::object || refers_to_file(member.value)) {
    entry.written = member.value;
    return;
  }
  reader_.reject_unknown(member.value, {"value", "unit", "description"}, "a parameter");
  entry.parameter.description = reader_.text(member.value, "description");
  entry.written = Value::broken(member.value);
  if (const Value::Member* unit = member.value.find("unit")) {
    entry.parameter.unit = reader_.unit(unit->value);
    if (!entry.parameter.unit) return;
  }
  if (const Value::Member* value = member.value.find("value"))
    entry.written = value->value;
  else
    reader_.error(member, fmt::format("the parameter \"{}\" has no \"value\"", member.name));
}

void ParameterScope::override_with(Override replacement) {
  if (const auto found = index_.find(replacement.name); found != index_.end()) {
    entries_[found->second].replacement = std::move(replacement);
    return;
  }
  Problem& problem =
      reader_.problems.error(replacement.place, replacement.place.pointer(), reader_.block,
                             fmt::format("the diagram has no parameter \"{}\"", replacement.name));
  known_.explain(problem, replacement.name);
}

const Value& ParameterScope::given_value(std::string_view name) const {
  const Entry& entry = entries_[index_.at(std::string(name))];
  return entry.replacement ? entry.replacement->value : entry.written;
}

std::vector<Parameter> ParameterScope::take_parameters() {
  std::vector<Parameter> parameters;
  for (Entry& entry : entries_) parameters.push_back(std::move(entry.parameter));
  entries_.clear();
  return parameters;
}

// ---- Resolution
// ------------------------------------------------------------------------------------------------

void ParameterScope::resolve() {
  for (size_t i = 0; i < entries_.size(); ++i)
    if (entries_[i].progress == Progress::untouched) resolve_from(i);
}

/// Depth first with an explicit stack: a chain of parameters may be as long as a file.
void ParameterScope::resolve_from(size_t first) {
  std::vector<size_t> stack = {first};
  const auto start = [this](Entry& entry) {
    entry.progress = Progress::in_work;
    collect_needs(entry.written, entry.needs);
    if (entry.replacement) collect_needs(entry.replacement->value, entry.needs);
  };
  start(entries_[first]);
  while (!stack.empty()) {
    Entry& entry = entries_[stack.back()];
    if (entry.next_need == entry.needs.size()) {
      work_out(entry);
      stack.pop_back();
      continue;
    }
    const size_t need = entry.needs[entry.next_need++];
    if (entries_[need].progress == Progress::untouched) {
      start(entries_[need]);
      stack.push_back(need);
    } else if (entries_[need].progress == Progress::in_work) {
      report_cycle(stack, need);
      for (const size_t member : stack) {  // members below the cycle depend on it
        entries_[member].parameter.value = Value::broken(entries_[member].written);
        entries_[member].progress = Progress::done;
      }
      return;
    }
  }
}

void ParameterScope::collect_needs(const Value& value, std::vector<size_t>& needs) const {
  if (is_expression(value)) {
    for (const NameUse& use : names_in(std::string_view(value.text).substr(1)))
      if (const auto found = index_.find(std::string(use.name)); found != index_.end() && !use.is_function)
        needs.push_back(found->second);
  }
  for (const Value& item : value.items) collect_needs(item, needs);
  for (const Value::Member& member : value.members) collect_needs(member.value, needs);
}

void ParameterScope::report_cycle(const std::vector<size_t>& stack, size_t again) {
  const auto begin = std::ranges::find(stack, again);
  const Parameter& first = entries_[again].parameter;
  std::string cycle;
  constexpr ptrdiff_t most_named = 20;
  for (auto member = begin; member != stack.end(); ++member) {
    if (member - begin == most_named) {
      cycle += "… → ";
      break;
    }
    cycle += entries_[*member].parameter.name + " → ";
  }
  Problem& problem = reader_.problems.error(first.place, first.place.pointer(), reader_.block,
                                            "parameters depend on each other in a cycle");
  problem.found = cycle + first.name;
}

void ParameterScope::work_out(Entry& entry) {
  entry.progress = Progress::done;
  Parameter& parameter = entry.parameter;
  parameter.value = evaluate(entry.written, reader_.block);
  if (!parameter.value.is_broken && fits(parameter.value, entry)) {
    if (!parameter.unit && (is_expression(entry.written) || refers_to_file(entry.written)))
      parameter.unit = parameter.value.unit;
    else
      convert(parameter.value, parameter.unit, parameter.name);
  }
  if (entry.replacement) {
    Value replacement = evaluate(entry.replacement->value, reader_.block);
    const Value::Kind wanted = parameter.value.kind;
    const bool is_known = !parameter.value.is_broken && !replacement.is_broken;
    if (is_known && reader_.expect(replacement, wanted, fmt::format("the parameter \"{}\"", parameter.name),
                                   kind_name(wanted)))
      convert(replacement, parameter.unit, parameter.name);
    parameter.value = std::move(replacement);
  }
  if (parameter.value.kind == Value::Kind::number)
    entry.quantity = Quantity{parameter.value.number, parameter.value.unit};
}

/// Numbers, flags, texts, and lists of them. Objects are not allowed, as no expression could refer to a part
/// of one.
bool ParameterScope::fits(const Value& value, const Entry& entry) {
  using enum Value::Kind;
  if (value.is_broken) return false;
  if (value.kind == null || value.kind == object) {
    Problem& problem =
        reader_.error(value, fmt::format("the parameter \"{}\" is of the wrong kind", entry.parameter.name));
    problem.expected = "a number, a text, true, false, or a list of them";
    problem.found = shown(value);
    return false;
  }
  return std::ranges::all_of(value.items, [&](const Value& item) { return fits(item, entry); });
}

/// A bare number gets this unit and is converted to SI. A number with its own unit must have the same
/// dimension.
void ParameterScope::convert(Value& value, const std::optional<Unit>& unit, const std::string& name) {
  for (Value& item : value.items) convert(item, unit, name);
  if (value.kind != Value::Kind::number) return;
  if (!value.unit) {
    if (unit) give_unit(value, *unit);
    return;
  }
  Unit wanted = unit.value_or(Unit{});
  if (!unit) wanted.exponents[Unit::radian] = value.unit->radians();
  const UnitTaken taken = take_unit(value, wanted, reader_);
  if (taken == UnitTaken::yes) {
    value.whole &= !unit || unit->scale == 1;
    return;
  }
  if (taken == UnitTaken::no) {
    Problem& problem = reader_.error(value, fmt::format("the unit does not fit the parameter \"{}\"", name));
    problem.expected = unit ? to_string(*unit) : "a bare number, as the parameter has no unit";
    problem.found = shown_unit(value);
  }
  value = Value::broken(value);
}

// ---- Evaluation
// ------------------------------------------------------------------------------------------------

Value ParameterScope::evaluate(const Value& value, const std::string& block) {
  if (is_expression(value)) return evaluate_text(value, block);
  if (is_number_with_unit(value)) return number_with_unit(value, block);
  if (refers_to_file(value)) return evaluate(value_from_file(value, {reader_.problems, block}), block);
  if (value.items.empty() && value.members.empty()) return value;
  Value result;
  result.kind = value.kind;
  set_matrix_form(result, matrix_form(value));
  result.place = value.place;
  result.items.reserve(value.items.size());
  result.members.reserve(value.members.size());
  for (const Value& item : value.items) result.items.push_back(evaluate(item, block));
  for (const Value::Member& member : value.members)
    result.members.push_back({member.name, member.place, evaluate(member.value, block)});
  return result;
}

/// A text keeps its source location, as a path is relative to that file. The value of an option has none.
static bool stands_in_file(const Value& text) {
  return text.place.file && !text.place.file->name.starts_with("--set ");
}

Value ParameterScope::evaluate_text(const Value& text, const std::string& block) {
  const std::string_view expression = std::string_view(text.text).substr(1);
  const std::string_view name = without_spaces(expression);
  if (is_name(name) && !is_constant_name(name)) {  // passes on texts and lists as well
    Place place = text.place;
    const Entry* entry = find({name, 0, false}, place, text, block);
    if (!entry || entry->parameter.value.is_broken) return Value::broken(text);
    Value value = entry->parameter.value;
    if (value.kind != Value::Kind::text || !stands_in_file(value)) value.place = text.place;
    if (value.kind == Value::Kind::number) value.text = text.text;
    return value;
  }

  const auto lookup = [&](const NameUse& use, const Place& place) -> const Quantity* {
    const Entry* entry = find(use, place, text, block);
    if (!entry || entry->parameter.value.is_broken) return nullptr;
    if (entry->quantity) return &*entry->quantity;
    Problem& problem = reader_.problems.error(place, text.place.pointer(), block,
                                              fmt::format("the parameter \"{}\" is not a number", use.name));
    problem.found = shown(entry->parameter.value);
    return nullptr;
  };
  auto known = computed_.find(text.text);
  if (known == computed_.end()) {
    const auto found = loopwright::evaluate(expression, {text.place, block, lookup}, reader_.problems);
    if (!found) return Value::broken(text);
    known = computed_.emplace(text.text, *found).first;
  }
  const Quantity& quantity = known->second;
  Value value = text;  // keeps its text: the expression
  value.kind = Value::Kind::number;
  value.number = quantity.number;
  value.unit = quantity.unit;
  value.is_computed = quantity.unit.has_value();
  return value;
}

Value ParameterScope::number_with_unit(const Value& object, const std::string& block) {
  const Reader reader{reader_.problems, block};
  const auto unit = reader.unit(object.find("unit")->value);
  Value number = evaluate(object.find("value")->value, block);
  if (!unit || number.is_broken) return Value::broken(object);
  if (!reader.expect(number, Value::Kind::number, "\"value\"", "a number")) return Value::broken(object);
  if (!number.unit) {
    give_unit(number, *unit);
    return number;
  }
  const UnitTaken taken = take_unit(number, *unit, reader);
  if (taken == UnitTaken::no) {
    Problem& problem = reader.error(number, "the unit of the expression is another one");
    problem.expected = to_string(*unit);
    problem.found = shown_unit(number);
  }
  number.whole &= unit->scale == 1;
  return taken == UnitTaken::yes ? number : Value::broken(object);
}

ParameterScope::Entry* ParameterScope::find(const NameUse& use, const Place& place, const Value& text,
                                            const std::string& block) {
  if (const auto found = index_.find(std::string(use.name)); found != index_.end())
    return &entries_[found->second];
  Problem& problem = reader_.problems.error(place, text.place.pointer(), block,
                                            fmt::format("there is no parameter \"{}\"", use.name));
  known_.explain(problem, use.name);
  if (problem.hint.empty() && problem.expected.empty())
    problem.hint = "an expression uses the \"parameters\" of its own diagram";
  return nullptr;
}

}  // namespace loopwright
