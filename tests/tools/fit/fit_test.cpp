#include "tools/fit/fit.h"
#include <gtest/gtest.h>
#include <atomic>
#include <cmath>
#include "models/random/philox.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::fit_test {
namespace {

/// x'' + (b/m) x' = u/m with u = sin(2t), from rest: a record in closed form, with noise.
class Fitted : public testing::Test {
 protected:
  Fitted() {
    folder.with("axis.json", R"({
  "loopwright": 1,
  "parameters": {
    "mass":    {"value": 1500, "unit": "g"},
    "damping": {"value": 1,   "unit": "N*s/m"},
    "spare":   {"value": 3,   "unit": "N"}
  },
  "solver": {"method": "rk4", "step": 0.01, "stop": 1},
  "blocks": {
    "push":      {"type": "Constant", "value": {"value": 0, "unit": "N"}},
    "motor":     {"type": "Gain", "gain": {"value": 1, "unit": "1"}, "in": {"u": "push.y"}},
    "viscous":   {"type": "ViscousFriction", "damping": "=damping", "in": {"velocity": "mass.velocity"}},
    "net_force": {"type": "Sum", "signs": "+-", "in": {"terms": ["motor.y", "viscous.force"]}},
    "mass":      {"type": "Mass", "mass": "=mass", "initial_position": {"value": 0, "unit": "m"},
                  "initial_velocity": {"value": 0, "unit": "m/s"}, "in": {"force": "net_force.sum"}},
    "further":   {"type": "ConstantForce", "level": "=spare"}
  }
}
)");
    folder.with("e.json", R"({"loopwright": 1, "data": "data.csv", "time": "t",
      "drive": {"motor.u": {"column": "u", "unit": "N", "interpolation": "linear"}},
      "compare": {"mass.position": {"column": "x", "unit": "m"}}, "hold_out": {"fraction": 0.25}})");
    record(1);
  }
  /// With normal noise of 1 mm.
  void record(uint64_t seed) { folder.with("data.csv", data(seed)); }
  /// Another record, whose sensor has an offset, beginning in motion.
  std::string further(const std::string& name, uint64_t seed, double speed, double offset,
                      const char* more = "") {
    folder.with(name + ".csv", data(seed, speed, offset));
    folder.with(name + ".json", fmt::format(R"({{"loopwright": 1, "data": "{}.csv", "time": "t",
      "drive": {{"motor.u": {{"column": "u", "unit": "N", "interpolation": "linear"}}}},
      "compare": {{"mass.position": {{"column": "x", "unit": "m"}}}}{}}})",
                                            name, more));
    return folder.path(name + ".json");
  }
  std::string data(uint64_t seed, double speed = 0, double offset = 0) const {
    std::string text = heading;
    const double m = 2, b = 3, w = 2;
    // v' = (u - b v)/m: v = A sin wt + B (e^{-bt/m} - cos wt) with these factors.
    const double d = b * b + m * m * w * w, sine = b / d, cosine = m * w / d;
    for (int k = 0; k <= last_row; ++k) {
      const double t = k * 0.01;
      const double x = sine / w * (1 - std::cos(w * t)) - cosine / w * std::sin(w * t) +
                       (cosine + speed) * m / b * (1 - std::exp(-b * t / m)) + offset;
      const UniformPair u = uniform_pair(seed, 1, uint64_t(k));
      const double noise = 1e-3 * std::sqrt(-2 * std::log(u.first)) * std::cos(2 * M_PI * u.second);
      if (loses_every > 0 && k % loses_every == loses_every - 1) continue;
      text += fmt::format("{:.15g},{:.12g},{}\n", first_time + t / time_unit, std::sin(w * t),
                          k % reads_every == reads_every / 2 ? fmt::format("{:.9g}", x + noise) : "");
    }
    return text;
  }
  Fit fitted(const std::vector<std::string>& parameters) {
    return fit(folder.path("axis.json"), {folder.path("e.json")}, parameters);
  }
  DiagramFolder folder;
  std::string heading = "t,u,x\n";
  double time_unit = 1;  ///< s
  double first_time = 0;
  int loses_every = 0;  ///< rows; 0: none
  int reads_every = 1;  ///< [rows] the sensor is read
  int last_row = 800;
};

