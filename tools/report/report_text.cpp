#include "tools/report/report.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <span>
#include "tools/report/layout.h"
#include "tools/report/typography.h"

namespace loopwright::report {
namespace {

constexpr std::size_t page_width = 100;    ///< characters
constexpr std::size_t outline_width = 40;  ///< characters of the small curve beside a series

/// The summary of a curve in a line of text.
struct Summary {
  std::size_t samples = 0, gaps = 0;
  double low = INFINITY, high = -INFINITY, mean = 0, rms = 0;
};

Summary summarize(std::span<const double> values) {
  Summary summary;
  double sum = 0, squares = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) {
      ++summary.gaps;
      continue;
    }
    ++summary.samples;
    summary.low = std::min(summary.low, value);
    summary.high = std::max(summary.high, value);
    sum += value;
    squares += value * value;
  }
  const double count = static_cast<double>(summary.samples);
  summary.mean = sum / count;
  summary.rms = std::sqrt(squares / count);
  return summary;
}

/// Values in drawn coordinates along an axis; values that cannot be drawn are NaN.
std::vector<double> places(std::span<const double> values, bool logarithmic) {
  std::vector<double> out;
  out.reserve(values.size());
  for (const double value : values)
    out.push_back(!std::isfinite(value) || (logarithmic && value <= 0) ? NAN
                  : logarithmic                                        ? std::log(value)
                                                                       : value);
  return out;
}

/// The curve in eight heights over the range of x. Each column shows the value farthest from the middle of
/// the range.
std::string outline(const Plot& plot, const Series& series) {
  static constexpr std::string_view heights[] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const std::vector<double> x = places(series.x, plot.x.logarithmic),
                            y = places(series.y, plot.y.logarithmic);
  const Summary across = summarize(x), range = summarize(y);
  const double middle = 0.5 * (range.low + range.high);
  std::vector<double> column(outline_width, NAN);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(x[i]) || std::isnan(y[i])) continue;
    const double place = across.high > across.low ? (x[i] - across.low) / (across.high - across.low) : 0;
    double& value = column[std::min(outline_width - 1, static_cast<std::size_t>(place * outline_width))];
    if (!(std::abs(value - middle) >= std::abs(y[i] - middle))) value = y[i];
  }
  std::string out;
  for (const double value : column) {
    const double height = range.high > range.low ? (value - range.low) / (range.high - range.low) : 0.5;
    out += std::isnan(value) ? " " : heights[std::min<std::size_t>(7, static_cast<std::size_t>(height * 8))];
  }
  return out;
}

std::string padded(std::string_view text, std::size_t width, bool right_aligned) {
  const std::string blanks(width - std::min(width, text_width(text)), ' ');
  return right_aligned ? blanks + std::string(text) : std::string(text) + blanks;
}

/// Breaks a text into lines of at most `width` characters, each after `indent`.
std::string wrapped(std::string_view text, std::size_t width, std::string_view indent) {
  std::string out;
  std::size_t column = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" \n"), text.size());
    const std::string_view word = text.substr(0, end);
    const bool line_ends = end < text.size() && text[end] == '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!word.empty()) {
      const std::size_t needed = text_width(word) + (column ? 1 : 0);
      if (column && column + needed > width) {
        out += '\n';
        column = 0;
      }
      out += column ? " " : std::string(indent);
      out += word;
      column += text_width(word) + (column ? 1 : 0);
    }
    if (line_ends && !text.empty()) {
      out += '\n';
      column = 0;
    }
  }
  return out + '\n';
}

std::string indented(std::string_view text, std::string_view indent) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    out += std::string(end ? indent : "") + std::string(text.substr(0, end)) + '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string table_text(const Table& table) {
  const std::size_t columns = table.head.size();
  std::vector<std::size_t> widths(columns);
  std::vector<bool> numeric(columns);
  for (std::size_t c = 0; c < columns; ++c) {
    widths[c] = text_width(table.head[c]);
    numeric[c] = is_numeric_column(table, c);
    for (const auto& row : table.rows)
      if (c < row.size()) widths[c] = std::max(widths[c], text_width(row[c]));
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string out;
    for (std::size_t c = 0; c < columns; ++c)
      out += "  " + padded(c < cells.size() ? cells[c] : "", widths[c], numeric[c]);
    return out.substr(0, out.find_last_not_of(' ') + 1) + '\n';
  };
  std::string out = line(table.head);
  std::vector<std::string> rules;
  for (const std::size_t width : widths) {
    std::string rule;
    for (std::size_t i = 0; i < width; ++i) rule += "─";
    rules.push_back(rule);
  }
  out += line(rules);
  for (const auto& row : table.rows) out += line(row);
  return out;
}

