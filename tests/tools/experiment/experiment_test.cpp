// Experiments and data that do not match are reported with source location.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include "tests/tools/experiment/experiment_folder.h"

namespace loopwright::experiment_test {
namespace {

double one(double) { return 1; }

class Experiments : public ::testing::Test {
 protected:
  void SetUp() override { folder.data(every(0.1, 11), one, one); }
  void expect_refusal(std::initializer_list<const char*> parts) const {
    const std::string text = folder.refusal();
    for (const char* part : parts) EXPECT_TRUE(has(text, part)) << part << "\n" << text;
  }
  /// Of a comparison with rows that are a step apart by their clock.
  std::string warnings(const char* heading, double step) {
    std::string text = std::string(heading) + ",F,x_mm\n";
    for (int i = 0; i < 5; ++i) text += fmt::format("{},1,0\n", i * step);
    folder.with("data.csv", text);
    folder.with("e.json", R"({"loopwright": 1, "data": "data.csv", "drive": {"stage.force": {"column": "F"}},
      "compare": {"stage.position": {"column": "x_mm", "unit": "mm"}}})");
    std::string all;
    for (const std::string& warning : folder.compared().warnings) all += warning;
    return all;
  }
  ExperimentFolder folder;
};
constexpr const char* drive = R"("stage.force": {"column": "F", "unit": "N"})";

TEST_F(Experiments, AMisspeltPortSaysWhatWasMeant) {
  folder.experiment(drive, R"("stage.postion": {"column": "x_mm", "unit": "mm"})");
  expect_refusal(
      {"e.json:1:", "the diagram has no port \"stage.postion\"", "did you mean \"stage.position\"?"});
}

TEST_F(Experiments, AMisspeltDriveSaysWhatWasMeant) {
  folder.experiment(R"("stage.forse": {"column": "F", "unit": "N"})");
  expect_refusal({"forse", "did you mean \"force\"?"});
}

TEST_F(Experiments, AMisspeltColumnSaysWhatWasMeant) {
  folder.experiment(drive, R"("stage.position": {"column": "x_m", "unit": "mm"})");
  expect_refusal({"the data have no column \"x_m\"", "did you mean \"x_mm\"?"});
}

TEST_F(Experiments, AComparedColumnInTheWrongUnitIsAnError) {
  folder.experiment(drive, R"("stage.position": {"column": "x_mm", "unit": "N"})");
  expect_refusal({"\"stage.position\" is in another unit than its column", "expected: m", "found: N"});
}

TEST_F(Experiments, ADrivingColumnInTheWrongUnitIsAnError) {
  folder.experiment(R"("stage.force": {"column": "F", "unit": "V"})");
  expect_refusal({"V", "N", "stage"});
}

TEST_F(Experiments, OneWireOfAListIsDriven) {
  folder.with("stage.json", diagram(R"("push": {"type": "Constant", "value": {"value": 4, "unit": "N"}},
    "pull": {"type": "Constant", "value": {"value": 100, "unit": "N"}},
    "sum": {"type": "Sum", "signs": "+-", "in": {"terms": ["push.y", "pull.y"]}},
    "stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "sum.sum"}})",
                                    R"("method": "rk4", "step": 0.05, "stop": 1)"));
  // A constant force of 4 N less the 1 N of the record on 2 kg.
  folder.data(
      every(0.05, 20), [](double) { return 1.0; }, [](double t) { return 0.75 * t * t; });
  folder.experiment(R"("sum.terms[1]": {"column": "F", "unit": "N"})");
  EXPECT_LT(folder.compared().signals[0].rmse, 1e-12);
  folder.experiment(R"("sum.terms[1]": {"column": "F", "unit": "m"})");
  EXPECT_THAT(folder.refusal(), ::testing::HasSubstr("expected: a signal in N\n  found: m"));
  EXPECT_THAT(folder.refusal(), ::testing::Not(::testing::HasSubstr("has no port")));
  folder.experiment(R"("sum.terms[3]": {"column": "F", "unit": "N"})");
  EXPECT_THAT(folder.refusal(), ::testing::HasSubstr("has no wire 3"));
}

TEST_F(Experiments, AColumnInRatesPerMinuteIsNoSpeedInRadians) {
  folder.with("shaft.json", diagram(R"("push": {"type": "Constant", "value": {"value": 0, "unit": "N*m"}},
    "stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg*m^2"}, "in": {"force": "push.y"}})",
                                    R"("method": "rk4", "step": 0.05, "stop": 1)"));
  folder.with("data.csv", "t,F,n\n0,1,0\n1,1,1\n2,1,2\n");
  const auto refusal = [&](const std::string& unit) {
    folder.experiment(R"("stage.force": {"column": "F", "unit": "N*m"})",
                      R"("stage.velocity": {"column": "n", "unit": ")" + unit + "\"}");
    try {
      compare(folder.path("shaft.json"), folder.path("e.json"));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_TRUE(has(refusal("1/min"), "\"stage.velocity\" is in another unit than its column"));
  EXPECT_TRUE(has(refusal("1/min"), "revolutions (rpm)")) << refusal("1/min");
  EXPECT_EQ(refusal("rpm"), "");
}

