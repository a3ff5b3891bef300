#include "engine/json/take_unit.h"
#include <algorithm>
#include <atomic>
#include <fmt/format.h>
#include "engine/unit/scaled_rate.h"

namespace loopwright {
namespace {

/// "cutoff: ", the member that holds the number.
std::string named(const Value& number) {
  std::string pointer = number.place.pointer();
  for (size_t slash = pointer.rfind('/'); slash != pointer.npos; slash = pointer.rfind('/')) {
    const std::string token = pointer.substr(slash + 1);
    const bool is_inside = token == "value" || token.find_first_not_of("0123456789") == token.npos;
    if (!is_inside) return token + ": ";
    pointer.resize(slash);
  }
  return "";
}

std::string shown(double number, const Unit& unit) {
  return fmt::format("{:.4g} {}", number, to_string(unit));
}

std::atomic<bool> changed_readings_are_named = false;

/// Once for each number of a file, however often it is read.
void warn_of_conversion(const Value& number, double converted, const Unit& wanted, const Reader& reader) {
  if (!changed_readings_are_named) return;
  Problem problem;
  problem.severity = Problem::Severity::warning;
  problem.place = number.place, problem.pointer = number.place.pointer();
  problem.block = reader.block;
  problem.message =
      fmt::format("{}{} is {}; earlier versions read {}", named(number), shown(number.number, *number.unit),
                  shown(converted, wanted), shown(number.number, wanted));
  const auto is_known = [&](const Problem& other) {
    return other.message == problem.message && other.place.file == problem.place.file &&
           other.place.offset == problem.place.offset;
  };
  if (std::ranges::none_of(reader.problems.list(), is_known)) reader.problems.add(std::move(problem));
}

void warn_of_expression(const Value& number, double converted, const Unit& wanted, const Reader& reader) {
  auto& p = reader.problems.warning(
      number.place, number.place.pointer(), reader.block,
      fmt::format("{}the expression seems to give {}, and is taken as {}", named(number),
                  shown(number.number, *number.unit), shown(number.number, wanted)));
  p.found = number.text;
  p.hint = fmt::format("{} would be {}: {} 2*pi, or give its parameters the unit {}",
                       shown(number.number, *number.unit), shown(converted, wanted),
                       wanted.cycles() == 0 ? "multiply by" : "divide by", to_string(wanted));
}

/// The same number with radians in place of counts: 2π for each.
std::string shown_in_radians(const Value& number, const Unit& wanted) {
  const Conversion turns{Conversion::Kind::turns, double{wanted.radians()} - double{number.unit->radians()}};
  return shown(turns(number.number), wanted);
}

void tell_ambiguity(const Value& number, const Unit& wanted, const Reader& reader) {
  const Unit given = number.unit->in_si();
  auto& p = reader.error(number, fmt::format("{}{} can mean two numbers here", named(number),
                                             shown(number.unit->from_si(number.number), *number.unit)));
  if (!number.text.empty()) p.found = number.text;
  p.expected = fmt::format("a number in {}", to_string(wanted));
  const bool is_count = given.cycles() == wanted.cycles();  // a rate such as 1/min, and radians
  if (is_count && is_scaled_rate(*number.unit)) {
    p.hint = fmt::format("revolutions make it {}: write rpm; a plain rate makes it {}: write 1/s",
                         shown_in_radians(number, wanted.in_si()), shown(number.number, wanted.in_si()));
    return;
  }
  if (is_count) {
    p.hint = "revolutions per minute are rpm, and radians per second rad/s";
    return;
  }
  Unit other = given;  // the same with radians instead of cycles
  other.exponents[Unit::cycle] = wanted.cycles();
  other.exponents[Unit::radian] += given.cycles() - wanted.cycles();
  const double converted = conversion(given, other)(number.number);
  const Conversion in_radians{Conversion::Kind::turns, -1};
  if (wanted.cycles() == 0)
    p.hint = fmt::format("counted once a cycle it is {}, in radians {}", shown(number.number, wanted),
                         shown(converted, other));
  else
    p.hint = fmt::format("as cycles it is {}, as radians {}", shown(number.number, wanted),
                         shown(in_radians(number.number), wanted));
}

}  // namespace

void name_changed_readings(bool on) { changed_readings_are_named = on; }

UnitTaken take_unit(Value& number, const Unit& wanted, const Reader& reader) {
  const Conversion to_wanted = conversion(*number.unit, wanted);
  if (to_wanted.kind == Conversion::Kind::impossible) return UnitTaken::no;
  const bool is_told = !number.is_computed || is_scaled_rate(*number.unit);
  if (to_wanted.kind == Conversion::Kind::ambiguous && is_told) {
    tell_ambiguity(number, wanted, reader);
    return UnitTaken::told;
  }
  if (to_wanted.kind == Conversion::Kind::turns) {
    const double converted = to_wanted(number.number);
    if (number.is_computed) {
      if (converted != number.number) warn_of_expression(number, converted, wanted.in_si(), reader);
    } else {
      if (converted != number.number) warn_of_conversion(number, converted, wanted.in_si(), reader);
      number.number = converted;
      number.whole = false;
    }
  }
  number.unit = kept_in_si(wanted);
  number.is_computed = false;
  return UnitTaken::yes;
}

}  // namespace loopwright
