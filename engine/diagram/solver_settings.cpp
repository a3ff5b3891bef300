#include "engine/diagram/solver_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include "engine/diagram/names_elsewhere.h"
#include "engine/json/stated_number.h"

namespace loopwright {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const Unit second = {1.0, {0, 0, 1}};

constexpr std::array<std::string_view, 6> methods = {"euler",  "heun",      "rk4",
                                                     "dopri5", "cvode-bdf", "cvode-adams"};
constexpr std::array<std::string_view, 2> ways_with_loops = {"error", "solve"};
constexpr double largest_seed = 9007199254740992.0;  // 2^53: every integer up to this is a double

enum class Range { any, positive, not_negative };

class SettingsReader {
 public:
  SettingsReader(const Value& object, ParameterScope& scope, const Reader& reader)
      : object_(object), scope_(scope), reader_(reader) {}

  void number(std::string_view key, const Unit& unit, Range range, Setting<double>& to) {
    const Value value = evaluated(key, to);
    if (!to.is_given || !is_number(value, key, unit)) return;
    const bool inside =
        range == Range::any || value.number > 0 || (range == Range::not_negative && value.number == 0);
    if (!inside) {
      Problem& problem = reader_.error(value, fmt::format("\"{}\" is out of range", key));
      problem.expected = range == Range::positive ? "a number above 0" : "a number of at least 0";
      problem.found = shown(value);
      return;
    }
    to.value = value.number;
  }

  void whole(std::string_view key, Setting<uint64_t>& to) {
    const Value value = evaluated(key, to);
    if (!to.is_given || !is_number(value, key, Unit{})) return;
    if (value.number < 0 || value.number > largest_seed || value.number != std::floor(value.number)) {
      Problem& problem = reader_.error(value, fmt::format("\"{}\" is out of range", key));
      problem.expected = "a whole number from 0 to 2^53";
      problem.found = shown(value);
      return;
    }
    to.value = static_cast<uint64_t>(value.number);
  }

  void choice(std::string_view key, const std::vector<std::string>& choices, Setting<std::string>& to) {
    const Value value = evaluated(key, to);
    const std::string expected = fmt::format("one of {}", fmt::join(choices, ", "));
    if (!to.is_given || !reader_.expect(value, Value::Kind::text, fmt::format("\"{}\"", key), expected))
      return;
    if (std::ranges::find(choices, value.text) != choices.end()) {
      to.value = value.text;
      return;
    }
    Problem& problem = reader_.error(
        value,
        fmt::format("there is no {} \"{}\"", key == "method" ? "solver method" : "choice", value.text));
    problem.expected = expected;
    const NameElsewhere* const elsewhere = key == "method" ? find_name_elsewhere(value.text) : nullptr;
    const bool is_solver = elsewhere && !elsewhere->method.empty();
    const std::string near = is_solver ? std::string(elsewhere->method) : nearest_name(value.text, choices);
    if (!near.empty()) problem.hint = fmt::format("did you mean \"{}\"?", near);
  }

  bool is_number(const Value& value, std::string_view key, const Unit& unit) {
    if (value.kind != Value::Kind::number) {
      if (value.is_broken) return false;  // reported when it was loaded
      Problem& problem = reader_.error(value, fmt::format("\"{}\" is of the wrong kind", key));
      problem.expected = unit == Unit{} ? "a number" : fmt::format("a number in {}", to_string(unit));
      problem.found = shown(value);
      if (value.kind == Value::Kind::text) problem.hint = hint_for_quoted_number(value.text);
      return false;
    }
    if (!value.unit || value.unit->fits(unit)) return true;
    // The period 1/f of a frequency in Hz, or 2*pi/w of one in rad/s, is a time for each cycle.
    if (value.is_computed && value.unit->same_dimension(unit)) return true;
    Problem& problem = reader_.error(value, fmt::format("the unit does not fit \"{}\"", key));
    problem.expected = to_string(unit);
    problem.found = shown_unit(value);
    return false;
  }

 private:
  template <class T> Value evaluated(std::string_view key, Setting<T>& to) {
    const Value::Member* member = object_.find(key);
    if (!member) return {};
    to.is_given = true;
    to.place = member->value.place;
    return scope_.evaluate(member->value, reader_.block);
  }

  const Value& object_;
  ParameterScope& scope_;
  const Reader& reader_;
};

}  // namespace

FileShape solver_shape() {
  using namespace shapes;
  const auto key = [](std::string_view name, FileShape shape, std::string sentence) {
    shape.is_evaluated = true;
    return optional(name, std::move(shape), std::move(sentence));
  };
  FileShape positive = number(0);
  positive.low_is_open = true;
  return object({key("method", choice({methods.begin(), methods.end()}), "With a fixed or a variable step"),
                 key("start", number(), "Time of the first instant [s]"),
                 key("stop", number(), "Time of the last instant [s]"),
                 key("step", positive, "Of a method with a fixed step [s]"),
                 key("maximum_step", positive, "Of a method with a variable step [s]"),
                 key("relative_tolerance", positive, "Error of a step over the size of the state"),
                 key("absolute_tolerance", positive, "Error of a step, for states near zero"),
                 key("record_step", positive, "Time between rows of the recording [s]"),
                 key("algebraic_loops", choice({ways_with_loops.begin(), ways_with_loops.end()}),
                     "An error, or solved by Newton's method"),
                 key("seed", whole(0, largest_seed), "Of all random signals")});
}

SolverSettings read_solver_settings(const Value& object, ParameterScope& scope, const Reader& reader) {
  SolverSettings solver;
  solver.place = object.place;
  if (!reader.expect(object, Value::Kind::object, "\"solver\"", "an object")) return solver;
  reject_unknown(reader, object, solver_shape(), "the solver");
  SettingsReader read(object, scope, reader);
  read.choice("method", {methods.begin(), methods.end()}, solver.method);
  read.number("start", second, Range::any, solver.start);
  read.number("stop", second, Range::any, solver.stop);
  read.number("step", second, Range::positive, solver.step);
  read.number("maximum_step", second, Range::positive, solver.maximum_step);
  read.number("relative_tolerance", Unit{}, Range::positive, solver.relative_tolerance);
  read.number("absolute_tolerance", Unit{}, Range::positive, solver.absolute_tolerance);
  read.number("record_step", second, Range::positive, solver.record_step);
  read.choice("algebraic_loops", {ways_with_loops.begin(), ways_with_loops.end()}, solver.algebraic_loops);
  read.whole("seed", solver.seed);
  if (solver.stop.is_given && solver.stop.value < solver.start.value) {
    Problem& problem = reader.problems.error(solver.stop.place, solver.stop.place.pointer(), reader.block,
                                             "the run stops before it starts");
    problem.expected = fmt::format("at least {} s", solver.start.value);
    problem.found = fmt::format("{} s", solver.stop.value);
  }
  return solver;
}

std::optional<Value> read_time(const Value& value, std::string_view what, ParameterScope& scope,
                               const Reader& reader) {
  Value time = scope.evaluate(value, reader.block);
  if (!SettingsReader(value, scope, reader).is_number(time, what, second)) return {};
  const bool is_offset = what == "sample_offset";
  if (is_offset ? time.number >= 0 : time.number > 0) return time;
  Problem& problem = reader.error(time, fmt::format("\"{}\" is out of range", what));
  problem.expected = is_offset ? "a number of at least 0, in s" : "a number above 0, in s";
  problem.found = shown(time);
  return {};
}

}  // namespace loopwright