/// Radians and counts are both plain numbers for the arithmetic.
TEST_F(Experiments, CountsAreNoRadians) {
  folder.with("stage.json", diagram(R"("push": {"type": "Constant", "value": {"value": 0, "unit": "N*m"}},
      "stage": {"type": "Inertia", "inertia": {"value": 2, "unit": "kg*m^2"}, "in": {"torque": "push.y"}})",
                                    R"("method": "rk4", "step": 0.05, "stop": 1)"));
  const auto refused = [&](std::string_view heading, std::string_view stated) {
    folder.with("data.csv", fmt::format("t,T,{}\n0,1,0\n1,1,0.25\n2,1,1\n", heading));
    folder.experiment(R"("stage.torque": {"column": "T", "unit": "N*m"})",
                      fmt::format(R"("stage.angle": {{"column": "x"{}}})", stated));
    return folder.refusal();
  };
  for (const char* unit : {"counts", "count", "pulses", "LSB"})
    EXPECT_TRUE(has(refused(fmt::format("x [{}]", unit), ""), "a count is no radian")) << unit;
  EXPECT_TRUE(has(refused("x", R"(, "unit": "counts")"), "a count is no radian"));
  EXPECT_TRUE(has(refused("x [counts]", R"(, "unit": "rad")"), "has another unit in its file"));
  const std::string torque = R"("stage.torque": {"column": "T", "unit": "N*m"})",
                    angle = R"("stage.angle": {"column": "a"})";
  for (const char* unit : {"rad", "deg"}) {  // what the hint says
    folder.with("data.csv", "t,T,x [counts]\n0,1,0\n1,1,1\n2,1,4\n");
    folder.experiment(torque, angle,
                      fmt::format(R"(, "columns": {{"a": {{"column": "x", "scale": {}, "unit": "{}"}}}})",
                                  unit == std::string("rad") ? "0.25" : "14.3239448782705802", unit));
    EXPECT_EQ(folder.refusal(), "") << unit;
    EXPECT_NEAR(folder.compared().signals[0].rmse, 0, 1e-9) << unit;
  }
  EXPECT_EQ(refused("x [rad]", ""), "");
  EXPECT_EQ(refused("x [deg]", ""), "");
  EXPECT_EQ(refused("x", R"(, "unit": "rad")"), "");
}

TEST_F(Experiments, AUnitThatCannotBeReadIsAnError) {
  folder.experiment(drive, R"("stage.position": {"column": "x_mm", "unit": "blorps"})");
  expect_refusal({"the unit \"blorps\" cannot be read"});
}

