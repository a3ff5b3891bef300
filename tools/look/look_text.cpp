#include <fmt/format.h>
#include <algorithm>
#include <nlohmann/json.hpp>
#include "tools/look/look.h"
#include "tools/report/typography.h"

namespace loopwright {
namespace {

std::string number(double value) { return fmt::format("{:.5g}", value); }

std::string time_text(const LookedTime& time) {
  std::string text = fmt::format("  time: \"{}\"{}, {:.9g} to {:.9g} s", time.column,
                                 time.unit.empty() ? " (no unit: s)" : fmt::format(" [{}]", time.unit),
                                 time.at.front(), time.at.back());
  if (time.at.size() < 2) return text + "\n";
  text += fmt::format(", a row every {:.6g} s ({:.6g} Hz)", time.sample_time, 1 / time.sample_time);
  text += time.is_even ? (time.missing ? ", even but for gaps" : ", even") : ", not even";
  if (time.jitter > 0)
    text += fmt::format("\n  stamps: {:.3g} s rms off the grid, at most {:.3g} s", time.jitter,
                        time.worst_jitter);
  if (time.digit > 0)
    text += fmt::format("{}written to {:g} s", time.jitter > 0 ? ", " : "\n  stamps: ", time.digit);
  return text + "\n";
}

std::string some_resolution(const LookedColumn& column) {
  return column.resolution > 0 ? number(column.resolution) : "-";
}
std::string some_noise(const LookedColumn& column) { return column.noise > 0 ? number(column.noise) : "-"; }

}  // namespace

std::string to_text(const Look& look) {
  std::string text =
      fmt::format("{}: {} row{}, {} column{}\n", look.path, look.rows, look.rows == 1 ? "" : "s",
                  look.recording.columns.size(), look.recording.columns.size() == 1 ? "" : "s");
  if (look.time) text += time_text(*look.time);
  size_t width = 6, unit = 4;
  for (const LookedColumn& column : look.columns)
    width = std::max(width, report::text_width(column.name)),
    unit = std::max(unit, report::text_width(column.unit));
  const auto padded = [](const std::string& word, size_t to) {
    return word + std::string(to - std::min(to, report::text_width(word)), ' ');
  };
  text += fmt::format("  {}  {} {:>12} {:>12} {:>12} {:>12} {:>11} {:>11}  {}\n", padded("column", width),
                      padded("unit", unit), "least", "greatest", "mean", "deviation", "resolution", "noise",
                      "repeats");
  const auto figure = [&](const LookedColumn& column, double value) {
    return column.not_finite == look.rows ? "-" : number(value);  // remarks have no figures
  };
  for (const LookedColumn& column : look.columns)
    text += fmt::format("  {}  {} {:>12} {:>12} {:>12} {:>12} {:>11} {:>11}  {}\n",
                        padded(column.name, width), padded(column.unit, unit), figure(column, column.least),
                        figure(column, column.greatest), figure(column, column.mean),
                        figure(column, column.deviation), some_resolution(column), some_noise(column),
                        column.repeats_after > 0 ? fmt::format("after {:.4g} s", column.repeats_after) : "-");
  for (const Finding& finding : look.findings)
    text +=
        fmt::format("- {}\n{}", finding.text, finding.advice.empty() ? "" : "    " + finding.advice + "\n");
  return text;
}

std::string to_json(const Look& look) {
  using Json = nlohmann::ordered_json;
  Json json = {{"file", look.path}, {"rows", look.rows}};
  if (look.time) {
    const LookedTime& t = *look.time;
    Json gaps = Json::array();
    for (const LookedTime::Gap& gap : t.gaps)
      gaps.push_back({{"behind_s", gap.behind}, {"samples", gap.samples}});
    json["time"] = {{"column", t.column},
                    {"unit", t.unit},
                    {"start_s", t.at.front()},
                    {"end_s", t.at.back()},
                    {"sample_time_s", t.sample_time},
                    {"even", t.is_even},
                    {"missing_samples", t.missing},
                    {"gaps", gaps},
                    {"jitter_s", t.jitter},
                    {"worst_jitter_s", t.worst_jitter},
                    {"written_to_s", t.digit}};
  } else {
    json["time"] = nullptr;
  }
  json["columns"] = Json::array();
  for (const LookedColumn& c : look.columns) {
    Json rows = Json::array();
    for (size_t row : c.outliers) rows.push_back(row);
    json["columns"].push_back({{"name", c.name},
                               {"unit", c.unit},
                               {"least", c.least},
                               {"greatest", c.greatest},
                               {"mean", c.mean},
                               {"deviation", c.deviation},
                               {"resolution", c.resolution},
                               {"noise", c.noise},
                               {"rows_between_changes", c.every},
                               {"repeats_after_s", c.repeats_after},
                               {"not_finite", c.not_finite},
                               {"first_hole", c.first_hole},
                               {"outlier_rows", rows}});
  }
  json["findings"] = Json::array();
  for (const Finding& f : look.findings)
    json["findings"].push_back({{"name", f.name}, {"text", f.text}, {"advice", f.advice}});
  json["facts"] = Json::array();
  for (const auto& [key, value] : look.recording.facts)
    json["facts"].push_back({{"key", key}, {"value", value}});
  return json.dump(2) + "\n";
}

}  // namespace loopwright
