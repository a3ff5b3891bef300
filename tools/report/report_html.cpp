#include "tools/report/report.h"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <iterator>
#include <stdexcept>
#include "tools/report/assets.h"
#include "tools/report/layout.h"
#include "tools/report/thin.h"
#include "tools/report/typography.h"

namespace loopwright::report {
namespace {

/// At about 20 bytes per point, a page stays below 5 MB.
constexpr std::size_t points_per_page = 200'000;

/// Writes one page from top to bottom; figures and tables are numbered consecutively.
class HtmlWriter {
 public:
  explicit HtmlWriter(const Page& page) : page_(page), point_limit_(point_limit(page)) {}
  std::string write();

 private:
  template <class... Arguments> void put(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Arguments>(arguments)...);
  }
  void put_head();
  void put_title();
  void put_contents();
  void put_caption(std::string_view kind, int& count, std::string_view title, std::string_view caption,
                   std::string_view remark = {});
  void put_series(const Plot& plot, const Series& series);

  void put_item(const Paragraph& paragraph);
  void put_item(const KeyNumbers& key);
  void put_item(const Plot& plot);
  void put_item(const Table& table);
  void put_item(const Picture& picture);
  void put_item(const Graph& graph);
  void put_item(const Code& code);
  void put_item(const Notice& notice);

  static std::size_t point_limit(const Page& page);

  const Page& page_;
  std::size_t point_limit_;  ///< of one series
  int figures_ = 0, tables_ = 0;
  bool has_diagram_ = false;
  std::string out_;
};

std::size_t HtmlWriter::point_limit(const Page& page) {
  std::vector<std::size_t> lengths;
  for (const Section& section : page.sections)
    for (const Item& item : section.items)
      if (const Plot* plot = std::get_if<Plot>(&item))
        for (const Series& series : plot->series) lengths.push_back(series.x.size());
  return fair_limit(std::move(lengths), points_per_page);
}

std::string axis_json(const Axis& axis) {
  return fmt::format(R"({{"label":{},"unit":{},"logarithmic":{},"counts":{}}})", json_string(axis.label),
                     json_string(readable_unit(axis.unit)), axis.logarithmic, axis.counts);
}

/// The step of x if it increases uniformly, as sampled time does; 0 otherwise. Tolerates the rounding of x
/// itself.
double even_step(std::span<const double> x) {
  if (x.size() < 3 || !std::isfinite(x.front()) || !std::isfinite(x.back())) return 0;
  const double step = (x.back() - x.front()) / static_cast<double>(x.size() - 1);
  if (!(step > 0)) return 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!(std::abs(x[i] - (x.front() + step * static_cast<double>(i))) <= 1e-6 * step)) return 0;
  return step;
}

std::vector<double> selected(std::span<const double> values, std::span<const std::size_t> indices) {
  std::vector<double> out;
  out.reserve(indices.size());
  for (const std::size_t i : indices) out.push_back(values[i]);
  return out;
}

/// JSON array with gaps as null.
std::string numbers_json(std::span<const double> values, bool logarithmic) {
  const int digits = significant_digits(values);
  std::string out = "[";
  for (const double value : values) {
    if (out.size() > 1) out += ',';
    if (!std::isfinite(value) || (logarithmic && value <= 0))
      out += "null";
    else if (digits > 15)
      fmt::format_to(std::back_inserter(out), "{}", value);  // the shortest form that reads back the same
    else
      fmt::format_to(std::back_inserter(out), "{:.{}g}", value, digits);
  }
  return out + ']';
}

std::string marks_json(const std::vector<Mark>& marks) {
  std::string out = "[";
  for (const Mark& mark : marks)
    if (std::isfinite(mark.value))
      fmt::format_to(std::back_inserter(out), R"({}{{"axis":"{}","value":{},"label":{}}})",
                     out.size() > 1 ? "," : "", mark.axis == Mark::Along::x ? "x" : "y", mark.value,
                     json_string(mark.label));
  return out + ']';
}

std::string_view to_string(Series::Shape shape) {
  switch (shape) {
    case Series::Shape::line:
      return "line";
    case Series::Shape::points:
      return "points";
    case Series::Shape::steps:
      return "steps";
  }
  return "";
}

