#include "engine/diagram/mat_value.h"
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include "engine/json/matrix_form.h"
#include "engine/json/read_bytes.h"
#include "engine/record/mat_variables.h"

namespace loopwright {
namespace {

using Kind = Value::Kind;
using mat::Variable;

/// More than an array of structures that the reader of MAT files unfolds.
constexpr size_t most_structures = 100'000;
/// As for a JSON text: the values may take 512 MB.
constexpr size_t most_elements = (512u << 20) / sizeof(Value);

/// "signals.2.values" of "signals[2].values".
std::string as_requested(std::string_view name) {
  std::string path;
  for (const char c : name)
    if (c != ']') path += c == '[' ? '.' : c;
  return path;
}

bool is_inside(std::string_view path, std::string_view outer) {
  return path.starts_with(outer) && (path.size() == outer.size() || path[outer.size()] == '.');
}

/// Makes values with the place of the reference. Only the requested variable gets its elements: a recording
/// beside it may have millions.
class Tree {
 public:
  Tree(Place place, std::string requested)
      : place_(std::move(place)), requested_(std::move(requested)), root_(of(Kind::object)) {}

  void add(const Variable& variable) {
    Value* at = &root_;
    for (const std::string& part : split_path(variable.name)) at = &step(*at, part);
    const bool is_short = variable.numbers.size() + variable.texts.size() <= 1;
    *at =
        is_short || is_inside(requested_, as_requested(variable.name)) ? value_of(variable) : of(Kind::list);
  }
  Value take() { return std::move(root_); }

 private:
  Value of(Kind kind) const {
    Value value;
    value.kind = kind, value.place = place_;
    return value;
  }

  Value& member(Value& object, std::string_view name) const {
    if (object.kind == Kind::null) object = of(Kind::object);
    for (Value::Member& known : object.members)
      if (known.name == name) return known.value;
    object.members.push_back({std::string(name), place_, of(Kind::null)});
    return object.members.back().value;
  }

  /// The member of a structure, or of its element: "log", "signals[2]".
  Value& step(Value& object, std::string_view part) const {
    const size_t bracket = part.find('[');
    size_t index = 0;
    const char* const last = part.data() + part.size();
    const bool is_element = bracket != part.npos && part.ends_with(']') &&
                            std::from_chars(part.data() + bracket + 1, last, index).ptr == last - 1 &&
                            index < most_structures;
    Value& found = member(object, is_element ? part.substr(0, bracket) : part);
    if (!is_element) return found;
    if (found.kind == Kind::null) found = of(Kind::list);
    if (found.items.size() <= index) found.items.resize(index + 1, of(Kind::object));
    return found.items[index];
  }

  Value value_of(const Variable& variable) const {
    switch (variable.kind) {
      case Variable::Kind::numbers:
        if (variable.is_log_of_matrices) return unusable("an array of 3 dimensions");
        return matrix_of(variable, [&](size_t i) { return number(variable, i); });
      case Variable::Kind::texts:
        return matrix_of(variable, [&](size_t i) { return text(variable.texts[i]); });
      case Variable::Kind::text:
        return text(variable.texts.front());
      case Variable::Kind::other:
        break;
    }
    return unusable(variable.texts.front());
  }

  /// Whose elements lie column by column.
  template <class Element> Value matrix_of(const Variable& variable, Element element) const {
    const size_t rows = variable.rows, columns = variable.columns;
    const bool is_number = variable.kind == Variable::Kind::numbers;
    if (rows * columns > most_elements)
      return unusable(fmt::format("{} elements, more than {}", rows * columns, most_elements));
    if (rows == 1 && columns == 1 && is_number) {
      Value one = element(0);
      set_matrix_form(one, MatrixForm::one);
      return one;
    }
    Value list = of(Kind::list);
    if (rows <= 1 || columns <= 1) {
      for (size_t i = 0; i < rows * columns; ++i) list.items.push_back(element(i));
      if (is_number && !list.items.empty())
        set_matrix_form(list, rows == 1 ? MatrixForm::row : MatrixForm::column);
      return list;
    }
    list.items.resize(rows, of(Kind::list));
    for (size_t row = 0; row < rows; ++row)
      for (size_t column = 0; column < columns; ++column)
        list.items[row].items.push_back(element(column * rows + row));
    if (is_number) set_matrix_form(list, MatrixForm::full);
    return list;
  }

  Value number(const Variable& variable, size_t i) const {
    const double number = variable.numbers[i];
    Value value = of(variable.is_logical ? Kind::boolean : Kind::number);
    if (variable.is_logical)
      value.boolean = number != 0;
    else
      value.number = number, value.whole = number == std::floor(number);
    return value;
  }
  Value text(const std::string& words) const {
    Value value = of(Kind::text);
    value.text = words;
    return value;
  }
  /// A null with the reason.
  Value unusable(const std::string& reason) const {
    Value value = of(Kind::null);
    value.text = reason;
    return value;
  }

  Place place_;
  std::string requested_;
  Value root_;
};

}  // namespace

bool is_mat_path(const std::string& path) {
  constexpr std::string_view end = ".mat";
  return path.size() > end.size() &&
         std::ranges::equal(std::string_view(path).substr(path.size() - end.size()), end,
                            [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

std::string why_unusable(const Value& value) { return value.kind == Kind::null ? value.text : ""; }

std::optional<Value> values_of_mat(const std::string& path, const Value& reference, const Reader& reader) {
  const Value& named = reference.find("file")->value;
  // As large as a recording may be: the range of a Place.
  const auto file = read_bytes(path, named.place, std::numeric_limits<uint32_t>::max(), reader.problems);
  if (!file) return {};
  const mat::Variables variables = mat::read_all_variables(*file, {});
  if (!variables.failure.empty()) {
    auto& problem =
        reader.error(named, fmt::format("the MAT file \"{}\" cannot be read: {}", path, variables.failure));
    problem.hint = variables.hint;
    return {};
  }
  Tree tree(reference.place, reference.find("name")->value.text);
  for (const Variable& variable : variables.list) tree.add(variable);
  return tree.take();
}

}  // namespace loopwright
