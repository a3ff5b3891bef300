/// Reads the members of JSON objects and words the messages about mistakes in them; shared by the parts that
/// load a diagram.
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

/// Letters, digits and underscores, not starting with a digit: names of blocks, ports and parameters.
bool is_name(std::string_view text);

/// "stage.mass" gives "stage" and "mass".
std::vector<std::string> split_path(std::string_view path);

/// "stage" and "mass" give "stage.mass".
std::string joined(std::string_view path, std::string_view name);

/// Adds "did you mean" or the list of possible names to a problem.
class KnownNames {
 public:
  KnownNames() = default;
  explicit KnownNames(std::vector<std::string> names) : names_(std::move(names)) {}
  void add(std::string name) { names_.push_back(std::move(name)); }
  void explain(Problem& problem, std::string_view wrong);

 private:
  std::vector<std::string> names_;
  int searches_left_ = 50;  // a broken file with many names must not take quadratic time
};

/// Reads for one block (or diagram), whose path is part of every message.
struct Reader {
  Problems& problems;
  std::string block;

  Problem& error(const Value& at, std::string message) const;
  Problem& error(const Value::Member& at, std::string message) const;

  /// True if the value has this kind; otherwise a problem that states what is expected.
  bool expect(const Value& value, Value::Kind kind, std::string_view what, std::string_view expected) const;
  /// The number if it is within its limits; after a problem, the value nearest to zero within the limits.
  double number(const Value& value, std::string_view what, double low = -infinity,
                double high = infinity) const;
  /// The number of an optional member; `otherwise` if it is absent.
  double optional_number(const Value& object, std::string_view key, double otherwise, double low = -infinity,
                         double high = infinity) const;
  /// The text of an optional member; empty if it is absent or not a text.
  std::string text(const Value& object, std::string_view key) const;
  /// Reports a problem unless the file states the version of the format that this build supports, and
  /// "$schema" (used by editors) and "description" (which nothing else reads) are texts.
  void check_version(const Value& file) const;
  /// Reports a problem for every member that is not in `known`.
  void reject_unknown(const Value& object, std::initializer_list<std::string_view> known,
                      std::string_view owner) const;
  /// Reports a problem unless is_name() holds for the name of the member.
  bool check_name(const Value::Member& member, std::string_view what) const;
  /// The unit named by a text; nothing after a problem.
  std::optional<Unit> unit(const Value& text) const;

  static constexpr double infinity = std::numeric_limits<double>::infinity();
};

}  // namespace loopwright