void HtmlWriter::put_series(const Plot& plot, const Series& series) {
  const std::vector<std::size_t> kept = thin(series.y, point_limit_);
  const std::vector<double> x = selected(series.x, kept), y = selected(series.y, kept);
  put(R"({{"name":{},"shape":"{}","x":)", json_string(series.name), to_string(series.shape));
  if (const double step = plot.x.logarithmic ? 0 : even_step(x); step > 0)
    put(R"({{"from":{:.12g},"step":{:.12g},"count":{}}})", x.front(), step, x.size());
  else
    out_ += numbers_json(x, plot.x.logarithmic);
  put(R"(,"y":{}}})", numbers_json(y, plot.y.logarithmic));
}

void HtmlWriter::put_caption(std::string_view kind, int& count, std::string_view title,
                             std::string_view caption, std::string_view remark) {
  put("<figcaption><b>{} {}.</b>", kind, ++count);
  for (const std::string_view text : {title, caption, remark})
    if (!text.empty())
      put(" {}{}", escape_html(text), text.find_last_of(".!?:") == text.size() - 1 ? "" : ".");
  out_ += "</figcaption>\n";
}

void HtmlWriter::put_item(const Paragraph& paragraph) {
  std::string_view rest = paragraph.text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find("\n\n"), rest.size());
    if (end > 0) put("<p>{}</p>\n", escape_html(rest.substr(0, end)));
    rest.remove_prefix(std::min(end + 2, rest.size()));
  }
}

void HtmlWriter::put_item(const KeyNumbers& key) {
  out_ += "<dl class=\"key-numbers\">\n";
  for (const KeyNumbers::Number& number : key.numbers) {
    put("<div><dt>{}</dt><dd><b>{}</b>", escape_html(number.label), escape_html(number.value));
    if (const std::string unit = readable_unit(number.unit); !unit.empty())
      put(" <span>{}</span>", escape_html(unit));
    if (!number.note.empty()) put("<small>{}</small>", escape_html(number.note));
    out_ += "</dd></div>\n";
  }
  out_ += "</dl>\n";
}

void HtmlWriter::put_item(const Plot& plot) {
  std::size_t thinned = 0;
  for (const Series& series : plot.series)
    if (series.x.size() > point_limit_) thinned = std::max(thinned, series.x.size());
  put("<figure class=\"plot\" data-group=\"{}\">\n<div class=\"scope\"></div>\n", escape_html(plot.group));
  put(R"(<script type="application/json">{{"title":{},"x":{},"y":{},"equal":{},"marks":{},"series":[)",
      json_string(plot.title), axis_json(plot.x), axis_json(plot.y), plot.equal_axes, marks_json(plot.marks));
  for (const Series& series : plot.series) {
    if (&series != &plot.series.front()) out_ += ",\n";
    put_series(plot, series);
  }
  out_ += "]}</script>\n";
  put_caption("Figure", figures_, plot.title, plot.caption,
              thinned ? fmt::format("Drawn from up to {} samples a curve, thinned so that extremes stay",
                                    grouped(thinned))
                      : std::string());
  out_ += "</figure>\n";
}

void HtmlWriter::put_item(const Table& table) {
  std::vector<std::string_view> attribute;
  for (std::size_t column = 0; column < table.head.size(); ++column)
    attribute.push_back(is_numeric_column(table, column) ? " class=\"number\"" : "");
  out_ += "<figure class=\"table\">\n";
  put_caption("Table", tables_, table.caption, {});
  out_ += "<div class=\"wide\"><table>\n<thead><tr>";
  for (std::size_t column = 0; column < table.head.size(); ++column)
    put("<th{}>{}</th>", attribute[column], escape_html(table.head[column]));
  out_ += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) {
    out_ += "<tr>";
    for (std::size_t column = 0; column < table.head.size(); ++column)
      put("<td{}>{}</td>", attribute[column], column < row.size() ? escape_html(row[column]) : "");
    out_ += "</tr>\n";
  }
  out_ += "</tbody></table></div>\n</figure>\n";
}

void HtmlWriter::put_item(const Picture& picture) {
  put("<figure class=\"picture\">\n<div class=\"wide\">{}</div>\n", picture.svg);
  put_caption("Figure", figures_, picture.caption, {});
  out_ += "</figure>\n";
}

