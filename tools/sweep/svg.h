/// The SVG elements used in the pictures of a sweep.
#pragma once
#include <fmt/format.h>
#include <string>
#include <string_view>
#include "tools/report/typography.h"

namespace loopwright::svg {

/// Text at (x, y); anchor: start, middle, end.
inline std::string words(double x, double y, std::string_view anchor, std::string_view text,
                         std::string_view more = "") {
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" {}>{}</text>)", x, y, anchor, more,
                     text);
}

inline std::string line(double x1, double y1, double x2, double y2, std::string_view more) {
  return fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" {}/>)", x1, y1, x2, y2, more);
}

/// The whole picture; it scales down with the page.
inline std::string picture(double width, double height, const std::string& inside) {
  return fmt::format(
      R"(<svg viewBox="0 0 {0:.0f} {1:.0f}" width="{0:.0f}" style="max-width:100%;min-width:{2:.0f}px" font-size="12" fill="currentColor" role="img">{3}</svg>)",
      width, height, width * report::least_scale, inside);
}

}  // namespace loopwright::svg
