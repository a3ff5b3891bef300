#include "engine/record/mat_values.h"

#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <optional>

#include "engine/record/text.h"

namespace loopwright::mat {
namespace {

Variable unusable(std::string name, std::string reason) {
  Variable variable;
  variable.name = std::move(name);
  variable.texts = {std::move(reason)};
  return variable;
}

/// The number of elements, if the dimensions are those of a matrix and the data is complete.
std::optional<size_t> count_elements(const matvar_t& source) {
  if (source.rank != 2 || !source.dims) return std::nullopt;
  size_t count = 0, bytes = 0;
  if (__builtin_mul_overflow(source.dims[0], source.dims[1], &count)) return std::nullopt;
  if (source.data_size < 0 || __builtin_mul_overflow(count, size_t(source.data_size), &bytes))
    return std::nullopt;
  if (count > 0 && (!source.data || source.nbytes < bytes)) return std::nullopt;
  return count;
}

template <class Number>
bool copy_numbers(const matvar_t& source, size_t count, std::vector<double>& numbers) {
  if (source.data_size != sizeof(Number)) return false;
  numbers.resize(count);
  for (size_t i = 0; i < count; ++i) {
    Number number;
    std::memcpy(&number, static_cast<const char*>(source.data) + i * sizeof number, sizeof number);
    numbers[i] = static_cast<double>(number);
  }
  return true;
}

bool copy_numbers_of_any_class(const matvar_t& source, size_t count, std::vector<double>& numbers) {
  switch (source.class_type) {
    case MAT_C_DOUBLE:
      return copy_numbers<double>(source, count, numbers);
    case MAT_C_SINGLE:
      return copy_numbers<float>(source, count, numbers);
    case MAT_C_INT8:
      return copy_numbers<int8_t>(source, count, numbers);
    case MAT_C_UINT8:
      return copy_numbers<uint8_t>(source, count, numbers);
    case MAT_C_INT16:
      return copy_numbers<int16_t>(source, count, numbers);
    case MAT_C_UINT16:
      return copy_numbers<uint16_t>(source, count, numbers);
    case MAT_C_INT32:
      return copy_numbers<int32_t>(source, count, numbers);
    case MAT_C_UINT32:
      return copy_numbers<uint32_t>(source, count, numbers);
    case MAT_C_INT64:
      return copy_numbers<int64_t>(source, count, numbers);
    case MAT_C_UINT64:
      return copy_numbers<uint64_t>(source, count, numbers);
    default:
      return false;
  }
}

/// Eight-bit text is UTF-8, otherwise Latin-1.
std::string as_utf8(std::string_view text) {
  if (find_not_text(text) == std::string_view::npos) return std::string(text);
  std::u16string units;
  for (const char c : text) units += static_cast<unsigned char>(c);
  return from_utf16(units);
}

/// The text of a row of characters; nothing for other shapes.
std::optional<std::string> text_of(const matvar_t& source) {
  if (source.class_type == MAT_C_EMPTY) return "";
  const std::optional<size_t> count = count_elements(source);
  if (source.class_type != MAT_C_CHAR || !count || (*count > 0 && source.dims[0] != 1)) return std::nullopt;
  if (*count == 0) return "";
  const char* const data = static_cast<const char*>(source.data);
  if (source.data_size == 2) {
    std::u16string units(*count, u' ');
    std::memcpy(units.data(), data, 2 * *count);
    return from_utf16(units);
  }
  return source.data_size == 1 ? std::optional(as_utf8({data, *count})) : std::nullopt;
}

Variable cell_of_texts(std::string name, const matvar_t& source) {
  const std::optional<size_t> count = count_elements(source);
  Variable variable;
  for (size_t i = 0; count && i < *count; ++i) {
    const matvar_t* const cell = static_cast<matvar_t* const*>(source.data)[i];
    const std::optional<std::string> text = cell ? text_of(*cell) : "";
    if (!text) break;
    variable.texts.push_back(*text);
  }
  if (!count || variable.texts.size() != *count) return unusable(std::move(name), "a cell array");
  variable.name = std::move(name);
  variable.kind = Variable::Kind::texts;
  variable.rows = source.dims[0];
  variable.columns = source.dims[1];
  return variable;
}

/// The numbers of a log with three dimensions, of which the last is the time: a column for each instant.
std::optional<Variable> log_of_matrices(const std::string& name, const matvar_t& source) {
  if (source.rank != 3 || !source.dims || source.isComplex) return std::nullopt;
  size_t height = 0;
  if (__builtin_mul_overflow(source.dims[0], source.dims[1], &height)) return std::nullopt;
  size_t flat[2] = {height, source.dims[2]};
  matvar_t matrix = source;  // shares the data
  matrix.rank = 2, matrix.dims = flat;
  Variable variable;
  const std::optional<size_t> count = count_elements(matrix);
  if (!count || *count == 0 || !copy_numbers_of_any_class(matrix, *count, variable.numbers))
    return std::nullopt;
  variable.name = name;
  variable.kind = Variable::Kind::numbers;
  variable.rows = height, variable.columns = flat[1];
  variable.is_log_of_matrices = true;
  return variable;
}

bool is_object(const matvar_t& source) {
  return source.class_type == MAT_C_OBJECT || source.class_type == MAT_C_FUNCTION ||
         source.class_type == MAT_C_OPAQUE;
}

Variable convert(std::string name, const matvar_t& source) {
  if (is_object(source)) return unusable(std::move(name), object);
  if (std::optional<Variable> log = log_of_matrices(name, source)) return *std::move(log);
  if (source.rank != 2)
    return unusable(std::move(name), fmt::format("an array of {} dimensions", source.rank));
  if (source.class_type == MAT_C_CELL) return cell_of_texts(std::move(name), source);
  if (source.class_type == MAT_C_SPARSE) return unusable(std::move(name), "a sparse matrix");
  if (source.isComplex) return unusable(std::move(name), "complex numbers");
  Variable variable;
  if (source.class_type == MAT_C_CHAR) {
    const std::optional<std::string> text = text_of(source);
    if (!text) return unusable(std::move(name), "text of several rows");
    variable.kind = Variable::Kind::text;
    variable.texts = {*text};
  } else {
    const std::optional<size_t> count = count_elements(source);
    if (!count || !copy_numbers_of_any_class(source, *count, variable.numbers))
      return unusable(std::move(name), "no numbers, or damaged ones");
    variable.kind = Variable::Kind::numbers;
    variable.is_logical = source.isLogical != 0;
    variable.rows = source.dims[0];
    variable.columns = source.dims[1];
  }
  variable.name = std::move(name);
  return variable;
}

/// What a damaged file may contain is bounded.
constexpr int deepest = 6;
constexpr size_t most_structures = 10'000;

bool is_empty(const matvar_t& source) {
  for (int i = 0; i < source.rank; ++i)
    if (source.dims && source.dims[i] == 0) return true;
  return source.class_type == MAT_C_EMPTY;
}

void append(std::vector<Variable>& list, const std::string& name, matvar_t& source, int depth) {
  if (source.class_type != MAT_C_STRUCT) {
    list.push_back(convert(name, source));
    return;
  }
  size_t count = 0;
  if (source.rank != 2 || !source.dims || __builtin_mul_overflow(source.dims[0], source.dims[1], &count) ||
      count > most_structures || depth > deepest) {
    list.push_back(unusable(name, "an array of structures"));
    return;
  }
  const unsigned fields = Mat_VarGetNumberOfFields(&source);
  char* const* const names = Mat_VarGetStructFieldnames(&source);
  for (size_t element = 0; names && element < count; ++element)
    for (unsigned i = 0; i < fields; ++i) {
      const std::string field = as_utf8(names[i] ? names[i] : "");
      const std::string path =
          count == 1 ? name + "." + field : fmt::format("{}[{}].{}", name, element, field);
      matvar_t* const value = Mat_VarGetStructFieldByIndex(&source, i, element);
      // Logs contain many fields that are not used; only a time that is empty is a mistake.
      const bool is_time = field == "time" || field == "Time";
      if (!value || (is_empty(*value) && !is_time)) continue;
      append(list, path, *value, depth + 1);
    }
}

}  // namespace

void append(std::vector<Variable>& list, matvar_t& source) {
  append(list, as_utf8(source.name ? source.name : ""), source, 0);
}

}  // namespace loopwright::mat
