#include "engine/plan/block_settings.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/diagram/expression.h"
#include "engine/json/matrix_form.h"

namespace loopwright {
namespace {

bool is_vector(const PortInfo& port) { return port.shape == PortInfo::Shape::vector || port.joins_vectors; }

const ParameterInfo* find_parameter(const std::vector<ParameterInfo>& parameters, std::string_view name) {
  const auto found = std::ranges::find(parameters, name, &ParameterInfo::name);
  return found == parameters.end() ? nullptr : &*found;
}

bool is_by_element(const BlockInfo& info, const Value::Member& member) {
  if (member.value.kind != Value::Kind::list || member.value.items.empty()) return false;
  const ParameterInfo* parameter = find_parameter(info.parameters, member.name);
  return parameter && parameter->kind == ParameterKind::number;
}

Value text_value(std::string text, const Place& place) {
  Value value;
  value.kind = Value::Kind::text;
  value.text = std::move(text);
  value.place = place;
  return value;
}

/// {"name": "k", "value": 3, "unit": "N/m"}, at the place of the formula.
Value constant(const Parameter& parameter, const Place& place) {
  Value number;
  number.kind = Value::Kind::number;
  number.number = parameter.value.number;
  number.text = "=" + parameter.name;
  number.place = place;
  Value entry;
  entry.kind = Value::Kind::object;
  entry.place = place;
  entry.members.push_back({"name", place, text_value(parameter.name, place)});
  entry.members.push_back({"value", place, std::move(number)});
  if (parameter.value.unit)
    entry.members.push_back({"unit", place, text_value(to_string(parameter.value.unit->in_si()), place)});
  return entry;
}

/// The texts that are formulas, also inside lists and objects.
void find_formulas(const Value& settings, std::vector<const Value*>& found) {
  for (const Value& item : settings.items) find_formulas(item, found);
  for (const Value::Member& member : settings.members)
    if (member.value.kind != Value::Kind::text)
      find_formulas(member.value, found);
    else if (member.name == "formula" || member.name == "when")
      found.push_back(&member.value);
}

/// The same inside a further list.
void wrap(Value& value, MatrixForm form) {
  Value list;
  list.kind = Value::Kind::list, list.place = value.place;
  set_matrix_form(list, form);
  list.items.push_back(std::move(value));
  value = std::move(list);
}

bool has_matrix(const Value& value, const ParameterInfo& info) {
  if (matrix_form(value) != MatrixForm::none) return info.kind == ParameterKind::list;
  if (info.fields.empty()) return false;
  const auto in_item = [&](const Value& item) { return has_matrix(item, info.element[0]); };
  const auto in_member = [&](const Value::Member& member) {
    const ParameterInfo* field = find_parameter(info.fields, member.name);
    return field && has_matrix(member.value, *field);
  };
  return (!info.element.empty() && std::ranges::any_of(value.items, in_item)) ||
         std::ranges::any_of(value.members, in_member);
}

/// Brings matrices into the forms that parameters have.
class Former {
 public:
  explicit Former(const Reader& reader) : reader_(reader) {}

  void form(Value& value, const ParameterInfo& info) const {
    if (matrix_form(value) != MatrixForm::none) return form_matrix(value, info);
    if (!info.fields.empty() && !info.element.empty())
      for (Value& item : value.items) form(item, info.element[0]);
    for (Value::Member& member : value.members)
      if (const ParameterInfo* field = find_parameter(info.fields, member.name)) form(member.value, *field);
  }

 private:
  void form_matrix(Value& value, const ParameterInfo& info) const {
    if (info.kind != ParameterKind::list) return;
    if (matrix_form(value) == MatrixForm::one) wrap(value, MatrixForm::row);
    if (info.element[0].kind != ParameterKind::list) return reject_full(value, info);
    if (matrix_form(value) == MatrixForm::column)
      for (Value& item : value.items) wrap(item, MatrixForm::none);
    if (matrix_form(value) == MatrixForm::row) wrap(value, MatrixForm::full);
    set_matrix_form(value, MatrixForm::full);
  }
  void reject_full(Value& value, const ParameterInfo& info) const {
    if (matrix_form(value) != MatrixForm::full) return;
    auto& p = reader_.error(value, "wrong kind of value");
    p.expected = "a list, as in [1, 2], or a matrix of one row or one column";
    p.found =
        fmt::format("a matrix of {} rows and {} columns", value.items.size(), value.items[0].items.size());
    p.hint = info.sentence;
    value.kind = Value::Kind::null, value.is_broken = true;
  }

