#include "tools/effects/member_reader.h"
#include <cmath>
#include <fmt/format.h>
#include "tools/effects/effect_shape.h"

namespace loopwright {

using Kind = Value::Kind;

std::string MemberReader::text(const Value& owner, std::string_view key, std::string_view what) const {
  const std::string found = reader.text(owner, key);
  if (found.empty() && !owner.find(key))
    reader.error(owner, fmt::format("{} has no \"{}\"", what, key)).expected = "a text";
  return found;
}

bool MemberReader::flag(const Value& owner, std::string_view key) const {
  const Value::Member* found = owner.find(key);
  return found && reader.expect(found->value, Kind::boolean, fmt::format("\"{}\"", key), "true or false") &&
         found->value.boolean;
}

double MemberReader::number(const Value& owner, std::string_view key, double otherwise) const {
  return reader.optional_number(owner, key, otherwise, 0);
}

int MemberReader::count(const Value& owner, std::string_view key, int otherwise) const {
  const double given = number(owner, key, otherwise);
  if (given <= most_counted && given == std::floor(given)) return int(given);
  reader.error(*owner.find(key), fmt::format("\"{}\" is no count", key)).expected =
      fmt::format("a whole number from 0 to {}", most_counted);
  return otherwise;
}

std::vector<std::string> MemberReader::texts(const Value& list, std::string_view what) const {
  std::vector<std::string> found;
  if (!reader.expect(list, Kind::list, what, "a list of texts")) return found;
  for (const Value& item : list.items)
    if (reader.expect(item, Kind::text, what, "a text in quotes")) found.push_back(item.text);
  return found;
}

bool MemberReader::expect_computed(const Value& value, std::string_view what) const {
  const bool fits = value.kind == Kind::number || (value.kind == Kind::text && value.text.starts_with('='));
  if (fits || value.is_broken) return fits;
  auto& p = reader.error(value, fmt::format("{} is of the wrong kind", what));
  p.expected = "a number, or \"=\" and an expression", p.found = shown(value);
  return false;
}

Excitation read_needs(const Value& needs, const MemberReader& read) {
  reject_unknown(read.reader, needs, needs_shape(), "\"needs\"");
  Excitation e;
  e.text = read.text(needs, "text", "\"needs\"");
  e.directions = read.count(needs, "directions", 1), e.speeds = read.count(needs, "speeds", 1);
  e.accelerations = read.count(needs, "accelerations", 0);
  e.reversals = read.count(needs, "reversals", 0), e.passes = read.count(needs, "passes", 1);
  e.periods = read.number(needs, "periods", 0), e.duration_s = read.number(needs, "duration_s", 0);
  e.varied_force = read.flag(needs, "varied_force");
  return e;
}

static SeparatingExperiment read_experiment(const Value& value, const MemberReader& read) {
  SeparatingExperiment e;
  const Reader& reader = read.reader;
  if (!reader.expect(value, Kind::object, "\"experiment\"", "an object")) return e;
  reject_unknown(reader, value, separating_experiment_shape(), "an experiment");
  e.text = read.text(value, "text", "the experiment");
  if (const auto* speeds = value.find("speeds");
      speeds && reader.expect(speeds->value, Kind::list, "\"speeds\"", "a list of numbers")) {
    e.speeds.clear();
    for (const Value& speed : speeds->value.items)
      if (reader.expect(speed, Kind::number, "a speed", "a number")) e.speeds.push_back(speed.number);
    if (e.speeds.empty()) reader.error(*speeds, "the experiment has no speed");
  }
  e.distance = read.number(value, "distance", 1), e.acceleration = read.number(value, "acceleration", 1);
  e.passes = read.count(value, "passes", 1), e.pause_s = read.number(value, "pause_s", 0.2);
  e.added_mass = read.number(value, "added_mass", 0);
  e.chirp_amplitude = read.number(value, "chirp_amplitude", 0);
  e.chirp_from_hz = read.number(value, "chirp_from_hz", 1);
  e.chirp_to_hz = read.number(value, "chirp_to_hz", 100);
  return e;
}

std::vector<ConfusableEffect> read_confusable(const Value& list, const MemberReader& read) {
  const Reader& reader = read.reader;
  std::vector<ConfusableEffect> effects;
  if (!reader.expect(list, Kind::list, "\"confusable\"", "a list of objects")) return effects;
  for (const Value& item : list.items) {
    if (!reader.expect(item, Kind::object, "a confusable effect", "{\"with\": …, \"experiment\": …}"))
      continue;
    reject_unknown(reader, item, confusable_shape(), "a confusable effect");
    ConfusableEffect other;
    other.with = read.text(item, "with", "the confusable effect");
    other.when = reader.text(item, "when");
    if (const auto* experiment = item.find("experiment"))
      other.experiment = read_experiment(experiment->value, read);
    else
      reader.error(item, "the experiment that separates them is missing").expected = "\"experiment\": {…}";
    effects.push_back(std::move(other));
  }
  return effects;
}

}  // namespace loopwright