/// x = t²/4, with a velocity in every third row alone.
TEST_F(Experiments, ASlowerSignalIsComparedAtItsOwnRows) {
  const auto record = [&](const char* none) {
    std::string text = "t,F,x_mm,v\n";
    for (int k = 0; k < 20; ++k) {
      const double t = 0.05 * k;
      text += fmt::format("{},1,{},{}\n", t, 250 * t * t, k % 3 == 0 ? fmt::format("{}", t / 2) : none);
    }
    folder.with("data.csv", text);
  };
  const std::string both = R"("stage.position": {"column": "x_mm", "unit": "mm"},
    "stage.velocity": {"column": "v", "unit": "m/s"})";
  for (const char* none : {"", "nan"}) {
    record(none);
    folder.experiment(drive, both);
    const Comparison whole = folder.compared();
    EXPECT_EQ(whole.time.size(), 20u);
    const ComparedSignal &position = whole.signals[0], &velocity = whole.signals[1];
    EXPECT_EQ(position.error.size(), 20u);
    EXPECT_EQ(velocity.error.size(), 7u);
    EXPECT_LT(position.rmse, 1e-9);
    EXPECT_LT(velocity.max_abs, 1e-9);
    EXPECT_NEAR(velocity.measured.back(), 0.05 * 18 / 2, 1e-12);
    folder.experiment(drive, both, R"(, "excerpt": {"skip": 0, "decimate": 3})");
    const Comparison c = folder.compared();
    EXPECT_EQ(c.time.size(), 7u);
    for (const ComparedSignal& signal : c.signals) EXPECT_LT(signal.rmse, 1e-9) << signal.name;
    folder.experiment(drive, R"("stage.position": {"column": "x_mm", "unit": "mm"})");
    EXPECT_LT(folder.compared().signals[0].rmse, 1e-9) << "what is not used may have holes";
  }
}

/// 1 N for two seconds; each command was written a row late.
TEST_F(Experiments, AColumnThatWasLoggedLateIsReadEarlier) {
  folder.with("data.csv", "t,F,x_mm\n0,0,0\n1,1,250\n2,1,1000\n3,0,2000\n4,0,3000\n");
  folder.experiment();
  EXPECT_GT(folder.compared().signals[0].rmse, 0.1);
  const std::string position = R"("stage.position": {"column": "x_mm", "unit": "mm"})";
  folder.experiment(drive, position, R"(, "columns": {"F": {"rows_late": 1}})");
  const Comparison c = folder.compared();
  EXPECT_EQ(c.time, (std::vector<double>{0, 1, 2, 3})) << "no command belongs to the last row";
  EXPECT_NEAR(c.signals[0].rmse, 0, 1e-9);
  folder.with("data.csv", "t,F,x_mm\n0,,0\n1,1,250\n2,1,1000\n3,0,2000\n4,0,\n");  // in cells left out
  EXPECT_NEAR(folder.compared().signals[0].rmse, 0, 1e-9);
  folder.experiment(drive, position, R"(, "columns": {"F": {"rows_late": 4}})");
  expect_refusal({R"("F" is 4 rows late in a recording of 5 rows)"});
  folder.experiment(drive, position, R"(, "columns": {"F": {"rows_late": 0.5}})");
  expect_refusal({"rows are counted in whole numbers"});
}

/// What drives has a value at all times: nobody knows it between these rows.
TEST_F(Experiments, ASlowerDriveIsRefusedWithTheRowsThatHaveIt) {
  std::string text = "t,F,x_mm\n";
  for (int k = 0; k < 20; ++k) text += fmt::format("{},{},{}\n", 0.05 * k, k % 3 == 1 ? "1" : "", k);
  folder.with("data.csv", text);
  folder.experiment(drive);
  expect_refusal({"column \"F\" has a number in one of 3 rows, from row 2 on",
                  "e.json:", R"("excerpt": {"skip": 1, "decimate": 3})"});
}

