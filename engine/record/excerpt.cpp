#include "engine/record/excerpt.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "engine/unit/unit.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

constexpr double most_rows = 1e12;       // more than any file holds
constexpr double most_rows_late = 1000;  // more than any pipeline holds

ColumnError error_at(const Value& at, const Reader& reader) {
  return [&at, &reader](std::string message) -> Problem& { return reader.error(at, std::move(message)); };
}

/// Where no number is missing any more.
void forget_holes_left_out(Column& column) {
  if (std::ranges::none_of(column.values, [](double value) { return std::isnan(value); })) column.holes = {};
}

/// A time in s.
std::optional<double> time_of(const Value::Member& member, const Reader& reader) {
  const std::string what = fmt::format("\"{}\"", member.name);
  const auto stated = stated_number(member.value, what, reader);
  return stated ? in_unit(*stated, *parse_unit("s"), what, reader) : std::nullopt;
}

size_t count_of(const Value& object, std::string_view key, double otherwise, const Reader& reader,
                double most = most_rows) {
  const double count = reader.optional_number(object, key, otherwise, otherwise, most);
  if (count == std::floor(count)) return whole_count(count);
  reader.error(*object.find(key), "rows are counted in whole numbers");
  return whole_count(otherwise);
}

}  // namespace

std::vector<double> moved_earlier(const std::vector<double>& values, size_t rows) {
  std::vector<double> moved(values.size());
  for (size_t k = 0; k < values.size(); ++k) moved[k] = values[std::min(k + rows, values.size() - 1)];
  return moved;
}

FileShape Excerpt::column_shape() {
  using namespace shapes;
  return object({optional("column", text(), "Column of the data; that of this name when left out"),
                 optional("unit", text(), "Unit of the new numbers"),
                 optional("scale", number(), "value = scale * number in the file + offset"),
                 optional("offset", stated(), "In the unit of the new numbers"),
                 optional("rows_late", whole(0, most_rows_late),
                          "The log wrote each value so many rows after the row to which it belongs")});
}

FileShape Excerpt::rows_shape() {
  using namespace shapes;
  return object({optional("from", stated(), "Time of the first row that is used [s]"),
                 optional("to", stated(), "Time of the last row that is used [s]"),
                 optional("skip", whole(0, most_rows), "Rows left out at the beginning of the file"),
                 optional("decimate", whole(1, most_rows), "Every n-th of the rows is used")});
}

Excerpt Excerpt::read(const Value& file, const Reader& reader) {
  Excerpt excerpt;
  const Value::Member* columns = file.find("columns");
  if (columns && reader.expect(columns->value, Value::Kind::object, "\"columns\"",
                               "an object: new name → column, unit, scale, offset"))
    for (const Value::Member& entry : columns->value.members)
      if (auto column = read_column(entry, reader)) excerpt.columns_.push_back(*std::move(column));
  if (const Value::Member* rows = file.find("excerpt")) excerpt.read_rows(*rows, reader);
  return excerpt;
}

std::optional<Excerpt::NewColumn> Excerpt::read_column(const Value::Member& entry, const Reader& reader) {
  if (!reader.expect(entry.value, Value::Kind::object, entry.name,
                     "{\"column\": …, \"unit\": …, \"scale\": …}"))
    return {};
  reject_unknown(reader, entry.value, column_shape(), "a column");
  NewColumn column;
  column.name = entry.name, column.place = entry.place, column.at = entry.value;
  column.column = reader.text(entry.value, "column"), column.unit = reader.text(entry.value, "unit");
  if (column.column.empty()) column.column = column.name;
  column.scale = reader.optional_number(entry.value, "scale", 1);
  if (column.scale == 0)
    reader.error(*entry.value.find("scale"), "a scale of 0 leaves nothing of the column");
  if (const Value::Member* offset = entry.value.find("offset"))
    column.offset = stated_number(offset->value, "\"offset\"", reader);
  column.rows_late = count_of(entry.value, "rows_late", 0, reader, most_rows_late);
  column.is_computed = entry.value.find("scale") || entry.value.find("offset");
  return column;
}

void Excerpt::read_rows(const Value::Member& excerpt, const Reader& reader) {
  if (!reader.expect(excerpt.value, Value::Kind::object, "\"excerpt\"",
                     "{\"from\": \"2 s\", \"to\": \"10 s\"}"))
    return;
  reject_unknown(reader, excerpt.value, rows_shape(), "an excerpt");
  has_rows_ = true, rows_at_ = excerpt.value;
  if (const Value::Member* from = excerpt.value.find("from")) from_ = time_of(*from, reader).value_or(from_);
  if (const Value::Member* to = excerpt.value.find("to")) to_ = time_of(*to, reader).value_or(to_);
  skip_ = count_of(excerpt.value, "skip", 0, reader);
  decimate_ = count_of(excerpt.value, "decimate", 1, reader);
  if (to_ <= from_) reader.error(excerpt, "the excerpt ends before it begins");
}

