#include "tools/effects/site_effect.h"
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include "engine/diagram/expression.h"
#include "engine/diagram/formula_parser.h"
#include "engine/json/file_kind.h"
#include "engine/json/json.h"
#include "engine/json/reader.h"
#include "tools/effects/effect_files.h"
#include "tools/effects/effect_shape.h"

namespace loopwright {
namespace {

using Kind = Value::Kind;

struct NamedSignalSize {
  std::string_view name;
  double SignalSizes::*value;
};
constexpr std::array<NamedSignalSize, 4> signal_sizes{{{"lowest_signal", &SignalSizes::lowest},
                                                       {"highest_signal", &SignalSizes::highest},
                                                       {"largest_signal", &SignalSizes::largest},
                                                       {"rms_signal", &SignalSizes::rms}}};

/// NaN after a problem.
double number_of(const Value& value, const SignalSizes& sizes, Problems& problems) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (value.kind == Kind::number) return value.number;
  if (value.kind != Kind::text || !value.text.starts_with('=')) {
    problems.error(value.place, value.place.pointer(), "", "this is no bound").expected =
        "a number, or an expression such as \"=0.1*largest_signal\"";
    return unknown;
  }
  Quantity quantity;
  ExpressionSite site{value.place, "", {}};
  site.lookup = [&](const NameUse& use, const Place& place) -> const Quantity* {
    KnownNames names;
    for (const NamedSignalSize& size : signal_sizes) {
      names.add(std::string(size.name));
      if (size.name != use.name) continue;
      quantity.number = sizes.*size.value;
      return &quantity;
    }
    names.explain(problems.error(place, value.place.pointer(), "",
                                 fmt::format("there is no size \"{}\" of a signal", use.name)),
                  use.name);
    return nullptr;
  };
  const auto result = evaluate(std::string_view(value.text).substr(1), site, problems);
  return result ? result->number : unknown;
}

class SiteEffectReader {
 public:
  SiteEffectReader(const Value& file, Problems& problems) : file_(file), reader_{problems, ""} {}

  SiteEffect read() {
    reject_unknown(reader_, file_, site_effect_shape(), "an effect at a site");
    reader_.check_version(file_);
    effect_.name = text("effect"), effect_.title = text("title"), effect_.physics = text("physics");
    effect_.sites = kinds("site", {});
    effect_.signals = kinds("of", {"site"});
    effect_.is_distortion = effect_.signals == std::vector<std::string>{"site"};
    if (effect_.is_distortion) effect_.signals.clear();
    if (const Value::Member* of = file_.find("of");
        of && of->value.items.size() > 1 &&
        std::ranges::any_of(of->value.items, [](const Value& kind) { return kind.text == "site"; })) {
      auto& p = reader_.error(*of, "\"of\" names \"site\" beside other kinds");
      p.hint = "an effect on its own signal and one on others are two files";
    }
    if (const Value::Member* list = file_.find("parameters");
        list &&
        reader_.expect(list->value, Kind::object, "\"parameters\"", "an object of parameters by name"))
      for (const Value::Member& member : list->value.members) read_parameter(member);
    std::ranges::stable_sort(effect_.parameters, std::greater{}, &SiteEffectParameter::is_linear);
    effect_.formula = text("formula");
    if (!reader_.problems.has_errors()) check_numbers();
    if (!reader_.problems.has_errors()) check_formula();
    return std::move(effect_);
  }

 private:
  std::string text(std::string_view key) {
    const std::string found = reader_.text(file_, key);
    if (found.empty() && !file_.find(key))
      reader_.error(file_, fmt::format("the effect has no \"{}\"", key)).expected = "a text";
    return found;
  }

  /// A kind, or a list of them; "any" is an empty list.
  std::vector<std::string> kinds(std::string_view key, const std::vector<std::string>& further) {
    const Value::Member* member = file_.find(key);
    if (!member) {
      reader_.error(file_, fmt::format("the effect has no \"{}\"", key)).expected =
          "\"force\", \"any\", or a list such as [\"force\", \"voltage\"]";
      return {};
    }
    std::vector<Value> items{member->value};
    if (member->value.kind == Kind::list) items = member->value.items;
    if (items.empty())
      reader_.error(member->value, fmt::format("\"{}\" names no kind of signal", key)).expected =
          "\"any\", or at least one kind, such as [\"force\"]";
    std::vector<std::string> list;
    for (const Value& item : items) {
      if (!reader_.expect(item, Kind::text, fmt::format("\"{}\"", key), "a kind of signal in quotes"))
        continue;
      if (item.text == "any") return {};
      if (std::ranges::find(site_kinds(), item.text) == site_kinds().end() &&
          std::ranges::find(further, item.text) == further.end()) {
        KnownNames names(site_kinds());
        names.add("any");
        for (const std::string& name : further) names.add(name);
        names.explain(reader_.error(item, fmt::format("no signal is of the kind \"{}\"", item.text)),
                      item.text);
      }
      list.push_back(item.text);
    }
    return list;
  }

