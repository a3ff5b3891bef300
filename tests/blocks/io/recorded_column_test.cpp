#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include "tests/blocks/block_under_test.h"

namespace loopwright::recorded_column_test {

namespace {

/// A block on a file with this text, in a temporary folder.
class Recorded {
 public:
  Recorded(const std::string& csv, const std::string& settings)
      : folder_(std::filesystem::temp_directory_path() / ("recorded_column_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "data.csv") << csv;
    block = std::make_unique<BlockUnderTest>(
        "RecordedColumn", R"({"file": ")" + (folder_ / "data.csv").string() + "\", " + settings + "}");
  }
  ~Recorded() { std::filesystem::remove_all(folder_); }
  double at(double time) const {
    block->evaluate(time);
    return block->output("value");
  }
  std::unique_ptr<BlockUnderTest> block;

 private:
  std::filesystem::path folder_;
};

const char* const ramp = "time,x [mm],y\n0,0,5\n0.1,10,6\n0.2,30,7\n0.4,20,8\n";

}  // namespace

TEST(RecordedColumn, HoldsASampleUntilTheNext) {
  Recorded column(ramp, R"("column": "y")");
  const double time[] = {0, 0.05, 0.1, 0.19, 0.2, 0.39, 0.4, 9}, expected[] = {5, 5, 6, 6, 7, 7, 8, 8};
  for (int i = 0; i < 8; ++i) EXPECT_EQ(column.at(time[i]), expected[i]) << time[i];
}

TEST(RecordedColumn, GivesSiUnitsWhateverTheFileHas) {
  EXPECT_DOUBLE_EQ(Recorded(ramp, R"("column": "x")").at(0.1), 0.01);
  EXPECT_DOUBLE_EQ(Recorded(ramp, R"("column": "y", "unit": "kV")").at(0.1), 6000);
}

TEST(RecordedColumn, JoinsSamplesByStraightLinesWhenToldTo) {
  Recorded column(ramp, R"("column": "x", "interpolation": "linear")");
  EXPECT_NEAR(column.at(0.05), 0.005, 1e-15);
  EXPECT_NEAR(column.at(0.3), 0.025, 1e-15);
  EXPECT_NEAR(column.at(0.4), 0.020, 1e-15);
  EXPECT_NEAR(column.at(7), 0.020, 1e-15);
}

/// A sine with eight rows a period, a quarter of half their rate: `late` rows after its even instants.
Recorded sine_of_eight_rows(const std::function<double(int row)>& late) {
  std::string csv = "t,y\n";
  for (int k = 0; k < 200; ++k) {
    const double t = k + late(k);
    csv += fmt::format("{:.17g},{:.17g}\n", t, std::sin(std::numbers::pi / 4 * t));
  }
  return {csv, R"("column": "y", "interpolation": "band_limited")"};
}

TEST(RecordedColumn, ABandLimitedSineIsReproduced) {
  const Recorded even = sine_of_eight_rows([](int) { return 0.0; });
  for (int k = 0; k < 200; ++k) EXPECT_EQ(even.at(k), std::sin(std::numbers::pi / 4 * k)) << k;
  double along = 0, square = 0;
  for (double t = 40; t < 160; t += 1.0 / 64) {
    const double sine = std::sin(std::numbers::pi / 4 * t), value = even.at(t);
    EXPECT_NEAR(value, sine, 1.1e-3) << t;
    along += value * sine, square += sine * sine;
  }
  EXPECT_NEAR(along / square, 1 - 6.1e-4, 1e-5) << "the gain that docs/recordings.md states";
  for (double t = 0; t < 10; t += 1.0 / 64)
    EXPECT_NEAR(even.at(t), std::sin(std::numbers::pi / 4 * t), 0.02) << "near its beginning " << t;
}

TEST(RecordedColumn, ABandLimitedSineDoesNotDependOnWhereItsRowsAre) {
  const Recorded even = sine_of_eight_rows([](int) { return 0.0; });
  const Recorded uneven = sine_of_eight_rows([](int row) { return 0.05 * std::sin(7.0 * row * row); });
  for (double t = 40; t < 160; t += 1.0 / 64) EXPECT_NEAR(even.at(t), uneven.at(t), 1e-3) << t;
}

TEST(RecordedColumn, ABandLimitedSignalStopsNoSolverBetweenItsEnds) {
  Recorded column(ramp, R"("column": "y", "interpolation": "band_limited")");
  const double last = column.block->next_stop(0);
  EXPECT_NEAR(last, 0.4, 1e-6);
  EXPECT_EQ(column.block->next_stop(last), infinity);
  EXPECT_EQ(column.at(7), 8);
}

TEST(RecordedColumn, IsNotLateWhereTimeWasPrintedWithFewDigits) {
  std::string csv = "t,y\n";
  for (int k = 0; k < 3000; ++k) csv += std::to_string(k * 0.001) + "," + std::to_string(k) + "\n";
  Recorded column(csv, R"("column": "y")");
  for (int k = 0; k < 3000; ++k) ASSERT_EQ(column.at(k * 0.001), k);
}

TEST(RecordedColumn, EntersANewSampleAtEveryStopThatItAnnounces) {
  Recorded column(ramp, R"("column": "y")");
  double t = column.block->next_stop(0), expected = 6;
  for (; t < infinity; t = column.block->next_stop(t)) EXPECT_EQ(column.at(t), expected++) << t;
  EXPECT_EQ(expected, 9);
}

TEST(RecordedColumn, StopsTheRunBeyondItsEndWhenToldTo) {
  for (const char* kind : {"hold", "linear", "band_limited"}) {
    Recorded column(ramp,
                    R"("column": "y", "beyond": "fault", "interpolation": ")" + std::string(kind) + "\"");
    column.at(0), column.at(0.3), column.at(0.4);
    EXPECT_EQ(column.block->fault(), "") << kind;
    column.at(0.41);
    EXPECT_EQ(column.block->fault(), "the recording does not reach this time") << kind;
  }
}

