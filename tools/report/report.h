/// Results as one page: data structures for its contents, and functions that write them as HTML or as plain
/// text.
///
/// An HTML page is self-contained. It loads nothing from a network or from another file, suits light and dark
/// screens and paper, and lets a reader zoom, pan and read values off every plot.
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>
#include "tools/report/graph.h"

namespace loopwright::report {

/// One curve: points (x[i], y[i]) in the units of the plot's axes. x and y have the same length.
/// A value that is not finite is a gap, as is one ≤ 0 on a logarithmic axis.
struct Series {
  enum class Shape {
    line,    ///< connected in the given order; x may decrease (hysteresis, Nyquist)
    points,  ///< a cloud: error against position or velocity
    steps    ///< held until the next point: the output of a sampled controller
  };
  std::string name;
  std::vector<double> x, y;
  Shape shape = Shape::line;
};

struct Axis {
  std::string label;  ///< "Tracking error"
  std::string unit;   ///< "m", "N*s/m"; empty or "1": none. The page chooses mm, µm … by the visible range
  bool logarithmic = false;  ///< base 10
  bool counts = false;       ///< whole numbers only: no ticks between them
};

/// A line across a plot at a value of one axis: a crossover, a margin, a limit.
struct Mark {
  enum class Along { x, y };
  Along axis = Along::x;
  double value = 0;
  std::string label;  ///< short: "62.1° at 45 Hz"
};

/// A scope. Plots of one page with the same `group` share their x axis: zoom, pan and cursor are linked, and
/// adjacent plots are stacked closely.
struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
  std::string group;    ///< empty: independent
  std::string caption;  ///< sentences below the plot
  std::vector<Mark> marks;
  bool equal_axes = false;  ///< a unit has the same length on both axes: circles are round
};

/// Columns whose cells are numbers are right-aligned. Rows may be shorter than the head, never longer.
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
  std::string caption;
};

struct Paragraph {
  std::string text;  ///< a blank line starts a new paragraph
};

/// The most important numbers of a page.
struct KeyNumbers {
  struct Number {
    std::string label;  ///< "Tracking error, RMS"
    std::string value;  ///< "1.84", as displayed
    std::string unit;   ///< "um"; empty or "1": none
    std::string note;   ///< "was 14.2 µm"
  };
  std::vector<Number> numbers;
};

/// A vector picture. The SVG is inserted unchanged, so it must come from a trusted source.
struct Picture {
  std::string svg;
  std::string caption;
  std::string text;  ///< description of the picture, for readers of plain text
};

struct Code {
  std::string text;
  std::string caption;  ///< file name or language
};

struct Notice {
  enum class Severity { note, good, warning, error };
  Severity severity = Severity::note;
  std::string text;
};

using Item = std::variant<Paragraph, KeyNumbers, Plot, Table, Picture, Graph, Code, Notice>;

struct Section {
  std::string title;
  std::vector<Item> items;
};

struct Page {
  std::string title, subtitle;
  std::vector<std::pair<std::string, std::string>>
      facts;  ///< origin of the results: ("Diagram", "stage.json")
  std::vector<Section> sections;
  int reload_s = 0;  ///< the page loads itself again after so many seconds; 0: never
};

/// The page as HTML. Long series are thinned so that the whole page has at most 200 000 points; extreme
/// values are kept. Throws std::invalid_argument, naming the plot or table, when x and y differ in length or
/// a row is too long.
std::string to_html(const Page& page);

/// Writes to_html(page) to `path`, completely or not at all. Throws as to_html, and when the file cannot be
/// written.
void write_html(const std::filesystem::path& path, const Page& page);

/// The same content for a terminal: plots become the range, mean and outline of each series. Throws as
/// to_html.
std::string to_text(const Page& page);

}  // namespace loopwright::report
