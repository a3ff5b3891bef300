/// The files of the studio's page as the browser gets them, compressed with gzip.
#pragma once
#include <string_view>

namespace loopwright::studio::page {

extern const std::string_view index_html, studio_js, studio_css, layout_worker_js, licenses_txt;

}  // namespace loopwright::studio::page