/// A single cell without a number is told at its place.
TEST_F(Experiments, AHoleIsNoSlowerSignal) {
  folder.with("data.csv", "t,F,x_mm\n0,1,0\n1,1,\n2,1,1000\n3,1,2250\n");
  folder.experiment();
  expect_refusal({"data.csv:3:5: error: column \"x_mm\": an empty cell"});
}

TEST_F(Experiments, TheTimeColumnHonoursItsUnit) {
  folder.with("data.csv", "t [ms],F,x_mm\n0,1,0\n1000,1,250\n2000,1,1000\n");
  const Comparison c = folder.compared();
  EXPECT_EQ(c.time, (std::vector<double>{0, 1, 2}));
  EXPECT_NEAR(c.signals[0].rmse, 0, 1e-9) << "x = t^2/4";
}

TEST_F(Experiments, UnitsOfHeadingsInParenthesesCount) {
  for (const char* time : {"Time (ms)", "Time"}) {
    folder.with("data.csv", "Time (ms),F (N),x/mm\n0,1,0\n1000,1,250\n2000,1,1000\n");
    const std::string begin = R"~({"loopwright": 1, "data": "data.csv", "time": ")~";
    folder.with("e.json", begin + time + R"~(", "drive": {"stage.force": {"column": "F (N)"}},
        "compare": {"stage.position": {"column": "x", "unit": "mm"}}})~");
    const Comparison c = folder.compared();
    EXPECT_EQ(c.time, (std::vector<double>{0, 1, 2})) << time;
    EXPECT_NEAR(c.signals[0].rmse, 0, 1e-9) << "x = t^2/4";
  }
}

TEST_F(Experiments, ATimeThatSaysMillisecondsIsNotTakenForSeconds) {
  folder.with("data.csv", "timestamp_millis,F,x_mm\n0,1,0\n1000,1,250\n2000,1,1000\n");
  folder.with("e.json", R"({"loopwright": 1, "data": "data.csv", "drive": {"stage.force": {"column": "F"}},
      "compare": {"stage.position": {"column": "x_mm", "unit": "mm"}}})");
  expect_refusal({"its name says another one than s", "\"timestamp_millis [ms]\" as the heading"});
}

TEST_F(Experiments, RowsAThousandSamplesApartAreAWarning) {
  folder.with("stage.json", diagram(R"("push": {"type": "Constant", "value": {"value": 0, "unit": "N"}},
      "hold": {"type": "ZeroOrderHold", "sample_time": {"value": 1.25, "unit": "ms"}, "in": {"u": "push.y"}},
      "stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "push.y"}})",
                                    R"("method": "rk4", "step": 0.00125, "stop": 1)"));
  EXPECT_TRUE(
      has(warnings("clock", 1.25), "the rows are 1.25 s apart, and the diagram has samples of 0.00125 s"));
  EXPECT_TRUE(has(warnings("clock", 1.25), "its heading is \"clock [ms]\""));
  EXPECT_FALSE(has(warnings("clock [ms]", 1.25), "apart"));
  EXPECT_FALSE(has(warnings("clock", 0.0125), "apart")) << "a decimated log";
}

TEST_F(Experiments, RowsThousandsOfStepsApartAreAWarningWithoutSamples) {
  folder.with("stage.json", diagram(R"("push": {"type": "Constant", "value": {"value": 0, "unit": "N"}},
      "stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "push.y"}})",
                                    R"("method": "rk4", "step": 0.0005, "stop": 1)"));
  EXPECT_TRUE(
      has(warnings("clock", 2), "the rows are 2 s apart, which is 4000 steps of the diagram's solver"));
  EXPECT_TRUE(has(warnings("clock", 2), "its heading is \"clock [ms]\""));
  EXPECT_FALSE(has(warnings("clock [ms]", 2), "apart"));
  EXPECT_FALSE(has(warnings("clock", 0.1), "apart")) << "a slow log";
}

