#include "tools/report/report.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include "tests/tools/report/sample_page.h"
#include "tests/tools/report/well_formed.h"
#include "tools/report/assets.h"
#include "where.h"

namespace loopwright::report::report_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

size_t count(const std::string& text, std::string_view part) {
  size_t found = 0;
  for (size_t at = 0; (at = text.find(part, at)) != text.npos; at += part.size()) ++found;
  return found;
}

Page page_of(std::vector<Item> items) { return {"Title", "", {}, {{"Section", std::move(items)}}}; }

/// The data of the first plot, as in the page.
std::string plot_data(const Page& page) {
  const std::string html = to_html(page), start = "<script type=\"application/json\">";
  const size_t begin = html.find(start) + start.size();
  return html.substr(begin, html.find("</script>", begin) - begin);
}

TEST(ReportHtml, HasOneScopeAFigureAndOneSetOfDataForEachPlot) {
  const std::string html = to_html(sample_page());
  EXPECT_EQ(count(html, "<div class=\"scope\">"), 5u);
  EXPECT_EQ(count(html, "<script type=\"application/json\">"), 6u) << "five plots and a diagram";
  EXPECT_EQ(count(html, "<figure class=\"block-diagram\">"), 1u);
  EXPECT_EQ(count(html, "id=\"elk\""), 1u);
  EXPECT_THAT(html, HasSubstr("Eclipse Public License 2.0")) << "required by the license of elkjs";
  EXPECT_THAT(html, HasSubstr("<b>Figure 6.</b> Open loop, magnitude."));
  EXPECT_THAT(html, HasSubstr("<b>Table 1.</b> Effects that were tried."));
}

TEST(ReportHtml, EveryTagIsClosedInOrder) { EXPECT_EQ(fault_in_html(to_html(sample_page())), ""); }

TEST(ReportHtml, TheCheckOfTagsFindsATagThatIsNotClosed) {
  EXPECT_EQ(fault_in_html("<!DOCTYPE html>\n<p><b>text</b></p>"), "");
  EXPECT_NE(fault_in_html("<p><b>text</p>"), "");
  EXPECT_NE(fault_in_html("<p>text"), "");
  EXPECT_NE(fault_in_html("<p>a < b</p>"), "");
}

