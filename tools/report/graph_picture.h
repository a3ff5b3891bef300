/// Pictures of block diagrams as files: drawn by the scripts of pages, which Node.js or Chromium runs.
#pragma once
#include <chrono>
#include <optional>
#include <string>
#include "tools/report/graph.h"

namespace loopwright::report {

struct GraphOptions {
  std::size_t depth = 32;  ///< subdiagrams are open down to this depth; 0: all are closed
  std::vector<std::string> interpreters{"node", "chromium"};  ///< those tried, in this order
  std::string rasterizer = "chromium";                        ///< makes a PNG of an SVG
  std::chrono::milliseconds time_limit{60'000};
};

/// A picture, or why there is none.
struct GraphPicture {
  std::string bytes;    ///< the file; empty: there is none
  std::string failure;  ///< in one or more lines, with what to install
};

/// An SVG file that stands alone, with its colors written out.
GraphPicture draw_svg(const Graph& graph, const GraphOptions& options = {});

/// The same as PNG, two pixels for each unit of the SVG.
GraphPicture draw_png(const Graph& graph, const GraphOptions& options = {});

}  // namespace loopwright::report