TEST_F(Fitted, LostRowsChangeNoParameterAndAreCounted) {
  loses_every = 7;
  record(1);
  const Fit result = fitted({"mass", "damping"});
  EXPECT_NEAR(result.parameters[0].value, 2, 0.05);
  EXPECT_NEAR(result.parameters[1].value, 3, 0.05);
  EXPECT_NEAR(result.signals[0].after, 1e-3, 1e-4);
  EXPECT_NE(to_text(result).find("114 samples between the rows of the recording are missing"),
            std::string::npos)
      << to_text(result);
}

TEST_F(Fitted, AnOutputOfASlowerRateCountsWhereItIsRead) {
  reads_every = 4;
  record(1);
  const Fit result = fitted({"mass", "damping"});
  EXPECT_EQ(result.after[0].signals[0].error.size(), 200u);
  for (const auto& [parameter, truth] :
       {std::pair(&result.parameters[0], 2.0), {&result.parameters[1], 3.0}}) {
    EXPECT_NEAR(parameter->value, truth, 0.1);
    EXPECT_LT(parameter->low, truth) << parameter->path;
    EXPECT_GT(parameter->high, truth) << parameter->path;
  }
  EXPECT_NEAR(result.signals[0].after, 1e-3, 2e-4);
  EXPECT_NEAR(result.signals[0].held_out_after, 1e-3, 3e-4);
}

TEST_F(Fitted, ThePageHasTheVerdictTheIntervalsAndTheCurves) {
  const Fit result = fitted({"mass", "damping"});
  ASSERT_EQ(result.correlations.names, (std::vector<std::string>{"mass", "damping"}));
  const double correlation = result.correlations.of_each[0][1];
  EXPECT_NEAR(correlation, result.correlations.of_each[1][0], 1e-12);
  EXPECT_EQ(result.correlations.of_each[0][0], 1);
  EXPECT_GT(std::abs(correlation), 0.01);
  EXPECT_LT(std::abs(correlation), 1);
  const report::Page page = fit_page(result, "axis.json");
  const std::string html = report::to_html(page), text = report::to_text(page);
  for (const std::string part :
       {"The fit settled.", "the error falls from", "held-out rows", "simulated before", "simulated after",
        fmt::format("{:.2f}", correlation).c_str(), "Correlations"})
    EXPECT_NE(html.find(part), html.npos) << part;
  // The curves are those of the numbers beside them.
  const ComparedSignal &before = result.before[0].signals[0], &after = result.after[0].signals[0];
  EXPECT_EQ(before.measured, after.measured);
  for (size_t k = 0; k < after.error.size(); ++k)
    ASSERT_NEAR(after.simulated[k] - after.measured[k], after.error[k], 1e-15) << k;
  EXPECT_NEAR(result.signals[0].after, 1e-3, 1e-4);
  EXPECT_GT(before.rmse, 10 * after.rmse);
}

TEST_F(Fitted, ThePageSaysWhatDidNotSettleAndWhatIsNotDetermined) {
  FitOptions options;
  options.most_iterations = 1;
  Fit result = fit(folder.path("axis.json"), {folder.path("e.json")}, {"mass", "spare"}, {}, options);
  result.has_converged = false;
  const std::string html = report::to_html(fit_page(result, "axis.json"));
  EXPECT_NE(html.find("The fit did not settle"), html.npos);
  EXPECT_NE(html.find("not determined by these records"), html.npos);
  EXPECT_NE(html.find("the record does not depend on"), html.npos);
}