  void read_parameter(const Value::Member& member) {
    if (!reader_.check_name(member, "a parameter") ||
        !reader_.expect(member.value, Kind::object, "a parameter", "{\"linear\": true, \"unit\": …}"))
      return;
    const Value& body = member.value;
    reject_unknown(reader_, body, site_parameter_shape(), "a parameter of an effect at a site");
    SiteEffectParameter p;
    p.name = member.name, p.place = member.place, p.description = reader_.text(body, "description");
    if (const Value::Member* linear = body.find("linear"))
      p.is_linear = reader_.expect(linear->value, Kind::boolean, "\"linear\"", "true or false") &&
                    linear->value.boolean;
    read_unit(body, p);
    if (!p.is_linear) read_range(body, p);
    for (const char* key : {"range", "points", "scale"})
      if (const Value::Member* unused = p.is_linear ? body.find(key) : nullptr)
        reader_.error(*unused, fmt::format("a linear parameter has no \"{}\"", key)).hint =
            "it is estimated without limits";
    effect_.parameters.push_back(std::move(p));
  }

  /// "$site/$signal^1.5" of a linear parameter, "$signal" of another.
  void read_unit(const Value& body, SiteEffectParameter& p) {
    constexpr std::string_view by_signal = "$site/$signal";
    const std::string unit = reader_.text(body, "unit");
    std::string_view rest = unit;
    if (p.is_linear && unit == "$site") return;
    if (p.is_linear && rest.starts_with(by_signal)) {
      rest.remove_prefix(by_signal.size());
      p.power = 1;
      if (rest.empty()) return;
      char* end = nullptr;
      p.power = rest[0] == '^' ? std::strtod(rest.data() + 1, &end) : 0;
      if (end && *end == '\0' && std::isfinite(p.power) && p.power > 0) return;
    }
    if (!p.is_linear && unit == "$signal") return;
    const Value::Member* member = body.find("unit");
    auto& problem = member ? reader_.error(*member, "the parameter cannot have this unit")
                           : reader_.error(body, fmt::format("the parameter \"{}\" has no \"unit\"", p.name));
    problem.expected = p.is_linear ? "\"$site\", \"$site/$signal\" or \"$site/$signal^1.5\"" : "\"$signal\"";
  }

  void read_range(const Value& body, SiteEffectParameter& p) {
    const Value::Member* range = body.find("range");
    if (!range || range->value.kind != Kind::list || range->value.items.size() != 2) {
      (range ? reader_.error(*range, "a range has two ends")
             : reader_.error(body, fmt::format("the parameter \"{}\" has no \"range\"", p.name)))
          .expected = "\"range\": [\"=lowest_signal\", \"=highest_signal\"], or \"linear\": true";
      return;
    }
    p.low = range->value.items[0], p.high = range->value.items[1];
    const double points = reader_.optional_number(body, "points", 8, 1, most_site_points);
    p.points = int(points);
    if (const std::string scale = reader_.text(body, "scale"); !scale.empty()) {
      p.is_logarithmic = scale == "logarithmic";
      if (!p.is_logarithmic && scale != "linear")
        KnownNames({"linear", "logarithmic"})
            .explain(reader_.error(*body.find("scale"), "there is no such scale"), scale);
    }
    const SignalSizes example{-0.4, 0.6, 0.6, 0.3};
    const size_t before = reader_.problems.list().size();
    const double low = number_of(p.low, example, reader_.problems),
                 high = number_of(p.high, example, reader_.problems);
    if (reader_.problems.list().size() != before) return;
    if (!(low < high)) reader_.error(*range, "the range is empty").found = shown(range->value);
    if (p.is_logarithmic && low <= 0)
      reader_.error(*range, "only a range above 0 can have this scale").found = shown(range->value);
  }

  void check_numbers() {
    const auto linear = size_t(std::ranges::count_if(effect_.parameters, &SiteEffectParameter::is_linear));
    const size_t others = effect_.parameters.size() - linear;
    const auto reject = [&](const char* what, const char* expected) {
      reader_.error(file_, what).expected = expected;
    };
    if (linear > most_linear_parameters || others > most_other_parameters)
      reject("the effect has too many parameters", "at most two that are linear, and two others");
    if (effect_.is_distortion && linear > 0)
      reject("a distortion has no linear parameter: it is added to its own signal as it is",
             "only parameters in the unit of the signal");
    if (!effect_.is_distortion && linear == 0)
      reject("the effect has no linear parameter: its size is unknown", "a parameter with \"linear\": true");
    for (size_t i = 1; i < linear; ++i)
      if (effect_.parameters[i].power != effect_.parameters[0].power)
        reject("linear parameters of different units", "the same power of $signal in all of them");
  }

  /// The formula can be read, knows its names, and is proportional to the linear parameters.
  size_t linear_count() const {
    return size_t(std::ranges::count_if(effect_.parameters, &SiteEffectParameter::is_linear));
  }

