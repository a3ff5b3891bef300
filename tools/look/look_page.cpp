#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include "tools/look/look.h"
#include "tools/report/typography.h"

namespace loopwright {
namespace {

std::string or_dash(double value, const std::string& unit) {
  return value > 0 ? report::shown(value, unit) : "–";
}

/// With a capital and a full stop.
std::string sentence(std::string text) {
  if (text.empty()) return text;
  text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
  return text.back() == '?' ? text : text + ".";
}

report::Section findings(const Look& look) {
  report::Section section{"What to ask", {}};
  for (const Finding& finding : look.findings)
    section.items.push_back(report::Notice{
        finding.name == "no_unit" || finding.name == "slower" ? report::Notice::Severity::note
                                                              : report::Notice::Severity::warning,
        sentence(finding.text) + (finding.advice.empty() ? "" : " " + sentence(finding.advice))});
  if (look.findings.empty())
    section.items.push_back(
        report::Notice{report::Notice::Severity::good,
                       "Times are even and have a unit, every column has a unit and changes."});
  return section;
}

report::Table table_of(const Look& look) {
  report::Table table;
  table.head = {"Column", "Least", "Greatest", "Mean", "Deviation", "Resolution", "Noise", "Repeats"};
  for (const LookedColumn& c : look.columns)
    table.rows.push_back({c.name, report::shown(c.least, c.unit), report::shown(c.greatest, c.unit),
                          report::shown(c.mean, c.unit), report::shown(c.deviation, c.unit),
                          or_dash(c.resolution, c.unit), or_dash(c.noise, c.unit),
                          or_dash(c.repeats_after, "s")});
  table.caption =
      "Resolution: the height of the steps in which a column changes. Noise: the standard deviation of what "
      "no "
      "smooth curve through neighbouring rows explains, an upper limit for fast signals. Repeats: the time "
      "after which the signal repeats.";
  return table;
}

report::Section time_section(const LookedTime& time) {
  report::Section section{"Time", {}};
  report::Table table{{"Quantity", "Value"}, {}, "The stamps against even samples."};
  const auto row = [&](std::string name, std::string value) {
    table.rows.push_back({std::move(name), std::move(value)});
  };
  row("Column", time.column + (time.unit.empty() ? ", no unit: s" : " [" + time.unit + "]"));
  row("From, to", report::shown(time.at.front(), "s") + " to " + report::shown(time.at.back(), "s"));
  row("A row every", or_dash(time.sample_time, "s"));
  row("Even", time.is_even ? "yes" : "no");
  row("Missing samples", fmt::format("{}", time.missing));
  row("Stamps off the grid, rms", or_dash(time.jitter, "s"));
  row("Stamps off the grid, greatest", or_dash(time.worst_jitter, "s"));
  row("Stamps written to", or_dash(time.digit, "s"));
  section.items.push_back(std::move(table));
  if (time.at.size() < 2) return section;
  report::Plot plot;
  plot.title = "From row to row";
  plot.x = {"Time", "s", false}, plot.y = {"Step of the time", "s", false};
  plot.group = "time";
  report::Series step{"step", {}, {}, report::Series::Shape::steps};
  for (size_t i = 1; i < time.at.size(); ++i)
    step.x.push_back(time.at[i - 1]), step.y.push_back(time.at[i] - time.at[i - 1]);
  plot.series.push_back(std::move(step));
  plot.caption = fmt::format("The time from each row to the next; {} on an even record without gaps.",
                             report::shown(time.sample_time, "s"));
  section.items.push_back(std::move(plot));
  return section;
}

report::Section plots(const Look& look) {
  constexpr size_t most = 40;  // more plots make no page that anyone reads
  report::Section section{"Columns", {table_of(look)}};
  size_t count = 0;
  for (const LookedColumn& c : look.columns) {
    if (++count > most) {
      section.items.push_back(
          report::Paragraph{fmt::format("The first {} of {} columns are drawn.", most, look.columns.size())});
      break;
    }
    const Column& column = *look.recording.find(c.name);
    report::Plot plot;
    plot.y = {c.name, c.unit, false};
    plot.group = "time";
    report::Series series{c.name, {}, column.values, report::Series::Shape::line};
    if (look.time) {
      plot.x = {"Time", "s", false};
      series.x = look.time->at;
    } else {
      plot.x = {"Row", "", false};
      for (size_t i = 0; i < look.rows; ++i) series.x.push_back(double(i + 1));
    }
    plot.series.push_back(std::move(series));
    plot.caption = fmt::format("{} between {} and {}.", c.name, report::shown(c.least, c.unit),
                               report::shown(c.greatest, c.unit));
    if (!c.outliers.empty()) {
      report::Series points{"out of line", {}, {}, report::Series::Shape::points};
      for (size_t row : c.outliers)
        points.x.push_back(plot.series[0].x[row]), points.y.push_back(column.values[row]);
      plot.series.push_back(std::move(points));
    }
    section.items.push_back(std::move(plot));
  }
  return section;
}

}  // namespace

report::Page look_page(const Look& look) {
  report::Page page;
  page.title = look.path.substr(look.path.rfind('/') + 1);
  page.subtitle = "Recording";
  page.facts = {{"Rows", fmt::format("{}", look.rows)},
                {"Columns", fmt::format("{}", look.recording.columns.size())}};
  page.sections.push_back(findings(look));
  page.sections.push_back(plots(look));
  if (look.time) page.sections.push_back(time_section(*look.time));
  if (!look.recording.facts.empty()) {
    report::Table facts{{"Fact", "Value"}, {}, "What the file says about itself."};
    for (const auto& [key, value] : look.recording.facts) facts.rows.push_back({key, value});
    page.sections.push_back({"Facts", {std::move(facts)}});
  }
  return page;
}

}  // namespace loopwright
