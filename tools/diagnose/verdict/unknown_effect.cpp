#include "tools/diagnose/verdict/unknown_effect.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include "engine/json/json.h"
#include "tools/diagnose/search/unknown.h"
#include "tools/effects/json_text.h"
#include "tools/report/typography.h"

namespace loopwright::diagnosis {
namespace {

/// The first of the variables in a form: that of the lookup.
std::string first_variable(const std::string& form) { return form.substr(0, form.find(',')); }

struct Range {
  double low = 0, high = 0;
};
Range range_of_lookup(const std::string& variable, const RecordSizes& sizes) {
  if (variable == "velocity") return {-sizes.top_speed, sizes.top_speed};
  if (variable == "time")
    return {sizes.start + range_of_time(sizes).first, sizes.start + range_of_time(sizes).second};
  return {sizes.lowest_position, sizes.highest_position};
}

/// A clock may be that of the day: its numbers keep all their digits.
std::string exact_number(double number) { return fmt::format("{}", number); }

std::string list_of(const std::vector<double>& numbers, std::string (*text_of)(double)) {
  std::string text;
  for (double number : numbers) text += (text.empty() ? "" : ", ") + text_of(number);
  return "[" + text + "]";
}

/// Straight lines between so many points within each interval of the spline leave at most about 1/72 of the
/// curvature's height over an interval.
constexpr size_t points_per_interval = 3;

std::string lookup(const Member& member, const Range& range, const std::string& wire, bool is_by_clock) {
  const size_t points = (member.linear.size() - spline_degree) * points_per_interval + 1;
  std::vector<double> at, value;
  for (size_t i = 0; i < points; ++i) {
    const double fraction = double(i) / double(points - 1);
    at.push_back(range.low + fraction * (range.high - range.low));
    value.push_back(spline_at(member.linear, fraction));
  }
  return fmt::format(
      R"({{"type": "Lookup1D", "description": "No effect of the catalogue has this shape. Beyond the record its ends are held.", "breakpoints": {}, "values": {}, "interpolation": "linear", "outside": "hold", "in": {{"u": "{}"}}}})",
      list_of(at, is_by_clock ? exact_number : readable_number), list_of(value, readable_number), wire);
}

/// Its phase is that at the first row.
std::string tone(const Member& member, double start) {
  const double turns = start / member.nonlinear[0];
  return fmt::format(R"({{"force": {{"type": "Sine", "amplitude": {}, "frequency": {}, "phase": {}}}}})",
                     readable_number(std::hypot(member.linear[0], member.linear[1])),
                     exact_number(1 / member.nonlinear[0]),
                     readable_number(std::remainder(
                         std::atan2(member.linear[1], member.linear[0]) - 2 * std::numbers::pi * turns,
                         2 * std::numbers::pi)));
}

std::string jump(const Member& member, double start) {
  return fmt::format(R"({{"force": {{"type": "Step", "time": {}, "after": {}}}}})",
                     exact_number(start + member.nonlinear[0]), readable_number(member.linear[0]));
}

/// The blocks, and the output that is the force.
std::pair<std::string, std::string> blocks_of(const Member& member, const RecordSizes& sizes) {
  const std::string& form = member.candidate->form;
  if (form == "time" && sizes.clocks_differ) return {};
  if (member.candidate->is_periodic) return {tone(member, sizes.start), "force.y"};
  if (member.candidate->jumps) return {jump(member, sizes.start), "force.y"};
  const std::string variable = first_variable(form);
  const bool is_by_clock = variable == "time";
  const std::string table =
      lookup(member, range_of_lookup(variable, sizes), is_by_clock ? "clock.time" : variable, is_by_clock);
  if (form == "time")
    return {fmt::format(R"({{"clock": {{"type": "Clock"}}, "force": {}}})", table), "force.y"};
  if (form == "position,velocity")
    return {
        fmt::format(
            R"({{"damping": {}, "force": {{"type": "Product", "in": {{"factors": ["damping.y", "velocity"]}}}}}})",
            table),
        "force.product"};
  if (form == "position,direction")
    return {
        fmt::format(
            R"({{"level": {}, "direction": {{"type": "PreslidingFriction", "level": 1, "transition_distance": {}, "in": {{"position": "position"}}}}, "force": {{"type": "Product", "in": {{"factors": ["level.y", "direction.fraction"]}}}}}})",
            table, readable_number(transition_of_direction(sizes))),
        "force.product"};
  if (form == variable) return {fmt::format(R"({{"force": {}}})", table), "force.y"};
  return {};
}

}  // namespace

std::optional<Effect> effect_of_unknown(const Member& member, const RecordSizes& sizes) {
  const auto [blocks, from] = blocks_of(member, sizes);
  if (blocks.empty()) return {};
  Effect effect;
  effect.name = "unknown_" + member.candidate->form;
  std::ranges::replace(effect.name, ',', '_');
  effect.title = "A function of " + member.candidate->form + " without a name";
  std::ranges::replace(effect.title, ',', ' ');
  Problems problems;  // of texts in this file
  effect.blocks = parse_json(std::make_shared<SourceFile>(SourceFile{effect.name, blocks}), problems);
  Attachment attachment;
  attachment.from = from;
  effect.attachments.push_back(std::move(attachment));
  return effect;
}

std::string told_instant(double time, double sample_time) {
  const int digits = int(std::clamp(std::ceil(-std::log10(sample_time)), 0.0, 9.0));
  return fmt::format("{:.{}f} s", time, digits);
}

std::string range_of_unknown(const Member& member, const RecordSizes& sizes, const MachineUnits& units) {
  if (member.candidate->is_periodic) return "";
  if (member.candidate->jumps)
    return "a step at " + told_instant(sizes.start + member.nonlinear[0], sizes.sample_time);
  const std::string variable = first_variable(member.candidate->form);
  const Range range = range_of_lookup(variable, sizes);
  const std::string unit = variable == "velocity" ? units.position + "/s" : units.position;
  const auto shown = [&](double value) {
    if (variable == "time") return told_instant(value, sizes.sample_time);
    const report::Quantity q = report::engineering(value, unit);
    return q.value + " " + q.unit;
  };
  return fmt::format("a lookup over {} from {} to {}; beyond them its ends are held", variable,
                     shown(range.low), shown(range.high));
}

}  // namespace loopwright::diagnosis