  /// `values` are those of signal and parameters. Where a formula has no value, as a root of a negative
  /// signal, nothing is compared.
  bool is_proportional(FormulaParser& parser, std::vector<double>& values) const {
    const size_t linear = linear_count();
    for (const double signal : {-0.7, 0.2, 1.3}) {
      values[0] = signal;
      for (const double sign : {1.0, -1.0}) {
        double sum = 0;
        for (size_t c = 0; c < linear; ++c) {
          for (size_t i = 0; i < linear; ++i) values[i + 1] = i == c ? 1.0 : 0.0;
          sum += sign * (2.0 + double(c)) * parser.Eval();
        }
        for (size_t i = 0; i < linear; ++i) values[i + 1] = sign * (2.0 + double(i));
        const double together = parser.Eval();
        if (linear > 0 && std::isfinite(sum) && !(std::abs(together - sum) <= 1e-9 * (1 + std::abs(sum))))
          return false;
      }
    }
    return true;
  }

  /// Signal, other parameters, and for a distortion the value, in a unit that is smaller by a factor; linear
  /// parameters by its power.
  bool keeps_its_value(FormulaParser& parser, std::vector<double>& values) const {
    constexpr double factor = 3;
    for (const double signal : {-0.7, 0.2, 1.3}) {
      const auto value_in = [&](double unit) {
        values[0] = unit * signal;
        for (size_t i = 0; i < effect_.parameters.size(); ++i) {
          const SiteEffectParameter& p = effect_.parameters[i];
          const double number = 0.4 + 0.3 * double(i);
          values[i + 1] = number * (p.is_linear ? std::pow(unit, -p.power) : unit);
        }
        return parser.Eval();
      };
      const double expected = value_in(1) * (effect_.is_distortion ? factor : 1), found = value_in(factor);
      if (std::isfinite(expected) && !(std::abs(found - expected) <= 1e-9 * (1 + std::abs(expected))))
        return false;
    }
    return true;
  }

  void check_formula() {
    std::vector<double> values(effect_.parameters.size() + 1, 1.0);
    FormulaParser parser;
    const auto problem = [&](std::string message) -> Problem& {
      return reader_.error(*file_.find("formula"), std::move(message));
    };
    try {
      parser.DefineConst("pi", 3.14159265358979323846);
      parser.DefineVar("signal", &values[0]);
      for (size_t i = 0; i < effect_.parameters.size(); ++i)
        parser.DefineVar(effect_.parameters[i].name, &values[i + 1]);
      parser.set_formula(effect_.formula);
      if (!is_proportional(parser, values))
        problem("the formula is not proportional to its linear parameters").found = effect_.formula;
      else if (!keeps_its_value(parser, values)) {
        auto& p = problem("the units of the formula do not fit");
        p.expected = "with its parameters, a value in the unit of the site";
        p.found = effect_.formula;
        p.hint = "in another unit of the signal, with its parameters converted, it must have the same value";
      }
    } catch (const mu::ParserError& error) {
      auto& p = problem("the formula cannot be read");
      p.found = FormulaParser::message_of(error);
      p.hint = "it knows the name signal";
      for (const SiteEffectParameter& parameter : effect_.parameters) p.hint += ", " + parameter.name;
    }
  }

  const Value& file_;
  Reader reader_;
  SiteEffect effect_;
};

}  // namespace

const std::vector<std::string>& site_kinds() {
  static const std::vector<std::string> kinds = {"position",    "level", "velocity", "force",   "torque",
                                                 "temperature", "heat",  "voltage",  "current", "flow"};
  return kinds;
}

std::optional<SiteEffect> load_site_effect(const std::string& path, Problems& problems) {
  Problems own;
  std::optional<SiteEffect> effect;
  const auto source = read_source(path, {}, own);
  const Value file = source ? parse_json(source, own) : Value{};
  const Reader reader{own, ""};
  if (!own.has_errors() && reader.expect(file, Kind::object, "an effect", "an object in braces") &&
      expect_kind(file, FileKind::effect, own) && file.find("site")) {
    effect = SiteEffectReader(file, own).read();
    effect->path = path;
    if (!effect->name.empty() && std::filesystem::path(path).stem() != effect->name)
      reader.error(file, fmt::format("the effect \"{}\" stands in a file of another name", effect->name))
          .expected = effect->name + ".json";
  }
  for (const Problem& problem : own.list()) problems.add(problem);
  if (own.has_errors()) effect.reset();
  return effect;
}

std::vector<SiteEffect> load_site_effects(const std::vector<std::string>& folders, Problems& problems) {
  std::vector<SiteEffect> effects;
  for (const std::string& folder : folders)
    for (const std::string& file : effect_files(folder, problems))
      if (auto effect = load_site_effect(file, problems)) {
        std::erase_if(effects, [&](const SiteEffect& e) { return e.name == effect->name; });
        effects.push_back(std::move(*effect));
      }
  std::ranges::stable_sort(effects, {}, &SiteEffect::name);
  return effects;
}

SignalRange range_of(const SiteEffectParameter& parameter, const SignalSizes& sizes) {
  Problems of_a_checked_file;
  const double low = number_of(parameter.low, sizes, of_a_checked_file),
               high = number_of(parameter.high, sizes, of_a_checked_file);
  return {low, std::max(low, high)};
}

}  // namespace loopwright
