/// The files included in every page; embed.cmake compiles them in.
#pragma once
#include <string_view>

namespace loopwright::report::assets {

extern const std::string_view page_css;       ///< page.css, the style
extern const std::string_view page_js;        ///< page.js, which turns plot data into scopes
extern const std::string_view uplot_css;      ///< style of uPlot
extern const std::string_view uplot_js;       ///< uPlot, the plotting library
extern const std::string_view uplot_license;  ///< MIT license of uPlot; it must accompany every copy

}  // namespace loopwright::report::assets