TEST(RecordedColumn, TakesTheTimeColumnThatItIsTold) {
  Recorded column("a,clock,y\n7,0,1\n7,1,2\n", R"("column": "y", "time": "clock")");
  EXPECT_EQ(column.at(1.5), 2);
}

TEST(RecordedColumn, TakesTheTimeInTheUnitOfItsHeading) {
  EXPECT_EQ(Recorded("t [ms],x [mm]\n0,0\n1000,1\n2000,2\n", R"("column": "x")").at(1.5), 1e-3);
  EXPECT_EQ(Recorded("time [min],y\n0,1\n1,2\n2,3\n", R"("column": "y")").at(61), 2);
  EXPECT_EQ(Recorded("a,clock [us],y\n7,0,1\n7,1e6,2\n", R"("column": "y", "time": "clock")").at(1.5), 2);
}

TEST(RecordedColumn, NamesWhatIsWrongWithFileColumnTimeAndUnit) {
  const auto text = [](const std::string& csv, const char* settings) {
    return Recorded(csv, settings).block->problems().text();
  };
  EXPECT_NE(text(ramp, R"("column": "tme")").find("did you mean \"time\"?"), std::string::npos);
  EXPECT_NE(text(ramp, R"("column": "x", "unit": "V")").find("another unit"), std::string::npos);
  EXPECT_NE(text(ramp, R"("column": "y", "unit": "foo")").find("the unit \"foo\" cannot be read"),
            std::string::npos);
  EXPECT_NE(text(ramp, R"("column": "x", "unit": "m")").find("data.csv:1:6"), std::string::npos)
      << "the heading says mm";
  EXPECT_NE(text("x [mm],y\n0,1\n1,2\n", R"("column": "y")").find("\"x\" is no time"), std::string::npos);
  EXPECT_NE(text("t,y\n0,1\n1,2\n1,3\n", R"("column": "y")").find("at sample 3 of t"), std::string::npos);
  const std::string broken = text("t,y\n0,1\n1,two\n", R"("column": "y")");
  EXPECT_NE(broken.find("data.csv:3:3"), std::string::npos) << broken;
  EXPECT_NE(broken.find("the recording cannot be used"), std::string::npos) << broken;
  BlockUnderTest missing("RecordedColumn", R"({"file": "/no/such.csv", "column": "y"})");
  EXPECT_NE(missing.problems().text().find("/no/such.csv"), std::string::npos) << missing.problems().text();
}

}  // namespace loopwright::recorded_column_test