TEST_F(Experiments, ANumberThatNoSensorGivesIsRefusedWithItsTime) {
  folder.with("data.csv", "t,F,x_mm\n0,1,0\n0.1,3.4e38,1\n0.2,1,2\n0.3,1,3\n0.4,-3.4e38,4\n");
  folder.with("e.json",
              R"({"loopwright": 1, "data": "data.csv", "drive": {"stage.force": {"column": "F", "unit": "N"}},
      "compare": {"stage.position": {"column": "x_mm", "unit": "mm"}}})");
  expect_refusal({"e.json:1:", "column \"F\": no sensor gives 3.4e+38",
                  "found: 2 such values, the first at 0.1 s", "leave out the rows"});
}

TEST_F(Experiments, AResolutionMayHaveAUnitOfItsOwn) {
  const auto resolution = [&](const std::string& text) {
    folder.experiment(drive,
                      R"("stage.position": {"column": "x_mm", "unit": "mm", "resolution": )" + text + "}");
    Problems problems;
    const auto experiment = load_experiment(folder.path("e.json"), problems);
    return experiment ? experiment->compared[0].resolution : -1;
  };
  for (const char* text : {"0.005", "\"5 um\"", "\"0.005 mm\"", R"({"value": 5, "unit": "um"})"})
    EXPECT_DOUBLE_EQ(resolution(text), 5e-6) << text;
  EXPECT_EQ(resolution("\"5 N\""), -1);
  expect_refusal({"e.json:1:", "\"resolution\" has another unit", "expected: a number in mm", "found: N"});
  EXPECT_EQ(resolution("\"-5 um\""), -1);
  expect_refusal({"\"resolution\" is out of range"});
  EXPECT_EQ(resolution(R"({"value": 5})"), -1);
  expect_refusal({"\"resolution\" lacks its \"unit\""});
  EXPECT_EQ(resolution("\"fine\""), -1);
  expect_refusal({"wrong kind", "expected: a number, \"5 um\""});
}

TEST_F(Experiments, AUnitThatContradictsTheHeadingNamesBoth) {
  folder.with("data.csv", "t,F,x_mm [mm]\n0,1,1\n1,1,1\n2,1,1\n");
  folder.experiment(drive, R"("stage.position": {"column": "x_mm", "unit": "m"})");
  expect_refusal({"e.json:1:", "another unit in its file", "[mm] in data.csv:1:5", "found: m"});
}

TEST_F(Experiments, AUnitInTheHeadingMustFitThePort) {
  folder.with("data.csv", "t,F [A],x_mm\n0,1,1\n1,1,1\n2,1,1\n");
  folder.experiment(R"("stage.force": {"column": "F"})");
  expect_refusal({"A", "stage"});
}

TEST_F(Experiments, ALogWhoseTimesHideItsLostSamplesIsRefused) {
  folder.with("data.csv", "t,F,x_mm,loop.lost\n0,1,1,0\n1,1,1,0\n2,1,1,2\n3,1,1,0\n");
  expect_refusal({"the log counts 2 lost samples, and its times leave out 0"});
}

TEST_F(Experiments, HolesInTheDataAreAnErrorWithTheirLine) {
  folder.with("data.csv", "t,F,x_mm\n0,1,1\n0.1,nan,1\n0.2,1,1\n");
  expect_refusal({"data.csv:3"});
}

TEST_F(Experiments, TimesThatDoNotRiseAreAnError) {
  folder.with("data.csv", "t,F,x_mm\n0,1,1\n0.2,1,1\n0.1,1,1\n0.3,1,1\n");
  expect_refusal({"error:", "0.1"});
}

TEST_F(Experiments, TimesThatRepeatAreAnError) {
  folder.with("data.csv", "t,F,x_mm\n0,1,1\n0.1,1,1\n0.1,1,2\n0.2,1,1\n");  // which of the two holds?
  expect_refusal({"error:"});
}

