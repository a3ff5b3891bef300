#include "engine/record/column_units.h"
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include "engine/json/reader.h"
#include "engine/json/unit_hint.h"
#include "engine/record/time_names.h"
#include "engine/record/time_words.h"

namespace loopwright {
namespace {

/// "[mm] in data.csv:1:3".
std::string heading(const Column& column) {
  return fmt::format("[{}]{}", column.unit, column.origin.empty() ? "" : " in " + column.origin);
}

bool is_same_unit(const Unit& a, const Unit& b) {
  constexpr double rounding = 1e-12;
  return a.fits(b) && a.offset == b.offset && std::abs(a.scale - b.scale) <= rounding * std::abs(b.scale);
}

void list_names(const Recording& recording, Problem& p) {
  for (const Column& column : recording.columns)
    p.expected += (p.expected.empty() ? "one of " : ", ") + column.name;
}

const Column* find_time(const Recording& recording, const std::string& name, const ColumnError& error) {
  if (!name.empty()) return find_column(recording, name, error);
  std::vector<const Column*> called;
  for (const Column& column : recording.columns)
    if (is_called_time(recording.is_ordered ? std::string_view(column.name) : last_part(column.name)))
      called.push_back(&column);
  const Column* const found = called.size() == 1                       ? called.front()
                              : called.empty() && recording.is_ordered ? &recording.columns.front()
                                                                       : nullptr;
  if (found) return is_without_holes(*found, error) ? found : nullptr;
  auto& p = error(called.empty() ? "it cannot be told which column is the time"
                                 : fmt::format("\"{}\" and \"{}\" may both be the time", called[0]->name,
                                               called[1]->name));
  list_names(recording, p);
  p.hint = "name it: \"time\": \"…\"";
  return nullptr;
}

/// Numbers without a unit are seconds, unless the name says otherwise; then nothing is assumed.
bool says_seconds(const Column& time, const ColumnError& error) {
  const TimeWords words = time_words(time.name);
  if (!words.is_counted && words.unit.empty()) return true;
  if (words.is_counted) {
    auto& p = error(fmt::format("the time \"{}\" has no unit, and its name says that it counts", time.name));
    p.expected = "a column with the time, such as \"t [ms]\"";
    p.hint = fmt::format(
        "an experiment multiplies by the duration of one count: \"columns\": {{\"t\": {{\"column\": "
        "\"{}\", \"scale\": 0.5, \"unit\": \"ms\"}}}}",
        time.name);
    if (!time.origin.empty()) p.found = time.origin;
    return false;
  }
  auto& p =
      error(fmt::format("the time \"{}\" has no unit, and its name says another one than s", time.name));
  const std::string ending = "_" + words.unit;
  const std::string name =
      time.name.ends_with(ending) ? time.name.substr(0, time.name.size() - ending.size()) : time.name;
  p.expected = fmt::format("\"{} [{}]\" as the heading of the column", name, words.unit);
  p.hint = fmt::format("or state it in the experiment: \"columns\": {{\"{}\": {{\"unit\": \"{}\"}}}}",
                       time.name, words.unit);
  if (!time.origin.empty()) p.found = time.origin;
  return false;
}

/// Milliseconds are divided by a thousand, not multiplied by the reciprocal: 0.009, not 0.009000000000000001.
void scale_time(std::vector<double>& values, double scale) {
  const double inverse = 1 / scale, whole = std::round(inverse);
  const bool divides = scale < 1 && std::abs(inverse - whole) <= 1e-9 * whole;
  for (double& t : values) t = divides ? t / whole : t * scale;
}

}  // namespace

std::optional<Unit> unit_of(const Column& column, const std::string& stated, const ColumnError& error) {
  const std::string& text = column.unit.empty() ? stated : column.unit;
  const auto unit = parse_unit(text);
  if (!unit) {
    auto& p = error(fmt::format("the unit \"{}\" cannot be read", text));
    p.expected = "a unit such as N, mm/s, rpm or degC";
    if (!column.unit.empty()) p.found = heading(column);
    p.hint = unit_hint(text);
    return {};
  }
  if (stated.empty() || column.unit.empty()) return unit;
  const auto own = parse_unit(stated);
  if (own && is_same_unit(*own, *unit) && is_counted(text) == is_counted(stated)) return unit;
  auto& p = error(own ? fmt::format("the column \"{}\" has another unit in its file", column.name)
                      : fmt::format("the unit \"{}\" cannot be read", stated));
  p.expected = heading(column);
  p.found = stated;
  p.hint = "leave out the \"unit\" if the heading is right; mend the heading if it is not";
  return {};
}

Column in_si(const Column& column, const Unit& unit) {
  Column result = column;
  for (double& value : result.values) value = unit.to_si(value);
  result.unit = to_string(unit.in_si());
  return result;
}

bool is_without_holes(const Column& column, const ColumnError& error) {
  for (const Problem& hole : column.holes.first) {
    auto& p = error(hole.message);
    p.place = hole.place, p.pointer.clear();
    p.expected = hole.expected, p.found = hole.found, p.hint = hole.hint;
  }
  if (column.holes.count > column.holes.first.size()) {
    auto& p = error(fmt::format("column \"{}\": {} more cells without a number", column.name,
                                column.holes.count - column.holes.first.size()));
    p.place = column.holes.first.back().place, p.pointer.clear();
  }
  return column.holes.count == 0;
}

const Column* find_column(const Recording& recording, const std::string& name, const ColumnError& error) {
  if (const Column* found = recording.find(name)) return is_without_holes(*found, error) ? found : nullptr;
  auto& p = error(fmt::format("the data have no column \"{}\"", name));
  std::vector<std::string> names;
  for (const Column& column : recording.columns) names.push_back(column.name);
  KnownNames(names).explain(p, name);
  return nullptr;
}

std::optional<Column> time_in_seconds(const Recording& recording, const std::string& name,
                                      const ColumnError& error) {
  const Column* found = find_time(recording, name, error);
  if (!found) return {};
  Column time = *found;
  time.unit = "s";
  if (found->unit.empty()) {
    if (says_seconds(*found, error)) return time;
    return {};
  }
  const auto unit = parse_unit(found->unit);
  if (!unit || !unit->fits(*parse_unit("s")) || unit->offset != 0) {
    auto& p = error(fmt::format("the column \"{}\" is no time", found->name));
    p.expected = "a column in s, ms, min, …";
    p.found = heading(*found);
    p.hint = "name the column with the time: \"time\": \"…\"";
    return {};
  }
  scale_time(time.values, unit->scale);
  return time;
}

bool put_time_first(Recording& recording, const ColumnError& error) {
  if (recording.columns.empty()) return false;
  const std::string& first = recording.columns.front().name;
  auto time = time_in_seconds(recording, recording.is_ordered && is_called_time(first) ? first : "", error);
  if (!time) return false;
  std::erase_if(recording.columns, [&](const Column& column) { return column.name == time->name; });
  recording.columns.insert(recording.columns.begin(), *std::move(time));
  return true;
}

}  // namespace loopwright
