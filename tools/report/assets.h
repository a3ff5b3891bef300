/// The files included in pages; embed.cmake compiles them in.
#pragma once
#include <string_view>

namespace loopwright::report::assets {

extern const std::string_view page_css;         ///< page/page.css, the style; its first rule has the colors
extern const std::string_view diagram_css;      ///< page/diagram.css, the style of block diagrams
extern const std::string_view page_js;          ///< page/*.js, which draw plots and diagrams on pages
extern const std::string_view diagram_file_js;  ///< page/diagram_*.js, which draw a diagram without a page
extern const std::string_view elk_packed;       ///< elkjs, the layout library: gzip, base64
extern const std::string_view uplot_css;        ///< style of uPlot
extern const std::string_view uplot_js;         ///< uPlot, the plotting library
extern const std::string_view uplot_license;    ///< MIT license of uPlot; it must accompany every copy

/// elkjs may be distributed in this form with a note where its source is.
inline constexpr std::string_view elk_notice =
    "elkjs 0.12.0, Copyright (c) 2022 Kiel University and others, is made available under the terms of the "
    "Eclipse Public License 2.0 (EPL-2.0). Its source code is at github.com/kieler/elkjs.";

}  // namespace loopwright::report::assets