TEST_F(Fitted, TimeInMillisecondsIsTheSameRecord) {
  const Fit seconds = fitted({"mass", "damping"});
  heading = "t [ms],u,x\n", time_unit = 1e-3;
  record(1);
  const Fit milliseconds = fitted({"mass", "damping"});
  for (size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(milliseconds.parameters[i].value, seconds.parameters[i].value, 1e-6);
}

TEST_F(Fitted, TimesOfDayAreTheSameRecord) {
  const Fit from_zero = fitted({"mass", "damping"});
  for (double shift : {1e6, 1.7e9}) {
    first_time = shift;
    record(1);
    const Fit shifted = fitted({"mass", "damping"});
    EXPECT_NEAR(shifted.signals[0].before, from_zero.signals[0].before, 1e-4 * from_zero.signals[0].before);
    for (size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(shifted.parameters[i].value, from_zero.parameters[i].value, 1e-4) << shift;
  }
}

TEST_F(Fitted, AParameterOrARecordCountsOnce) {
  const std::string diagram = folder.path("axis.json"), record = folder.path("e.json");
  FitOptions held_out;
  held_out.held_out = {record};
  const auto refusal = [&](const std::vector<std::string>& records,
                           const std::vector<std::string>& parameters,
                           const FitOptions& options) -> std::string {
    try {
      fit(diagram, records, parameters, {}, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_TRUE(has(refusal({record}, {"mass", "mass"}, {}), "\"mass\" is to be fitted twice"));
  EXPECT_TRUE(has(refusal({record, record}, {"mass"}, {}), "this record is used already"));
  EXPECT_TRUE(has(refusal({record}, {"mass"}, held_out), "this record is used already"));
  folder.with("copy.csv", data(1));
  folder.with("copy.json", R"({"loopwright": 1, "data": "copy.csv", "time": "t",
      "drive": {"motor.u": {"column": "u", "unit": "N", "interpolation": "linear"}},
      "compare": {"mass.position": {"column": "x", "unit": "m"}}})");
  EXPECT_TRUE(has(refusal({record, folder.path("copy.json")}, {"mass"}, {}), "this record is used already"));
  EXPECT_EQ(refusal({record, further("other", 2, 0, 0)}, {"mass"}, {}), "");
}

TEST_F(Fitted, ParametersComeBackWithinTheirIntervals) {
  int inside = 0;
  const int records = 40;
  for (int seed = 1; seed <= records; ++seed) {
    record(uint64_t(seed));
    const Fit result = fitted({"mass", "damping"});
    EXPECT_TRUE(result.has_converged);
    const FittedParameter &mass = result.parameters[0], &damping = result.parameters[1];
    EXPECT_NEAR(mass.value, 2, 0.05);
    EXPECT_NEAR(damping.value, 3, 0.05);
    EXPECT_LT(mass.high - mass.low, 0.1);
    EXPECT_GT(mass.high - mass.low, 1e-4);
    inside += (mass.low < 2 && 2 < mass.high) + (damping.low < 3 && 3 < damping.high);
    EXPECT_NEAR(result.signals[0].after, 1e-3, 1e-4);
    EXPECT_NEAR(result.signals[0].held_out_after, 1e-3, 2e-4);
  }
  EXPECT_GE(inside, 2 * records * 85 / 100);
  EXPECT_LT(inside, 2 * records);
}

/// Few rows give few blocks of errors, whose scatter is itself uncertain.
TEST_F(Fitted, IntervalsOfShortRecordsCoverAsOftenAsTheySay) {
  last_row = 133;  // 100 are fitted
  int inside = 0;
  const int records = 200;
  for (int seed = 1; seed <= records; ++seed) {
    record(uint64_t(1000 + seed));
    const Fit result = fitted({"mass", "damping"});
    const FittedParameter &mass = result.parameters[0], &damping = result.parameters[1];
    inside += (mass.low < 2 && 2 < mass.high) + (damping.low < 3 && 3 < damping.high);
  }
  EXPECT_GE(inside, 2 * records * 92 / 100);  // 95 %, less three standard deviations
  EXPECT_LE(inside, 2 * records * 98 / 100);
}

TEST_F(Fitted, TheFileGetsNewNumbersInItsOwnUnitsAndNothingElse) {
  Problems problems;
  const Fit result = fitted({"mass", "damping"});
  const std::string text = with_fitted_values(folder.path("axis.json"), result, problems);
  EXPECT_EQ(problems.text(), "");
  EXPECT_TRUE(has(text, fmt::format("\"mass\":    {{\"value\": {:.8g}, \"unit\": \"g\"}}",
                                    1000 * result.parameters[0].value)))
      << text;
  folder.with("fitted.json", text);
  const Comparison c = compare(folder.path("fitted.json"), folder.path("e.json"));
  EXPECT_NEAR(c.signals[0].rmse, 1e-3, 1e-4);
}

TEST_F(Fitted, WrongNamesInExperimentAndParametersAreToldAtOnce) {
  folder.with("wrong.json", R"({"loopwright": 1, "data": "data.csv", "time": "t",
    "drive": {"moter.u": {"column": "v", "unit": "N"}}, "compare": {"mass.positon": {"column": "x", "unit": "m"}}})");
  try {
    fit(folder.path("axis.json"), {folder.path("wrong.json")}, {"mas"});
    FAIL() << "was not refused";
  } catch (const InputError& error) {
    for (const char* part : {"did you mean \"motor\"?", "the data have no column \"v\"",
                             "did you mean \"mass.position\"?", "did you mean \"mass\"?"})
      EXPECT_TRUE(has(error.what(), part)) << part << "\n" << error.what();
  }
}

TEST_F(Fitted, WhatTheRecordDoesNotTellIsSaid) {
  const Fit idle = fitted({"mass", "spare"});
  EXPECT_FALSE(idle.parameters[1].is_determined);
  ASSERT_FALSE(idle.warnings.empty());
  EXPECT_TRUE(has(idle.warnings[0], "does not depend on \"spare\"")) << idle.warnings[0];
  const Fit scaled = fitted({"mass", "damping", "motor.gain"});  // force, mass and damping by one factor
  EXPECT_TRUE(std::ranges::any_of(scaled.warnings, [](const std::string& w) { return has(w, "apart"); }));
  EXPECT_FALSE(scaled.parameters[0].is_determined);
}

TEST_F(Fitted, BoundsAreThoseOfTheBlocks) {
  const Fit result = fitted({"damping", "mass"});
  EXPECT_EQ(result.parameters[0].least, 0);
  EXPECT_EQ(result.parameters[1].least, 0);
}

/// Mass and damping are shared; each record has its own speed at the start and its own zero.
TEST_F(Fitted, RecordsShareParametersAndHaveTheirOwnStartsAndOffsets) {
  const std::vector<double> speeds = {0.3, -0.2};
  const std::string one = further("one", 1, speeds[0], 0.05), two = further("two", 2, speeds[1], -0.02),
                    other = further("other", 3, 0, 0.01);
  FitOptions options;
  options.of_each = {"mass.initial_velocity"}, options.takes_offsets_out = true, options.held_out = {other};
  const Fit result = fit(folder.path("axis.json"), {one, two}, {"mass", "damping"}, {}, options);
  ASSERT_EQ(result.parameters.size(), 2u);
  EXPECT_NEAR(result.parameters[0].value, 2, 0.05);
  EXPECT_NEAR(result.parameters[1].value, 3, 0.05);
  ASSERT_EQ(result.records.size(), 3u);
  for (size_t r = 0; r < 2; ++r) {
    ASSERT_EQ(result.records[r].parameters.size(), 1u);
    const FittedParameter& speed = result.records[r].parameters[0];
    EXPECT_NEAR(speed.value, speeds[r], 0.01);
    EXPECT_GT(speed.high - speed.low, 1e-5);
    EXPECT_LT(speed.high - speed.low, 0.02);
    EXPECT_NEAR(result.records[r].signals[0].after, 1e-3, 1e-4);
  }
  EXPECT_TRUE(result.records[2].is_held_out);
  EXPECT_EQ(result.records[2].signals[0].after, 0) << "no row of it is fitted";
  EXPECT_NEAR(result.records[2].signals[0].held_out_after, 1e-3, 2e-4);
  EXPECT_GT(result.records[2].signals[0].held_out_before, 5e-3);
}

TEST_F(Fitted, AnExperimentCanHoldItsWholeRecordOut) {
  const std::string fitted_record = further("one", 1, 0, 0),
                    held_out = further("two", 2, 0, 0, R"(, "hold_out": {"fraction": 1})");
  const Fit result = fit(folder.path("axis.json"), {fitted_record, held_out}, {"mass", "damping"});
  const Fit alone = fit(folder.path("axis.json"), {fitted_record}, {"mass", "damping"});
  for (size_t i = 0; i < 2; ++i) EXPECT_DOUBLE_EQ(result.parameters[i].value, alone.parameters[i].value);
  EXPECT_NEAR(result.signals[0].held_out_after, 1e-3, 1e-4);
  try {
    fit(folder.path("axis.json"), {held_out}, {"mass"});
    FAIL() << "was not refused";
  } catch (const InputError& error) {
    EXPECT_TRUE(has(error.what(), "every record is held out")) << error.what();
  }
}

/// The record asks for a damping of 3; the mass would become negative if it were -3.
TEST_F(Fitted, ParametersKeepTheirSignAndStayInTheirRange) {
  FitOptions options;
  options.ranges = {{"damping", 0.5, 2.5}};
  const Fit bounded =
      fit(folder.path("axis.json"), {folder.path("e.json")}, {"mass", "damping"}, {}, options);
  EXPECT_NEAR(bounded.parameters[1].value, 2.5, 1e-6);
  EXPECT_TRUE(
      std::ranges::any_of(bounded.warnings, [](const std::string& w) { return has(w, "at the limit"); }));
  const LoadOptions reversed{.set = {{"motor.gain", "-1"}}};
  const Fit kept = fit(folder.path("axis.json"), {folder.path("e.json")}, {"motor.gain"}, reversed);
  EXPECT_LE(kept.parameters[0].value, 0);
  EXPECT_TRUE(std::ranges::any_of(kept.warnings, [](const std::string& w) { return has(w, "at the limit"); }))
      << kept.parameters[0].value;
  options.ranges = {{"motor.gain", -2, 2}};
  const Fit free = fit(folder.path("axis.json"), {folder.path("e.json")}, {"motor.gain", "mass", "damping"},
                       {.set = {{"motor.gain", "-0.1"}, {"mass", "2 kg"}}}, options);
  EXPECT_GT(free.parameters[0].value, 0);
  options.ranges = {{"dampin", 0, 1}};
  EXPECT_THROW(fit(folder.path("axis.json"), {folder.path("e.json")}, {"damping"}, {}, options), InputError);
  options.ranges = {{"damping", 2, 5}};
  EXPECT_THROW(fit(folder.path("axis.json"), {folder.path("e.json")}, {"damping"}, {}, options), InputError)
      << "it begins at 1";
}

/// From anywhere, with any number of iterations.
/// Whenever the interruption comes: no interval, and no value that a cut-off simulation seemed to confirm.
TEST_F(Fitted, AnInterruptedFitKnowsNoIntervals) {
  std::atomic<bool> interrupt = true;
  FitOptions options;
  options.interrupt = &interrupt;
  const auto interrupted_fit = [&] {
    return fit(folder.path("axis.json"), {folder.path("e.json")}, {"mass", "damping"}, {}, options);
  };
  const Fit at_once = interrupted_fit();
  EXPECT_TRUE(at_once.was_interrupted);
  EXPECT_TRUE(at_once.parameters.empty());
  interrupt = false;
  int calls = 0;
  options.progress = [&](int, double) { interrupt = ++calls >= 2; };
  const Fit in_the_first_round = interrupted_fit();
  EXPECT_TRUE(in_the_first_round.was_interrupted);
  EXPECT_FALSE(in_the_first_round.has_converged);
  ASSERT_EQ(in_the_first_round.parameters.size(), 2u);
  for (const FittedParameter& p : in_the_first_round.parameters) {
    EXPECT_EQ(p.value, p.start);
    EXPECT_TRUE(std::isnan(p.low) && std::isnan(p.high));
  }
  EXPECT_NE(to_text(in_the_first_round).find("interrupted"), std::string::npos);
  EXPECT_EQ(to_text(in_the_first_round).find("no better values"), std::string::npos);
}

TEST_F(Fitted, NeverEndsWorseThanItBegan) {
  for (const char* mass : {"0.01 kg", "2 kg", "900 kg"})
    for (const int iterations : {1, 2, 40}) {
      FitOptions options;
      options.most_iterations = iterations;
      const LoadOptions start{.set = {{"mass", mass}}};
      const Fit result =
          fit(folder.path("axis.json"), {folder.path("e.json")}, {"mass", "damping"}, start, options);
      EXPECT_LE(result.signals[0].after, result.signals[0].before * (1 + 1e-12)) << mass << " " << iterations;
      if (!result.has_converged) {
        EXPECT_TRUE(has(to_text(result), "did not settle"));
      }
    }
}

TEST_F(Fitted, AMisspeltParameterIsAnError) {
  try {
    fitted({"mas", "viscous.dampin"});
    FAIL() << "was not refused";
  } catch (const InputError& error) {
    EXPECT_TRUE(has(error.what(), "did you mean \"mass\"?")) << error.what();
    EXPECT_TRUE(has(error.what(), "did you mean \"damping\"?")) << error.what();
  }
}

TEST_F(Fitted, AnExpressionHasNoNumberToWrite) {
  Problems problems;
  const Fit result = fitted({"viscous.damping"});
  EXPECT_NEAR(result.parameters[0].value, 2, 2) << "it can be fitted";
  EXPECT_EQ(with_fitted_values(folder.path("axis.json"), result, problems), "");
  EXPECT_TRUE(has(problems.text(), "is an expression")) << problems.text();
}

}  // namespace
}  // namespace loopwright::fit_test