TEST(ReportHtml, CarriesItsScriptsAndStylesAndLoadsNothing) {
  const std::string html = to_html(sample_page());
  EXPECT_GT(assets::uplot_js.size(), 40'000u);
  EXPECT_THAT(html, HasSubstr(std::string(assets::uplot_js)));
  EXPECT_THAT(html, HasSubstr(std::string(assets::uplot_css)));
  EXPECT_THAT(html, HasSubstr(std::string(assets::page_js)));
  EXPECT_THAT(html, HasSubstr(std::string(assets::page_css)));
  EXPECT_THAT(html, HasSubstr("Leon Sorokin"));  // required by the license of uPlot
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  for (const std::string_view loading : {"<link", " src=", "@import", "url(", "fetch(", "XMLHttpRequest"})
    EXPECT_EQ(count(html, loading), 0u) << loading;
}

TEST(ReportHtml, EmbeddedFilesAreTheFilesByteForByte) {
  std::ifstream file(LOOPWRIGHT_SOURCE "/tools/report/page/page.css", std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  EXPECT_TRUE(assets::page_css == bytes.str());
}

TEST(ReportHtml, ModulesAreJoinedWithoutImportsAndExports) {
  EXPECT_THAT(std::string(assets::page_js), Not(HasSubstr("\nimport ")));
  EXPECT_THAT(std::string(assets::page_js), Not(HasSubstr("\nexport ")));
  for (const char* part : {"function buildLegend", "class DiagramView", "function readingOrder"})
    EXPECT_THAT(std::string(assets::page_js), HasSubstr(part));
}

TEST(ReportHtml, APageWithoutADiagramCarriesNoLayoutLibrary) {
  const std::string html = to_html(Page{"Plain", "", {}, {}});
  EXPECT_EQ(count(html, "id=\"elk\""), 0u);
  EXPECT_LT(html.size(), 150'000u);
}

TEST(ReportHtml, TextOfAnyKindStaysText) {
  const std::string evil = "</script></title><script>alert(1)</script><!--\"'&\\";
  Page page{evil, evil, {{evil, evil}}, {}};
  const Series series{evil, {0, 1}, {0, 1}};
  page.sections.push_back(
      {evil,
       {Paragraph{evil}, KeyNumbers{{{evil, evil, evil, evil}}},
        Plot{evil, {evil, evil}, {evil, evil}, {series}, evil, evil}, Table{{evil}, {{evil}}, evil},
        Picture{"<svg></svg>", evil, evil}, Code{evil, evil}, Notice{Notice::Severity::error, evil}}});
  const std::string html = to_html(page), calm = to_html(page_of({Plot{"", {}, {}, {series}, "", ""}}));
  EXPECT_EQ(count(html, "<script>alert"), 0u);
  EXPECT_EQ(count(html, "</script"), 2u);
  EXPECT_EQ(count(html, "<!--"), count(calm, "<!--"));
  EXPECT_EQ(fault_in_html(html), "");
}

TEST(ReportHtml, PlotDataKeepSevenDigitsAndGaps) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const std::string data =
      plot_data(page_of({Plot{"Plot",
                              {"Time", "s"},
                              {"Force", "N"},
                              {{"force", {0.1, 0.25, 3, 4}, {1.23456789, nan, -infinity, -2e-9}}},
                              "",
                              ""}}));
  EXPECT_THAT(data, HasSubstr(R"("x":[0.1,0.25,3,4],"y":[1.234568,null,null,-2e-09])"));
}

TEST(ReportHtml, SmallChangesOnALargeOffsetKeepTheirDigits) {
  const std::string data = plot_data(page_of(
      {Plot{"Plot", {}, {}, {{"count", {0, 1, 3}, {123456789.01, 123456789.02, 123456789.04}}}, "", ""}}));
  EXPECT_THAT(data, HasSubstr("[123456789.01,123456789.02,123456789.04]"));
}

TEST(ReportHtml, EvenTimeIsWrittenAsStartStepAndCount) {
  const std::string data = plot_data(page_of({servo_plots(servo_run())[1]}));
  EXPECT_THAT(data, HasSubstr(R"("x":{"from":0,"step":0.001,"count":2601})"));
}

TEST(ReportHtml, ValuesThatALogarithmicAxisCannotShowAreGaps) {
  const std::string data = plot_data(page_of(
      {Plot{"Plot", {"f", "Hz", true}, {"gain", "", true}, {{"g", {0, 1, 10}, {1, -1, 0.5}}}, "", ""}}));
  EXPECT_THAT(data, HasSubstr(R"("x":[null,1,10],"y":[1,null,0.5])"));
}

TEST(ReportHtml, TenMinutesAtOneKilohertzStayBelowFiveMegabytes) {
  ServoRun run = servo_run(600);
  run.error[123'456] = 1.25e-3;  // one sample long
  const std::string html = to_html(page_of(servo_plots(run)));
  EXPECT_LT(html.size(), 5'000'000u);
  EXPECT_THAT(html, HasSubstr(",0.00125,"));
  EXPECT_THAT(html,
              HasSubstr("Drawn from up to 600\u202F001 samples a curve, thinned so that extremes stay."));
}

TEST(ReportHtml, AlignsColumnsOfNumbersToTheRight) {
  const std::string html =
      to_html(page_of({Table{{"Name", "Value"}, {{"mass", "0.26 kg"}, {"none", "–"}, {"short"}}, ""}}));
  EXPECT_THAT(html, HasSubstr("<th>Name</th><th class=\"number\">Value</th>"));
  EXPECT_THAT(html, HasSubstr("<td>mass</td><td class=\"number\">0.26 kg</td>"));
  EXPECT_THAT(html, HasSubstr("<td>short</td><td class=\"number\"></td>"));
}

TEST(ReportHtml, BlankLinesMakeParagraphs) {
  EXPECT_THAT(to_html(page_of({Paragraph{"one\ntwo\n\nthree"}})), HasSubstr("<p>one\ntwo</p>\n<p>three</p>"));
}

TEST(ReportHtml, EmptyPagesAndPlotsAreFine) {
  EXPECT_EQ(fault_in_html(to_html(Page{})), "");
  EXPECT_EQ(fault_in_html(
                to_html(page_of({Plot{}, Table{}, Paragraph{}, KeyNumbers{}, Picture{}, Code{}, Notice{}}))),
            "");
}

TEST(Report, NamesEveryPlotAndTableWhoseListsDoNotFit) {
  const Page page = page_of(
      {Plot{"Speed", {}, {}, {{"a", {1, 2}, {1}}}, "", ""}, Table{{"x"}, {{"1"}, {"1", "2"}}, "Poles"}});
  for (const auto& write : {to_html, to_text}) {
    try {
      write(page);
      FAIL() << "no exception";
    } catch (const std::invalid_argument& error) {
      EXPECT_STREQ(error.what(),
                   "report page 'Title' cannot be written:\n"
                   "plot 'Speed', series 'a': x has 2 values, y has 1\n"
                   "table 'Poles', row 2: 2 cells, but the head has 1");
    }
  }
}

TEST(Report, IsWrittenWholeOrNotAtAll) {
  const std::filesystem::path folder = std::filesystem::path(LOOPWRIGHT_BINARY) / "report_write_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const Page wrong = page_of({Plot{"Speed", {}, {}, {{"a", {1, 2}, {1}}}, "", ""}});
  EXPECT_THROW(write_html(folder / "page.html", wrong), std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  write_html(folder / "page.html", sample_page());
  EXPECT_EQ(std::filesystem::file_size(folder / "page.html"), to_html(sample_page()).size());
  EXPECT_THROW(write_html(folder / "missing" / "page.html", sample_page()), std::runtime_error);
  std::filesystem::remove_all(folder);
}

TEST(ReportText, TellsTheSameStory) {
  const std::string text = to_text(sample_page());
  EXPECT_THAT(text, HasSubstr("Linear motor stage: model against measurement\n═════"));
  EXPECT_THAT(text, HasSubstr("\nSolver      rk4, step 0.1 ms\n"));
  EXPECT_THAT(text, HasSubstr("  Tracking error, RMS  4.31 µm  (was 14.2 µm)\n"));
  EXPECT_THAT(text, HasSubstr("Warning: The experiment never moves faster"));
  EXPECT_THAT(text, HasSubstr("feedback.command → command.terms[0]  V\n"));
  EXPECT_THAT(text, HasSubstr("  Coulomb friction  level        0.612  N  "));
  EXPECT_THAT(text, HasSubstr("    \"friction\": {"));
  EXPECT_THAT(text, Not(HasSubstr("<")));
}

TEST(ReportText, SumsUpACurve) {
  const Series ramp{"ramp", {0, 1, 2, 3}, {-1, std::nan(""), 1, 3}};
  const std::string text =
      to_text(page_of({Plot{"Plot", {"Time", "s"}, {"Speed", "m/s^2"}, {ramp}, "", ""}}));
  EXPECT_THAT(text, HasSubstr("Figure 1. Plot\n  Speed (m/s²) against Time (s)\n"));
  EXPECT_THAT(
      text,
      HasSubstr("ramp   3 of 4       -1        3     1  1.915  ▁                         ▅            █\n"));
}

TEST(ReportText, BreaksLongLinesBetweenWords) {
  std::string words;
  for (int i = 0; i < 60; ++i) words += "motion ";
  std::istringstream text(to_text(page_of({Paragraph{words}})));
  size_t longest = 0, found = 0;
  for (std::string line; std::getline(text, line);) {
    if (line.find("motion") == line.npos) continue;
    longest = std::max(longest, line.size());
    found += count(line, "motion");
  }
  EXPECT_LE(longest, 100u);
  EXPECT_GT(longest, 90u);
  EXPECT_EQ(found, 60u);
}

}  // namespace
}  // namespace loopwright::report::report_test
