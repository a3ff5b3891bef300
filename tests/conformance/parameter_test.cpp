// Parameters of every block: found by path or rejected, limited to their ranges; missing and misspelled ones
// get good messages.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include "engine/json/json.h"
#include "tests/conformance/registered.h"

namespace loopwright::parameter_test {
namespace {

class Parameters : public EveryBlock {};

Value parsed(const std::string& settings) {
  Problems problems;
  Value value = parse_json(std::make_shared<SourceFile>(SourceFile{"settings.json", settings}), problems);
  EXPECT_FALSE(problems.has_errors()) << problems.text();
  return value;
}

/// Every value of the settings that a parameter describes, with its path: "harmonics",
/// "harmonics.0.amplitude".
using Visit = std::function<void(const ParameterInfo&, Value&, const std::string& path)>;
void visit_value(const ParameterInfo& info, Value& value, const std::string& path, const Visit& visit) {
  visit(info, value, path);
  for (size_t i = 0; i < value.items.size() && !info.element.empty(); ++i)
    visit_value(info.element[0], value.items[i], path + "." + std::to_string(i), visit);
  for (Value::Member& member : value.members)
    for (const ParameterInfo& field : info.fields)
      if (field.name == member.name) visit_value(field, member.value, path + "." + member.name, visit);
}
void visit_settings(const std::vector<ParameterInfo>& parameters, Value& settings, const Visit& visit) {
  for (const ParameterInfo& info : parameters)
    for (Value::Member& member : settings.members)
      if (member.name == info.name) visit_value(info, member.value, member.name, visit);
}

/// The settings with all optional numbers written out, so that their ranges are tested too.
Value with_defaults(const std::vector<ParameterInfo>& parameters, Value settings) {
  for (const ParameterInfo& info : parameters) {
    const bool is_number = info.kind == ParameterKind::number || info.kind == ParameterKind::whole;
    if (settings.find(info.name) || !is_number ||
        !std::isfinite(std::strtod(info.default_text.c_str(), nullptr)))
      continue;
    Value value;
    value.kind = Value::Kind::number;
    value.number = std::strtod(info.default_text.c_str(), nullptr);
    settings.members.push_back({std::string(info.name), {}, value});
  }
  return settings;
}

Problems problems_with(const Specimen& specimen, const Value& settings) {
  return BlockUnderTest(specimen.type, to_json(settings), specimen.sample_time).problems();
}
bool names(const Problems& problems, const std::string& name) {
  for (const Problem& problem : problems.list())
    if (problem.severity == Problem::Severity::error && to_string(problem).find(name) != std::string::npos)
      return true;
  return false;
}

TEST_P(Parameters, AreFoundByPathWhenTunableAndRefusedWhenStructural) {
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    Value settings = parsed(specimen.settings);
    auto block = bench(specimen);
    visit_settings(info().parameters, settings,
                   [&](const ParameterInfo& parameter, Value& value, const std::string& path) {
                     const bool is_tunable = parameter.tunable && parameter.kind == ParameterKind::number;
                     if (is_tunable) {
                       EXPECT_NO_THROW(block->tune(path, value.number)) << path;
                     } else {
                       EXPECT_THROW(block->tune(path, 1.0), std::invalid_argument) << path;
                     }
                     EXPECT_THROW(block->tune(path + "x", 1.0), std::invalid_argument) << path << "x";
                     EXPECT_THROW(block->tune(path + ".x", 1.0), std::invalid_argument) << path << ".x";
                     EXPECT_THROW(block->tune(path + ".999999999", 1.0), std::invalid_argument) << path;
                     EXPECT_THROW(block->tune(path + ".99999999999999999999999", 1.0), std::invalid_argument)
                         << path;
                   });
    for (const char* wrong : {"", ".", "..", "no_such", ".no_such"})
      EXPECT_THROW(block->tune(wrong, 1.0), std::invalid_argument) << wrong;
  }
}

TEST_P(Parameters, TunedToWhatTheFileSaysGiveTheSameBits) {
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    Value settings = parsed(specimen.settings);
    auto tuned = bench(specimen), plain = bench(specimen);
    visit_settings(info().parameters, settings,
                   [&](const ParameterInfo& parameter, Value& value, const std::string& path) {
                     if (!parameter.tunable || parameter.kind != ParameterKind::number) return;
                     tuned->tune(path, value.number + 1);
                     tuned->tune(path, value.number);
                   });
    std::mt19937_64 random(1), same(1);
    for (int step = 0; step < 10; ++step) {
      random_step(*tuned, specimen, step, random);
      random_step(*plain, specimen, step, same);
      ASSERT_TRUE(equal_bits(all_outputs(*tuned), all_outputs(*plain)));
      ASSERT_EQ(tuned->snapshot(), plain->snapshot());
    }
  }
}

