#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>
#include <sstream>
#include "tests/tools/report/sample_page.h"
#include "tools/report/child_process.h"
#include "where.h"

namespace loopwright::report::browser_test {
namespace {

using namespace std::chrono_literals;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

TEST(ReportPage, ScopesZoomReadOutAndFollowEachOtherInABrowser) {
  if (!run_program({"sh", "-c", "command -v chromium"}, "", 20s).succeeded)
    GTEST_SKIP() << "chromium is not installed";
  const std::filesystem::path folder = std::filesystem::path(LOOPWRIGHT_BINARY) / "report_browser_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  std::string html = to_html(sample_page());
  html.insert(html.find("<style>"),
              "<script>const errors = []; onerror = (text) => errors.push(text);</script>");
  html.insert(html.rfind("</body>"),
              "<script>" + content(LOOPWRIGHT_SOURCE "/tests/tools/report/probe.js") + "</script>");
  std::ofstream(folder / "page.html") << html;

  const ChildResult result = run_program(
      {"node", LOOPWRIGHT_SOURCE "/tests/tools/report/browse.mjs", (folder / "page.html").string()}, "",
      120s);
  ASSERT_TRUE(result.succeeded) << result.failure;
  const std::string& seen = result.output;
  EXPECT_THAT(seen, HasSubstr(R"("errors":[])"));
  EXPECT_THAT(seen, HasSubstr(R"("canvases":5,"drawn":5)"));
  EXPECT_THAT(seen,
              ContainsRegex("\\|100\u202Fmm\\|99.997\u202Fmm\",\"Time 1\\.(29|3)"));  // half way, at rest
  EXPECT_THAT(seen, HasSubstr(R"("zoomed":"11100")"));                                // the group of three
  EXPECT_THAT(seen, ContainsRegex("\"left\":\"Time 6(49|5[0-9])"));  // a quarter of 2.6 s, shown in ms
  EXPECT_THAT(seen, HasSubstr(R"("whole":"00000")"));
  EXPECT_THAT(seen, HasSubstr(R"("pressed":"false")"));
  if (!HasFailure()) std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace loopwright::report::browser_test
