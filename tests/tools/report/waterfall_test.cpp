#include "tools/report/waterfall.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <regex>
#include "tests/tools/report/well_formed.h"
#include "where.h"

namespace loopwright::report::waterfall_test {
namespace {

Waterfall ripple() {
  Waterfall w;
  w.title = "Force over position and velocity";
  w.x = {"Position", "m"}, w.y = {"Velocity", "m/s"}, w.z = {"Force", "N"};
  for (int i = 0; i < 200; ++i) w.x_values.push_back(0.003 * i);
  for (int j = 0; j <= 10; ++j) w.y_values.push_back(0.05 * j);
  for (const double v : w.y_values) {
    auto& curve = w.z_values.emplace_back();
    for (const double x : w.x_values) curve.push_back((1 - v) * std::sin(60 * x));
  }
  w.clouds = {{"samples", {0.1, 0.2, 0.3}, {0.05, 0.07, 0.5}, {0.2, -0.4, 0.9}, false},
              {"motion", {0.0, 0.3, 0.59}, {0.0, 0.4, 0.0}, {0.0, 0.5, 0.0}, true}};
  return w;
}

size_t count(const std::string& text, const std::string& what) {
  size_t n = 0;
  for (size_t at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(Waterfall, DrawsACurveForEveryRowAndEveryPointOnce) {
  const Picture picture = waterfall_picture(ripple());
  EXPECT_EQ(count(picture.svg, "stroke-width:1.1"), 11u) << "curves";
  EXPECT_EQ(count(picture.svg, "h0"), 3u) << "points";
  EXPECT_EQ(count(picture.svg, "stroke-width:1.6"), 1u) << "lines";
  EXPECT_THAT(picture.svg, testing::HasSubstr("Velocity (m/s)"));
  EXPECT_THAT(picture.caption, testing::HasSubstr("Force over position"));
  EXPECT_THAT(picture.text, testing::HasSubstr("-1 … 0.9989 N"));
}

TEST(Waterfall, NearCurvesHideThoseBehind) {
  const std::string svg = waterfall_picture(ripple()).svg;
  // The first curve in the file is the farthest: higher up, that is, with the smaller y.
  const std::regex path(
      "<path d=\"M([0-9.]+) ([0-9.]+)L[^\"]*\" style=\"fill:none;stroke:var\\(--series-7\\)");
  std::vector<double> heights;
  for (std::sregex_iterator match(svg.begin(), svg.end(), path), end; match != end; ++match)
    heights.push_back(std::stod((*match)[2]));
  ASSERT_EQ(heights.size(), 11u);
  EXPECT_LT(heights.front(), heights.back());
}

TEST(Waterfall, StandsInAPage) {
  Page page{"Surfaces", "", {}, {{"One", {waterfall_picture(ripple())}}}};
  const std::string html = to_html(page);
  EXPECT_EQ(fault_in_html(html), "");
  write_html(std::string(LOOPWRIGHT_BINARY) + "/waterfall.html", page);
}

TEST(Waterfall, RefusesListsThatDoNotFit) {
  Waterfall w = ripple();
  w.z_values[3].pop_back();
  EXPECT_THROW(waterfall_picture(w), std::invalid_argument);
  w = ripple();
  w.clouds[0].z.pop_back();
  EXPECT_THROW(waterfall_picture(w), std::invalid_argument);
}

TEST(Waterfall, FlatFunctionsHaveAnAxisToo) {
  Waterfall w = ripple();
  for (auto& curve : w.z_values) std::ranges::fill(curve, 2.0);
  w.clouds.clear();
  EXPECT_EQ(waterfall_picture(w).svg.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace loopwright::report::waterfall_test