  const Reader& reader_;
};

}  // namespace

std::optional<Value> settings_in_form(const BlockInfo& info, const Value& settings, const Reader& reader) {
  const auto needs = [&](const Value::Member& member) {
    const ParameterInfo* parameter = find_parameter(info.parameters, member.name);
    return parameter && has_matrix(member.value, *parameter);
  };
  if (std::ranges::none_of(settings.members, needs)) return {};
  Value result = settings;
  for (Value::Member& member : result.members)
    if (needs(member)) Former(reader).form(member.value, *find_parameter(info.parameters, member.name));
  return result;
}

bool takes_numbers_by_element(const BlockInfo& info) {
  return std::ranges::none_of(info.inputs, is_vector) && std::ranges::none_of(info.outputs, is_vector) &&
         !info.unit_power && !info.formula_unit && !info.unit_claims;
}

std::vector<Value> settings_by_element(const BlockInfo& info, const Value& settings, const std::string& path,
                                       Problems& problems) {
  const Value::Member* first = nullptr;
  for (const Value::Member& member : settings.members) {
    if (!is_by_element(info, member)) continue;
    if (!first) first = &member;
    const size_t wanted = first->value.items.size(), found = member.value.items.size();
    if (found == wanted || !takes_numbers_by_element(info)) continue;
    auto& p = problems.error(
        member.value.place, member.value.place.pointer(), path,
        fmt::format("\"{}\" and \"{}\" have different numbers of elements", first->name, member.name));
    p.expected = fmt::format("a number, or a list of {}", wanted);
    p.found = fmt::format("a list of {}", found);
    return {};
  }
  if (!first || !takes_numbers_by_element(info)) return {};
  std::vector<Value> elements(first->value.items.size(), settings);
  for (size_t e = 0; e < elements.size(); ++e)
    for (Value::Member& member : elements[e].members)
      if (is_by_element(info, member)) {
        Value item = member.value.items[e];  // a copy: it is inside of what it replaces
        member.value = std::move(item);
      }
  return elements;
}

std::optional<Value> settings_with_constants(const BlockInfo& info, const Value& settings,
                                             const std::vector<Parameter>& parameters) {
  if (!find_parameter(info.parameters, "constants")) return {};
  std::vector<const Value*> formulas;
  find_formulas(settings, formulas);
  if (formulas.empty()) return {};
  std::vector<std::string_view> hidden;
  for (const std::string_view key : {"names", "inputs"})
    if (const Value::Member* names = settings.find(key))
      for (const Value& name : names->value.items) hidden.push_back(name.text);
  const Value::Member* const written = settings.find("constants");
  if (written)
    for (const Value& entry : written->value.items)
      if (const Value::Member* name = entry.find("name")) hidden.push_back(name->value.text);

  Value list;
  if (written) list = written->value;
  list.kind = Value::Kind::list;
  list.place = written ? written->value.place : formulas[0]->place;
  for (const Value* const formula : formulas)
    for (const NameUse& use : names_in(formula->text)) {
      if (use.is_function || std::ranges::find(hidden, use.name) != hidden.end()) continue;
      const auto parameter = std::ranges::find(parameters, use.name, &Parameter::name);
      if (parameter == parameters.end() || parameter->value.kind != Value::Kind::number) continue;
      list.items.push_back(constant(*parameter, formula->place));
      hidden.push_back(use.name);
    }
  if (list.items.empty()) return {};
  Value result = settings;
  std::erase_if(result.members, [](const Value::Member& member) { return member.name == "constants"; });
  result.members.push_back({"constants", list.place, std::move(list)});
  return result;
}

}  // namespace loopwright