TEST_P(Parameters, OutOfRangeAreRefusedByName) {
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    const Value settings = with_defaults(info().parameters, parsed(specimen.settings));
    Value changed = settings;
    visit_settings(info().parameters, changed,
                   [&](const ParameterInfo& parameter, Value& value, const std::string& path) {
                     const bool is_whole = parameter.kind == ParameterKind::whole;
                     if (parameter.kind != ParameterKind::number && !is_whole) return;
                     const Value kept = value;
                     const auto refused = [&](double number) {
                       value.number = number;
                       EXPECT_TRUE(names(problems_with(specimen, changed), path.substr(path.rfind('.') + 1)))
                           << path << " = " << number;
                       value = kept;
                     };
                     if (parameter.low > -infinity)
                       refused(is_whole                ? parameter.low - 1
                               : parameter.low_is_open ? parameter.low
                                                       : std::nextafter(parameter.low, -infinity));
                     if (parameter.high < infinity)
                       refused(is_whole ? parameter.high + 1 : std::nextafter(parameter.high, infinity));
                     if (is_whole) {
                       refused(kept.number + 0.5);
                       refused(1e30);
                       refused(-1e30);
                     }
                   });
  }
}

/// Calls all methods of a block: nothing may crash or be undefined, whatever the results.
void use(const Specimen& specimen, const Value& settings) {
  Specimen changed = specimen;
  changed.settings = to_json(settings);
  if (BlockUnderTest(changed.type, changed.settings, changed.sample_time).problems().has_errors()) return;
  auto block = bench(changed);
  std::mt19937_64 random(2);
  for (int step = 0; step < 20; ++step)
    if (!random_step(*block, changed, step, random)) block->restart();
  for (double now : {-1.0, 0.0, 1.0, 1e6}) EXPECT_FALSE(std::isnan(block->next_stop(now)));
}

TEST_P(Parameters, AtTheEdgesOfTheirRangesDoNoHarm) {
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    Value settings = with_defaults(info().parameters, parsed(specimen.settings));
    visit_settings(info().parameters, settings,
                   [&](const ParameterInfo& parameter, Value& value, const std::string& path) {
                     const bool is_whole = parameter.kind == ParameterKind::whole;
                     if (parameter.kind != ParameterKind::number && !is_whole) return;
                     SCOPED_TRACE(path);
                     const Value kept = value;
                     const double lowest =
                         parameter.low == -infinity ? (is_whole ? -2147483648.0 : -1e300) : parameter.low;
                     const double first = parameter.low_is_open ? std::nextafter(lowest, infinity) : lowest;
                     for (double number : {first,
                                           is_whole                     ? 100.0
                                           : parameter.high == infinity ? 1e300
                                                                        : parameter.high,
                                           0.0, 1e-9}) {
                       if (is_whole && number != std::floor(number)) continue;
                       value.number = number;
                       use(specimen, settings);
                     }
                     value = kept;
                   });
  }
}

TEST_P(Parameters, MissingAreNamed) {
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    const Value settings = parsed(specimen.settings);
    for (const ParameterInfo& parameter : info().parameters) {
      Value without = settings;
      std::erase_if(without.members,
                    [&](const Value::Member& member) { return member.name == parameter.name; });
      const Problems problems = problems_with(specimen, without);
      const bool is_told =
          names(problems, "the parameter \"" + std::string(parameter.name) + "\" is missing");
      EXPECT_EQ(is_told, !parameter.has_default) << parameter.name << "\n" << problems.text();
    }
  }
}

