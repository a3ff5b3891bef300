#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/compare/compare.h"
#include "tools/report/typography.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

using report::Series;

report::KeyNumbers::Number key(std::string label, double value, const std::string& unit,
                               std::string note = "") {
  const report::Quantity q = report::engineering(value, unit);
  return {std::move(label), q.value, q.unit, std::move(note)};
}
std::string per_second(const std::string& unit) { return unit.empty() || unit == "1" ? "1/s" : unit + "/s"; }

/// The residual on the rows that count; gaps elsewhere.
std::vector<double> counted(const ForceAnalysis& f) {
  std::vector<double> values = f.residual.value;
  for (size_t k = 0; k < values.size(); ++k)
    if (!f.motion.counts[k]) values[k] = std::nan("");
  return values;
}

/// Mean of the residual over small intervals of a variable, forward and backward separately.
report::Plot against(const ForceAnalysis& f, std::string title, std::string axis, const std::string& unit,
                     const std::vector<double>& variable, int bins) {
  report::Plot plot;
  plot.title = std::move(title);
  plot.x = {std::move(axis), unit == "1" ? "" : unit, false};
  plot.y = {"Missing force", f.motion.force_unit, false};
  Series cloud{"every row", {}, {}, Series::Shape::points};
  double low = 1e300, high = -1e300;
  for (size_t k = 0; k < variable.size(); ++k) {
    if (!f.motion.counts[k]) continue;
    cloud.x.push_back(variable[k]), cloud.y.push_back(f.residual.value[k]);
    low = std::min(low, variable[k]), high = std::max(high, variable[k]);
  }
  plot.series.push_back(std::move(cloud));
  for (int direction : {1, -1}) {
    std::vector<double> sum(size_t(bins), 0.0), count(size_t(bins), 0.0);
    for (size_t k = 0; k < variable.size(); ++k) {
      if (!f.motion.counts[k] || (f.motion.velocity[k] > 0) != (direction > 0) || high <= low) continue;
      const auto b = whole_index((variable[k] - low) / (high - low) * bins, size_t(bins));
      sum[b] += f.residual.value[k], count[b] += 1;
    }
    Series mean{direction > 0 ? "mean, forward" : "mean, backward", {}, {}, Series::Shape::line};
    for (int b = 0; b < bins; ++b) {
      if (count[size_t(b)] < 3) continue;
      mean.x.push_back(low + (high - low) * (b + 0.5) / bins),
          mean.y.push_back(sum[size_t(b)] / count[size_t(b)]);
    }
    if (!mean.x.empty()) plot.series.push_back(std::move(mean));
  }
  return plot;
}

report::Section residual_section(const Comparison& c) {
  const ForceAnalysis& f = *c.force;
  const std::string &force = f.motion.force_unit, &position = f.motion.position_unit;
  report::Section section{"The force that the model lacks", {}};
  section.items.push_back(
      report::Paragraph{fmt::format("The measured motion needs a force that the model does not account for: "
                                    "the force that the recorded input makes less what the model "
                                    "needs for this motion, below {:.0f} Hz, without shift in time. Rows at "
                                    "rest are left out, where friction may "
                                    "be anything.",
                                    f.residual.cutoff)});
  report::KeyNumbers numbers;
  numbers.numbers = {key("Missing force, RMS", f.residual.rmse, force,
                         fmt::format("{:.2f} % of the force that acts there", f.residual.relative_percent)),
                     key("Noise floor", f.residual.noise_floor, force, f.residual.floor_source),
                     key("Position, open loop, RMS", f.open_loop.whole_record, position, "begun once")};
  for (const auto& [horizon, error] : f.open_loop.restarted)
    numbers.numbers.push_back(
        key(fmt::format("Position, restarted every {:g} ms", 1e3 * horizon), error, position));
  section.items.push_back(std::move(numbers));
  report::Plot in_time;
  in_time.x = {"Time", "s", false}, in_time.y = {"Missing force", force, false}, in_time.group = "time";
  in_time.series = {{"missing force", f.motion.time, counted(f), Series::Shape::line}};
  section.items.push_back(std::move(in_time));
  section.items.push_back(against(f, "Against position", "Position", position, f.motion.position, 200));
  section.items.push_back(
      against(f, "Against velocity", "Velocity", per_second(position), f.motion.velocity, 80));
  return section;
}

report::Section where_section(const ForceAnalysis& f) {
  report::Section section{"Where it lies, and on what it depends", {}};
  report::Table parts{{"Part of the motion", "Share of the squared residual", "Share of the time"},
                      {},
                      "The residual in the parts of the motion."};
  for (const ResidualShare& s : f.where)
    if (!s.label.empty())
      parts.rows.push_back(
          {s.label, fmt::format("{:.1f} %", 100 * s.share), fmt::format("{:.1f} %", 100 * s.of_rows)});
  section.items.push_back(std::move(parts));
  report::Table table{
      {"Variable", "Explains (%)", "By chance (%)", "Period"},
      {},
      "What a smooth function of the variable explains on parts of the record that it was not "
      "fitted to. What is not above chance counts as nothing."};
  for (const Dependence& d : f.dependence) {
    std::string name = d.variable;
    std::ranges::replace(name, '_', ' ');
    const bool has_period = d.at > 0 && d.share > 0;
    table.rows.push_back(
        {name, fmt::format("{:.1f}", 100 * d.share), fmt::format("{:.1f}", 100 * std::max(0.0, d.by_chance)),
         has_period ? report::shown(1 / d.at, name[0] == 's' ? f.motion.position_unit : "s") : ""});
  }
  section.items.push_back(std::move(table));
  return section;
}

report::Section excitation_section(const ForceAnalysis& f) {
  report::Section section{"What this record can tell", {}};
  for (const RecordFault& fault : f.faults)
    section.items.push_back(
        report::Notice{report::Notice::Severity::warning, fault.text + ": " + fault.cost + "."});
  const RecordContent& c = f.content;
  section.items.push_back(report::Paragraph{
      fmt::format("It holds {:.3g} s with {} direction{}, {} different speed{}, {} reversals and {} pass{} "
                  "of the same motion.",
                  c.sizes.duration, c.directions, c.directions == 1 ? "" : "s", c.speeds,
                  c.speeds == 1 ? "" : "s", c.reversals, c.passes, c.passes == 1 ? "" : "es")});
  report::Table table{{"Effect", "Can be identified", "What is missing"},
                      {},
                      "Effects that the motion of this record would show."};
  for (const Identifiability& entry : f.identifiable) {
    std::string name = entry.effect;
    std::ranges::replace(name, '_', ' ');
    table.rows.push_back({name, entry.can_be_found ? "yes" : "no", entry.lacks});
  }
  section.items.push_back(std::move(table));
  return section;
}

}  // namespace

std::vector<report::Section> force_sections(const Comparison& c) {
  if (c.force) return {residual_section(c), where_section(*c.force), excitation_section(*c.force)};
  if (c.why_no_force.empty()) return {};
  return {{"The force that the model lacks",
           {report::Notice{report::Notice::Severity::note,
                           "It could not be worked out: " + c.why_no_force + "."}}}};
}

}  // namespace loopwright