TEST_F(Experiments, OneRowIsNoRecordOfAMotion) {
  folder.with("data.csv", "t,F,x_mm\n0,1,1\n");
  expect_refusal({"error: one row"});
}

TEST_F(Experiments, TimesBeforeZeroAreAnErrorWithAdvice) {
  folder.with("data.csv", "t,F,x_mm\n-0.1,1,1\n0,1,1\n0.1,1,1\n");
  expect_refusal({"begin before zero", "shift them"});
}

TEST_F(Experiments, AMissingDataFileSaysWhereItWasLookedFor) {
  std::filesystem::remove(folder.path("data.csv"));
  expect_refusal({"the data file \"data.csv\" is not there", "data.csv", "LOOPWRIGHT_DATA"});
}

TEST_F(Experiments, ADataFileIsNotTakenFromAPlaceThatNobodyNamed) {
  namespace fs = std::filesystem;
  std::stringstream file;
  file << std::ifstream(folder.path("data.csv")).rdbuf();
  const std::string rows = file.str();
  fs::remove(folder.path("data.csv"));
  folder.with("shared/data/one/data.csv", rows).with("work/notes.txt", "");
  const fs::path before = fs::current_path();
  fs::current_path(folder.path("work"));
  unsetenv("LOOPWRIGHT_DATA");
  expect_refusal({"the data file \"data.csv\" is not there"});
  setenv("LOOPWRIGHT_DATA", folder.path("shared/data").c_str(), 1);
  EXPECT_NO_THROW(compare(folder.path("stage.json"), folder.path("e.json")));
  folder.with("shared/data/other/data.csv", rows);
  expect_refusal({"in several folders", "one/data.csv", "other/data.csv"});
  unsetenv("LOOPWRIGHT_DATA");
  fs::current_path(before);
}

TEST_F(Experiments, AMissingExperimentOrDiagramIsAnError) {
  EXPECT_THROW(compare(folder.path("stage.json"), folder.path("none.json")), InputError);
  EXPECT_THROW(compare(folder.path("none.json"), folder.path("e.json")), InputError);
}

TEST_F(Experiments, UnknownKeysAndMissingPartsAreErrors) {
  folder.experiment(drive, R"("stage.position": {"column": "x_mm", "unti": "mm"})");
  expect_refusal({"unti", "did you mean \"unit\"?"});
  folder.experiment(drive, "");
  expect_refusal({"compares nothing"});
  folder.experiment(R"("stage.force": {"column": "F", "unit": "N", "interpolation": "band_limit"})");
  expect_refusal({R"(one of "hold", "linear", "band_limited")", R"(did you mean "band_limited"?)"});
  folder.experiment(drive, R"("stage.position": {"column": "x_mm", "unit": "mm"})",
                    R"(, "hold_out": {"fraction": 2})");
  expect_refusal({"\"fraction\" is out of range", "from 0 to 1"});
  folder.experiment(drive, R"("stage.position": {"column": "x_mm", "unit": "mm"})",
                    R"(, "roles": {"speed": "stage.velocity"})");
  expect_refusal({"speed"});
  folder.experiment(drive, R"("stage.position": {"column": "x_mm", "unit": "mm"})",
                    R"(, "roles": {"velocity": "stage.velosity"})");
  expect_refusal({"did you mean \"stage.velocity\"?"});
  folder.with("e.json", "{");
  expect_refusal({"e.json:1:"});
  folder.with("e.json", R"({"data": "data.csv"})");
  expect_refusal({"\"loopwright\": 1"});
}

TEST_F(Experiments, ProblemsOfTheDiagramAreToldTogetherWithThoseOfTheExperiment) {
  folder.with("stage.json", diagram(R"("stage": {"type": "Mas", "mass": 2})"));
  folder.experiment(drive, "");
  expect_refusal({"compares nothing", "did you mean \"Mass\"?"});
}

}  // namespace
}  // namespace loopwright::experiment_test
