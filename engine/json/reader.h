/// Reads the members of JSON objects and words what is wrong with them; shared by the parts that load a
/// diagram.
#pragma once
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <vector>
#include "engine/json/problem.h"
#include "engine/json/value.h"

namespace loopwright {

/// "the text "abc"", "a list of 3", "the number 0.5" …
std::string shown(const Value& value);

/// The unit of a number that has one, and the expression it comes from: "kg from =2*mass".
std::string shown_unit(const Value& number);

/// Letters, digits and underscores, not starting with a digit: blocks, ports and parameters.
bool is_name(std::string_view text);

/// "stage.mass" gives "stage" and "mass".
std::vector<std::string> split_path(std::string_view path);

/// "stage" and "mass" give "stage.mass".
std::string joined(std::string_view path, std::string_view name);

/// Adds "did you mean" to a problem, or what would have been possible.
class KnownNames {
 public:
  KnownNames() = default;
  explicit KnownNames(std::vector<std::string> names) : names_(std::move(names)) {}
  void add(std::string name) { names_.push_back(std::move(name)); }
  void explain(Problem& problem, std::string_view wrong);

 private:
  std::vector<std::string> names_;
  int searches_left_ = 50;  // a broken file of many names shall not cost the square of their number
};

/// Reads on behalf of one block (or diagram), whose path stands in every message.
struct Reader {
  Problems& problems;
  std::string block;

  Problem& error(const Value& at, std::string message) const;
  Problem& error(const Value::Member& at, std::string message) const;

  /// True when the value is of the kind; else a problem that says what is expected.
  bool expect(const Value& value, Value::Kind kind, std::string_view what, std::string_view expected) const;
  /// The number within its limits; after a problem the nearest of them to nothing.
  double number(const Value& value, std::string_view what, double low = -infinity,
                double high = infinity) const;
  /// That of an optional member; `otherwise` when it is absent.
  double optional_number(const Value& object, std::string_view key, double otherwise, double low = -infinity,
                         double high = infinity) const;
  /// The text of an optional member; empty when it is absent or no text.
  std::string text(const Value& object, std::string_view key) const;
  /// A problem unless the file states the version of the format that this build knows, and its "$schema",
  /// which is for editors, is a text.
  void check_version(const Value& file) const;
  /// A problem for every member that is not among `known`.
  void reject_unknown(const Value& object, std::initializer_list<std::string_view> known,
                      std::string_view owner) const;
  /// A problem unless the name of the member is_name().
  bool check_name(const Value::Member& member, std::string_view what) const;
  /// The unit that a text names; nothing after a problem.
  std::optional<Unit> unit(const Value& text) const;

  static constexpr double infinity = std::numeric_limits<double>::infinity();
};

}  // namespace loopwright