/// Turns each item into lines without surrounding blank lines.
struct ItemText {
  int figures = 0, tables = 0;

  std::string operator()(const Paragraph& paragraph) { return wrapped(paragraph.text, page_width, ""); }

  std::string operator()(const KeyNumbers& key) {
    std::size_t label_width = 0, value_width = 0;
    for (const auto& number : key.numbers) {
      label_width = std::max(label_width, text_width(number.label));
      value_width = std::max(value_width, text_width(number.value));
    }
    std::string out;
    for (const auto& number : key.numbers) {
      out += fmt::format("  {}  {}", padded(number.label, label_width, false),
                         padded(number.value, value_width, true));
      if (const std::string unit = readable_unit(number.unit); !unit.empty()) out += ' ' + unit;
      if (!number.note.empty()) out += fmt::format("  ({})", number.note);
      out += '\n';
    }
    return out;
  }

  std::string operator()(const Plot& plot) {
    std::string out = wrapped(fmt::format("Figure {}. {}", ++figures, plot.title), page_width, "");
    out += fmt::format("  {} against {}\n", with_unit(plot.y.label, plot.y.unit),
                       with_unit(plot.x.label, plot.x.unit));
    Table table{{"Curve", "Samples", "Lowest", "Highest", "Mean", "RMS", "Outline"}, {}, ""};
    for (const Series& series : plot.series) {
      const Summary summary = summarize(series.y);
      const auto number = [&](double value) {
        return summary.samples ? fmt::format("{:.4g}", value) : std::string("–");
      };
      table.rows.push_back({series.name,
                            summary.gaps ? fmt::format("{} of {}", summary.samples, series.y.size())
                                         : std::to_string(summary.samples),
                            number(summary.low), number(summary.high), number(summary.mean),
                            number(summary.rms), summary.samples ? outline(plot, series) : ""});
    }
    out += table_text(table);
    if (!plot.caption.empty()) out += wrapped(plot.caption, page_width - 2, "  ");
    return out;
  }

  std::string operator()(const Table& table) {
    const std::string title = fmt::format("Table {}. {}", ++tables, table.caption);
    return wrapped(title, page_width, "") + table_text(table);
  }

  std::string operator()(const Picture& picture) {
    return wrapped(fmt::format("Figure {}. {}", ++figures, picture.caption), page_width, "") +
           indented(picture.text, "  ");
  }

  std::string operator()(const Graph& graph) {
    return wrapped(fmt::format("Figure {}. {}", ++figures, graph.caption), page_width, "") +
           indented(graph_text(graph), "  ");
  }

  std::string operator()(const Code& code) {
    return (code.caption.empty() ? "" : code.caption + ":\n") + indented(code.text, "    ");
  }

  std::string operator()(const Notice& notice) {
    static constexpr std::string_view words[] = {"Note", "Good", "Warning", "Error"};
    return wrapped(fmt::format("{}: {}", words[static_cast<std::size_t>(notice.severity)], notice.text),
                   page_width, "");
  }
};

std::string underlined(std::string_view title, std::string_view rule) {
  std::string out = std::string(title) + '\n';
  for (std::size_t i = 0; i < text_width(title); ++i) out += rule;
  return out + '\n';
}

}  // namespace

std::string to_text(const Page& page) {
  check(page);
  std::string out = underlined(page.title, "═");
  if (!page.subtitle.empty()) out += wrapped(page.subtitle, page_width, "");
  if (!page.facts.empty()) out += '\n';
  std::size_t name_width = 0;
  for (const auto& fact : page.facts) name_width = std::max(name_width, text_width(fact.first));
  for (const auto& [name, value] : page.facts)
    out += fmt::format("{}  {}\n", padded(name, name_width, false), value);
  ItemText item_text;
  for (const Section& section : page.sections) {
    out += "\n\n" + underlined(section.title, "─");
    for (const Item& item : section.items) out += "\n" + std::visit(item_text, item);
  }
  return out;
}

}  // namespace loopwright::report