TEST_P(Parameters, MistypedGetASuggestion) {
  for (const Specimen& specimen : specimens())
    for (const ParameterInfo& parameter : info().parameters) {
      Value settings = parsed(specimen.settings);
      const std::string wrong = std::string(parameter.name) + "x";
      std::erase_if(settings.members,
                    [&](const Value::Member& member) { return member.name == parameter.name; });
      settings.members.push_back({wrong, {}, Value{}});
      const Problems problems = problems_with(specimen, settings);
      EXPECT_TRUE(names(problems, "there is no parameter \"" + wrong + "\"")) << specimen.where;
      EXPECT_TRUE(names(problems, "did you mean \"")) << specimen.where << "\n" << problems.text();
    }
}

TEST_P(Parameters, OfTheWrongKindAreRefusedByName) {
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    Value settings = parsed(specimen.settings);
    visit_settings(info().parameters, settings,
                   [&](const ParameterInfo&, Value& value, const std::string& path) {
                     const Value kept = value;
                     for (Value::Kind kind : {Value::Kind::null, Value::Kind::boolean, Value::Kind::number,
                                              Value::Kind::text, Value::Kind::list, Value::Kind::object}) {
                       if (kind == kept.kind) continue;
                       value = {};
                       value.kind = kind;
                       EXPECT_TRUE(names(problems_with(specimen, settings), path.substr(path.rfind('.') + 1)))
                           << path << " as kind " << int(kind);
                     }
                     value = kept;
                   });
  }
}
LOOPWRIGHT_FOR_EVERY_BLOCK(Parameters);

// ---- words and units
// --------------------------------------------------------------------------------------------------

class Words : public EveryBlock {};

/// A unit with every variable ("$force") replaced by a concrete unit.
std::string with_variables_filled(std::string_view unit) {
  std::string text;
  for (size_t i = 0; i < unit.size();) {
    if (unit[i] != '$') {
      text += unit[i++];
      continue;
    }
    for (++i; i < unit.size() && (std::isalnum(static_cast<unsigned char>(unit[i])) || unit[i] == '_'); ++i)
      continue;
    text += "kg";
  }
  return text;
}
void expect_words(std::string_view what, std::string_view sentence, std::string_view unit_text) {
  ASSERT_FALSE(sentence.empty()) << what << " says nothing about itself";
  const bool is_symbol = sentence.substr(0, sentence.find(' ')).ends_with(':');  // "x_c: distance after …"
  EXPECT_TRUE(is_symbol || !std::islower(static_cast<unsigned char>(sentence[0])))
      << what << ": " << sentence;
  if (unit_text == any_unit) return;
  const auto unit = parse_unit(with_variables_filled(unit_text));
  ASSERT_TRUE(unit) << what << " in \"" << unit_text << "\"";
  EXPECT_EQ(unit->scale, 1) << what << " in \"" << unit_text << "\" is not in SI";
}
void expect_words_of_parameters(const std::vector<ParameterInfo>& parameters) {
  for (const ParameterInfo& parameter : parameters) {
    expect_words(parameter.name, parameter.sentence, parameter.unit);
    expect_words_of_parameters(parameter.fields);
  }
}

TEST_P(Words, AreThereAndUnitsAreSI) {
  EXPECT_FALSE(info().sentence.empty());
  EXPECT_TRUE(info().sentence.ends_with('.')) << info().sentence;
  EXPECT_FALSE(info().room.empty());
  for (const auto* ports : {&info().inputs, &info().outputs})
    for (const PortInfo& port : *ports) expect_words(port.name, port.sentence, port.unit);
  for (const CrossingInfo& crossing : info().crossings) EXPECT_FALSE(crossing.name.empty());
  expect_words_of_parameters(info().parameters);
}

TEST_P(Words, NameEveryPortAndParameterOnce) {
  const auto expect_different = [](auto list) {
    std::vector<std::string_view> all;
    for (const auto& entry : list) all.push_back(entry.name);
    std::ranges::sort(all);
    EXPECT_EQ(std::ranges::adjacent_find(all), all.end());
  };
  expect_different(info().inputs);
  expect_different(info().outputs);
  expect_different(info().parameters);
}
LOOPWRIGHT_FOR_EVERY_BLOCK(Words);

}  // namespace
}  // namespace loopwright::parameter_test