void HtmlWriter::put_item(const Graph& graph) {
  has_diagram_ = true;
  put("<figure class=\"block-diagram\">\n<div class=\"canvas\" tabindex=\"0\"></div>\n"
      "<script type=\"application/json\">{}</script>\n",
      graph_json(graph));
  const bool has_subdiagrams = std::any_of(graph.nodes.begin(), graph.nodes.end(),
                                           [](const GraphNode& n) { return n.room == "subdiagram"; });
  put_caption("Figure", figures_, graph.caption, {},
              has_subdiagrams ? "Click on a subdiagram to open or close it" : "");
  out_ += "</figure>\n";
}

void HtmlWriter::put_item(const Code& code) {
  out_ += "<figure class=\"code\">\n";
  if (!code.caption.empty()) put("<figcaption>{}</figcaption>\n", escape_html(code.caption));
  put("<pre><code>{}</code></pre>\n</figure>\n", escape_html(code.text));
}

void HtmlWriter::put_item(const Notice& notice) {
  static constexpr std::string_view names[] = {"note", "good", "warning", "error"};
  static constexpr std::string_view words[] = {"Note", "Good", "Warning", "Error"};
  const auto severity = static_cast<std::size_t>(notice.severity);
  put("<p class=\"notice {}\"><b>{}.</b> {}</p>\n", names[severity], words[severity],
      escape_html(notice.text));
}

void HtmlWriter::put_head() {
  // The policy enforces that the page loads nothing, whatever a picture contains.
  put(R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta name="generator" content="Loopwright">
{}<title>{}</title>
<style>
{}
{}</style>
<style id="diagram-style">
{}</style>
</head>
<body>
)",
      page_.reload_s > 0 ? fmt::format("<meta http-equiv=\"refresh\" content=\"{}\">\n", page_.reload_s) : "",
      escape_html(page_.title), assets::uplot_css, assets::page_css, assets::diagram_css);
}

void HtmlWriter::put_title() {
  put("<header>\n<h1>{}</h1>\n", escape_html(page_.title));
  if (!page_.subtitle.empty()) put("<p class=\"subtitle\">{}</p>\n", escape_html(page_.subtitle));
  if (!page_.facts.empty()) {
    out_ += "<dl class=\"facts\">\n";
    for (const auto& [name, value] : page_.facts)
      put("<div><dt>{}</dt><dd>{}</dd></div>\n", escape_html(name), escape_html(value));
    out_ += "</dl>\n";
  }
  out_ += "</header>\n";
}

void HtmlWriter::put_contents() {
  if (page_.sections.size() < 3) return;
  out_ += "<nav aria-label=\"Contents\"><ol>\n";
  for (std::size_t i = 0; i < page_.sections.size(); ++i)
    put("<li><a href=\"#section-{}\">{}</a></li>\n", i + 1, escape_html(page_.sections[i].title));
  out_ += "</ol></nav>\n";
}

std::string HtmlWriter::write() {
  put_head();
  put_title();
  put_contents();
  out_ +=
      "<main>\n<noscript><p class=\"notice warning\"><b>Warning.</b> The plots need "
      "JavaScript.</p></noscript>\n";
  for (std::size_t i = 0; i < page_.sections.size(); ++i) {
    put("<section id=\"section-{}\">\n<h2>{}</h2>\n", i + 1, escape_html(page_.sections[i].title));
    for (const Item& item : page_.sections[i].items)
      std::visit([this](const auto& value) { put_item(value); }, item);
    out_ += "</section>\n";
  }
  out_ += "</main>\n";
  if (has_diagram_) put("<script type=\"text/plain\" id=\"elk\">{}</script>\n", assets::elk_packed);
  put("<script>\n/*\nuPlot: {}\n{}\n*/\n{}\n(() => {{\n\"use "
      "strict\";\n{}}})();\n</script>\n</body>\n</html>\n",
      assets::uplot_license, has_diagram_ ? assets::elk_notice : std::string_view(), assets::uplot_js,
      assets::page_js);
  return std::move(out_);
}

}  // namespace

std::string to_html(const Page& page) {
  check(page);
  return HtmlWriter(page).write();
}

}  // namespace loopwright::report