void Excerpt::apply(Recording& recording, const std::string& time, const Reader& reader) const {
  add_columns(recording, reader);
  leave_out_rows_without_number(recording, reader);
  if (has_rows_) keep_rows(recording, time, reader);
}

std::optional<Column> Excerpt::computed(const NewColumn& wanted, const Column& from, const Reader& reader) {
  const ColumnError error = error_at(wanted.at, reader);
  Column column = from;
  column.name = wanted.name;
  if (!wanted.is_computed) {
    if (!unit_of(from, wanted.unit, error)) return {};
    if (from.unit.empty()) column.unit = wanted.unit;
    return column;
  }
  // With a scale, the heading may state another quantity: volts that mean metres. Another scale of the same
  // quantity is a contradiction as ever, because the factor between the two could be meant or forgotten.
  const auto heading = parse_unit(from.unit), stated = parse_unit(wanted.unit);
  const bool is_another_quantity =
      !from.unit.empty() && heading && stated &&
      (!heading->fits(*stated) || is_counted(from.unit) != is_counted(wanted.unit));
  if (!is_another_quantity && !unit_of(from, wanted.unit, error)) return {};
  if (!wanted.unit.empty() && !stated) return unit_of({"", wanted.unit, {}, ""}, "", error), std::nullopt;
  if (!wanted.unit.empty()) column.unit = wanted.unit;
  double offset = 0;
  if (wanted.offset) {
    const auto unit = parse_unit(column.unit);
    const auto number = unit ? in_unit(*wanted.offset, *unit, "\"offset\"", reader, true) : std::nullopt;
    if (!number) return {};
    offset = *number;
  }
  for (double& value : column.values) value = wanted.scale * value + offset;
  return column;
}

std::optional<Column> Excerpt::column_moved(const Recording& recording, const NewColumn& wanted,
                                            const ColumnError& error) {
  const Column* raw = recording.find(wanted.column);
  if (!raw || wanted.rows_late == 0) {
    raw = find_column(recording, wanted.column, error);
    return raw ? std::optional(*raw) : std::nullopt;
  }
  Column moved = *raw;
  moved.values = moved_earlier(moved.values, wanted.rows_late);
  forget_holes_left_out(moved);
  return is_without_holes(moved, error) ? std::optional(std::move(moved)) : std::nullopt;
}

void Excerpt::add_columns(Recording& recording, const Reader& reader) const {
  std::vector<Column> added;
  for (const NewColumn& wanted : columns_) {
    const auto from = column_moved(recording, wanted, error_at(wanted.at, reader));
    if (!from) continue;
    if (wanted.name != wanted.column && recording.find(wanted.name)) {
      reader.error(wanted.at, fmt::format("the data already have a column \"{}\"", wanted.name)).hint =
          "choose another name, or change that column: \"column\" is its name then";
      continue;
    }
    if (auto column = computed(wanted, *from, reader)) added.push_back(*std::move(column));
  }
  for (Column& column : added) {
    const auto same = std::ranges::find(recording.columns, column.name, &Column::name);
    if (same == recording.columns.end())
      recording.columns.push_back(std::move(column));
    else
      *same = std::move(column);
  }
}

void Excerpt::leave_out_rows_without_number(Recording& recording, const Reader& reader) const {
  const auto latest = std::ranges::max_element(columns_, {}, &NewColumn::rows_late);
  if (latest == columns_.end() || latest->rows_late == 0) return;
  if (recording.rows() < latest->rows_late + 2) {
    reader.error(latest->at, fmt::format("\"{}\" is {} rows late in a recording of {} rows", latest->name,
                                         latest->rows_late, recording.rows()));
    return;
  }
  for (Column& column : recording.columns) {
    column.values.resize(column.values.size() - latest->rows_late);
    forget_holes_left_out(column);
  }
}

void Excerpt::keep_rows(Recording& recording, const std::string& time, const Reader& reader) const {
  std::vector<char> keep(recording.rows(), 1);
  std::fill(keep.begin(), keep.begin() + std::ptrdiff_t(std::min(skip_, keep.size())), 0);
  if (from_ > -Reader::infinity || to_ < Reader::infinity) {
    const auto at = time_in_seconds(recording, time, error_at(rows_at_, reader));
    if (!at) return;
    for (size_t row = 0; row < keep.size(); ++row)
      keep[row] &= at->values[row] >= from_ && at->values[row] <= to_;
  }
  size_t inside = 0, kept = 0;
  for (char& k : keep)
    if (k) k = inside++ % decimate_ == 0, kept += size_t(k);
  if (kept < 2) {
    reader.error(rows_at_, fmt::format("the excerpt has {} of the {} rows", kept, keep.size())).expected =
        "two rows or more";
    return;
  }
  for (Column& column : recording.columns) {
    size_t row = 0;
    std::erase_if(column.values, [&](double) { return keep[row++] == 0; });
    forget_holes_left_out(column);
  }
}

}  // namespace loopwright
