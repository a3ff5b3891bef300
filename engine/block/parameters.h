/// Parameters of a block: read from a file, copied to lanes, found by path ("harmonics.0.amplitude"),
/// described.
#pragma once
#include <array>
#include <concepts>
#include <span>
#include <string>
#include <vector>
#include "engine/block/describe.h"
#include "engine/json/value.h"

namespace loopwright {

/// Collects messages about a block's parameters; passed to `check(const Checker&)` after all parameters are
/// read.
class Checker {
 public:
  Checker(const Value& settings, std::string block, Problems& problems)
      : settings_(settings), block_(std::move(block)), problems_(problems) {}
  /// An error at the source location of the parameter (or of the block, if the parameter was omitted).
  Problem& error(std::string_view parameter, std::string message) const;
  Problem& warning(std::string_view parameter, std::string message) const;
  /// Resolves a path given by a parameter, relative to the file that contains it. The contents of that file
  /// become part of the identity of the plan, however the block reads them.
  std::string resolve_file(std::string_view parameter, std::string_view path) const;
  const Value& settings() const { return settings_; }
  const std::string& block() const { return block_; }
  Problems& problems() const { return problems_; }
  /// The source location of the parameter, or of the block.
  Place place(std::string_view parameter) const;

 private:
  const Value& settings_;
  std::string block_;
  Problems& problems_;
};

/// A `file` is a text that names a file, relative to the file in which it stands. A `by_name` is an object whose
/// keys are names that the block does not know beforehand.
enum class ParameterKind { number, whole, flag, text, file, choice, list, object, by_name };

/// A parameter as used by the schema, the reference, error texts and sweeps.
struct ParameterInfo {
  std::string_view name, unit, sentence;
  ParameterKind kind = ParameterKind::number;
  double low = -infinity, high = infinity;
  bool low_is_open = false, has_default = false;
  bool is_difference = false;             ///< difference of two values: K, not degC
  bool plain_when_bare = false;           ///< a bare number is dimensionless
  bool tunable = false;                   ///< may differ between the runs of a sweep
  std::string default_text;               ///< as JSON; empty without default
  std::vector<std::string_view> choices;  ///< of a choice
  std::vector<ParameterInfo> fields;      ///< of an object, or of the objects in a list
  std::vector<ParameterInfo> element;     ///< of a list, or by name: one entry that describes its items
};

/// Names of an enumeration, in the order of its values: `constexpr auto names_of(Interpolation) { return
/// std::array{…}; }`.
template <class T>
concept Choice = std::is_enum_v<T> && requires(T t) {
  names_of(t).size();
};
template <class T>
concept Described = requires {
  T::describe();
};
/// Values by name, {"velocity": 3, "enable": 1}, in the order of the file.
template <class T> struct ByName {
  std::vector<std::pair<std::string, T>> entries;
};
template <class T> inline constexpr bool is_by_name = false;
template <class T> inline constexpr bool is_by_name<ByName<T>> = true;
template <class T>
concept List = requires(T t) {
  t.resize(1);
  t[0];
}
&&!std::same_as<T, std::string>;

/// Copies a scalar block to a block on any Real. Derived constants are not copied; `prepare` computes them.
template <class D, class S> void spread(D& to, const S& from) {
  if constexpr (Described<D>) {
    for_each<D, is_parameter>([&](auto i, const auto& d) {
      for_each<S, is_parameter>([&](auto j, const auto& s) {
        if constexpr (i() == j()) spread(to.*d.member, from.*s.member);
      });
    });
  } else if constexpr (List<D>) {
    to.resize(from.size());
    for (size_t i = 0; i < from.size(); ++i) spread(to[i], from[i]);
  } else {
    to = D(from);
  }
}

/// The tunable number at a path; null if there is none or it is structural (integers, flags, texts, choices,
/// tables).
template <class Real, class T> Real* tunable(T& at, std::string_view path) {
  if constexpr (std::is_same_v<T, Real>) {
    return path.empty() ? &at : nullptr;
  } else {
    const size_t dot = path.find('.');
    const auto head = path.substr(0, dot),
               tail = dot == path.npos ? std::string_view{} : path.substr(dot + 1);
    if constexpr (Described<T>) {
      Real* found = nullptr;
      for_each<T, is_parameter>([&](auto, const auto& p) {
        if (p.name == head) found = tunable<Real>(at.*p.member, tail);
      });
      return found;
    } else if constexpr (List<T>) {
      size_t i = 0;
      if (head.empty() || head.size() > 9) return nullptr;
      for (char digit : head) {
        if (digit < '0' || digit > '9') return nullptr;
        i = 10 * i + size_t(digit - '0');
      }
      return i < at.size() ? tunable<Real>(at[i], tail) : nullptr;
    } else if constexpr (is_by_name<T>) {
      for (auto& [name, value] : at.entries)
        if (name == head) return tunable<Real>(value, tail);
      return nullptr;
    } else {
      return nullptr;
    }
  }
}

// One message for each kind of mistake; the texts are in parameters.cpp.
namespace reading {
struct Range {
  double low = -infinity, high = infinity;
  bool low_is_open = false, is_difference = false;
  std::string_view unit, sentence;
};
bool number(double& to, const Value&, const Range&, const std::string& block, Problems&);
bool whole(int64_t& to, const Value&, const Range&, const std::string& block, Problems&);
bool flag(bool& to, const Value&, const std::string& block, Problems&);
bool text(std::string& to, const Value&, const std::string& block, Problems&);
int choice(const Value&, const std::vector<std::string_view>& names, const std::string& block,
           Problems&);  ///< -1: none
bool list(const Value&, const std::string& block, std::string_view sentence, Problems&);
bool object(const Value&, const std::string& block, Problems&);
void missing(const Value& object, std::string_view name, std::string_view unit, std::string_view sentence,
             const std::string& block, Problems&);
void unknown_keys(const Value& object, std::span<const std::string_view> names, const std::string& block,
                  Problems&);
std::string number_text(double);
}  // namespace reading

template <class B> void read_fields(B& to, const Value& object, const std::string& block, Problems& problems);

template <class T>
void read(T& to, const Value& value, const reading::Range& range, const std::string& block,
          Problems& problems) {
  if constexpr (Described<T>) {
    if (reading::object(value, block, problems)) read_fields(to, value, block, problems);
  } else if constexpr (std::is_same_v<T, std::string>) {
    reading::text(to, value, block, problems);
  } else if constexpr (std::is_same_v<T, bool>) {
    reading::flag(to, value, block, problems);
  } else if constexpr (Choice<T>) {
    const auto names = names_of(T{});
    const int i = reading::choice(value, {names.begin(), names.end()}, block, problems);
    if (i >= 0) to = T(i);
  } else if constexpr (std::is_integral_v<T>) {
    reading::Range narrow = range;
    narrow.low = std::max(range.low, double(std::numeric_limits<T>::min()));
    narrow.high = std::min(range.high, double(std::numeric_limits<T>::max()));
    int64_t number = 0;
    if (reading::whole(number, value, narrow, block, problems)) to = T(number);
  } else if constexpr (is_by_name<T>) {
    if (!reading::object(value, block, problems)) return;
    for (const Value::Member& member : value.members)
      read(to.entries.emplace_back(member.name, 0).second, member.value, range, block, problems);
  } else if constexpr (List<T>) {
    if (!reading::list(value, block, range.sentence, problems)) return;
    to.resize(value.items.size());
    for (size_t i = 0; i < to.size(); ++i) read(to[i], value.items[i], range, block, problems);
  } else {
    double number = 0;
    if (reading::number(number, value, range, block, problems)) to = number;
  }
}

template <class B>
void read_fields(B& to, const Value& object, const std::string& block, Problems& problems) {
  std::array<std::string_view, count_of<B, is_parameter>> names;
  size_t n = 0;
  for_each<B, is_parameter>([&](auto, const auto& p) {
    names[n++] = p.name;
    if (const Value::Member* found = object.find(p.name))
      read(to.*p.member, found->value, {p.low, p.high, p.low_is_open, p.is_difference, p.unit, p.sentence},
           block, problems);
    else if (!p.has_default)
      reading::missing(object, p.name, p.unit, p.sentence, block, problems);
  });
  reading::unknown_keys(object, names, block, problems);
}

template <class B> std::vector<ParameterInfo> parameters_of();

template <class T, class Real> void describe_type(ParameterInfo& info) {
  info.tunable = std::is_same_v<T, Real>;
  if constexpr (Described<T>)
    info.kind = ParameterKind::object, info.fields = parameters_of<T>();
  else if constexpr (std::is_same_v<T, std::string>)
    info.kind = ParameterKind::text;
  else if constexpr (std::is_same_v<T, bool>)
    info.kind = ParameterKind::flag;
  else if constexpr (Choice<T>) {
    info.kind = ParameterKind::choice;
    for (auto name : names_of(T{})) info.choices.push_back(name);
  } else if constexpr (std::is_integral_v<T>)
    info.kind = ParameterKind::whole;
  else if constexpr (List<T>) {
    info.kind = ParameterKind::list;
    ParameterInfo element;
    element.unit = info.unit, element.low = info.low, element.high = info.high,
    element.low_is_open = info.low_is_open, element.is_difference = info.is_difference,
    element.plain_when_bare = info.plain_when_bare;
    describe_type<typename T::value_type, Real>(element);
    info.fields = element.fields;
    info.tunable = element.tunable;
    info.element.push_back(std::move(element));
  } else if constexpr (is_by_name<T>) {
    info.kind = ParameterKind::by_name;
    ParameterInfo element;
    element.unit = info.unit;
    describe_type<typename decltype(T::entries)::value_type::second_type, Real>(element);
    info.tunable = element.tunable;
    info.element.push_back(std::move(element));
  }
}

template <class T> std::string default_text(const T& value) {
  if constexpr (std::is_same_v<T, std::string>)
    return "\"" + value + "\"";
  else if constexpr (std::is_same_v<T, bool>)
    return value ? "true" : "false";
  else if constexpr (Choice<T>)
    return "\"" + std::string(names_of(T{})[size_t(value)]) + "\"";
  else if constexpr (std::is_arithmetic_v<T>)
    return reading::number_text(double(value));
  else if constexpr (List<T>) {
    std::string text = "[";
    for (size_t i = 0; i < value.size(); ++i) text += (i ? ", " : "") + default_text(value[i]);
    return text + "]";
  } else
    return "{}";
}

/// B is a scalar block or a struct inside one.
template <class B> std::vector<ParameterInfo> parameters_of() {
  std::vector<ParameterInfo> list;
  const B defaults{};
  for_each<B, is_parameter>([&](auto, const auto& p) {
    using T = typename std::remove_cvref_t<decltype(p)>::Type;
    ParameterInfo info{p.name, p.unit, p.sentence};
    info.low = p.low, info.high = p.high, info.low_is_open = p.low_is_open, info.has_default = p.has_default;
    info.is_difference = p.is_difference, info.plain_when_bare = p.plain_when_bare;
    describe_type<T, double>(info);
    if (p.is_file) (info.element.empty() ? info : info.element.front()).kind = ParameterKind::file;
    if (p.has_default) info.default_text = default_text(defaults.*p.member);
    list.push_back(std::move(info));
  });
  return list;
}

}  // namespace loopwright
