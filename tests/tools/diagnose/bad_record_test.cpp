// Records that cannot support a verdict are named, with the consequence.
#include <gmock/gmock.h>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include "tests/tools/diagnose/diagnosed_plant.h"
#include "tests/tools/diagnose/flawed_axis.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tests/tools/diagnose/recorded_axis.h"
#include "tools/diagnose/diagnose.h"

namespace loopwright::bad_record_test {
namespace {

using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::Not;

Diagnosis spoilt(const std::function<void(std::vector<double>&, std::vector<double>&)>& how,
                 double duration_s = 6) {
  Truth truth;
  truth.duration_s = duration_s;
  RecordedAxis axis(truth);
  axis.spoil(how);
  return diagnose(axis.diagram(), {axis.experiment()});
}

auto finds(const char* words) { return Contains(Field(&RecordFinding::what, HasSubstr(words))); }

TEST(BadRecord, AWrongSignIsToldAndNothingIsNamed) {
  const Diagnosis d = spoilt([](auto& force, auto&) {
    for (double& f : force) f = -f;
  });
  EXPECT_THAT(d.findings, finds("pushes against the motion"));
  EXPECT_TRUE(d.effects.empty());
  EXPECT_EQ(d.verdict, Verdict::unexplained);
}

/// Of a machine that is driven, or that coasts: neither shows how large a force is.
TEST(BadRecord, AnInputOfZeroThroughoutSupportsNoVerdict) {
  const Diagnosis d = spoilt([](auto& force, auto&) { std::ranges::fill(force, 0.0); });
  EXPECT_THAT(d.findings, finds("the recorded input is zero in every row"));
  EXPECT_TRUE(d.effects.empty());
  EXPECT_EQ(d.verdict, Verdict::unexplained);
}

TEST(BadRecord, MillimetresTakenForMetresAreTold) {
  const Diagnosis d = spoilt([](auto&, auto& position) {
    for (double& x : position) x *= 1000;
  });
  EXPECT_THAT(d.findings, finds("times the force that the model needs"));
  EXPECT_TRUE(d.effects.empty());
}

TEST(BadRecord, ASensorThatNeverChangesIsRejected) {
  try {
    spoilt([](auto&, auto& position) { std::ranges::fill(position, 0.5); });
    FAIL() << "a machine that does not answer its input is explained by any dead band";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("never changes"));
  }
}

Truth with_coulomb_friction() {
  Truth truth;
  truth.duration_s = 8;
  truth.force = [](double, double v, double) { return 0.3 * std::tanh(v / 1e-3); };
  return truth;
}
Diagnosis with_spoilt_command(const std::function<void(std::vector<double>&)>& how) {
  RecordedAxis axis(with_coulomb_friction());
  axis.spoil([&](auto& force, auto&) { how(force); });
  return diagnose(axis.diagram(), {axis.experiment()});
}
void expect_coulomb_friction(const Diagnosis& d) {
  EXPECT_EQ(name_of(d.verdict), "explained") << to_text(d);
  ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
  EXPECT_EQ(d.effects[0].name, "coulomb_friction");
  EXPECT_NEAR(d.effects[0].parameters[0].value, 0.3, 0.01);
}

TEST(BadRecord, ValuesOfACommandThatTheMachineDoesNotFeelAreTakenAway) {
  for (const double spike : {20.0, 32767.0}) {
    const Diagnosis d = with_spoilt_command([&](std::vector<double>& force) {
      for (size_t k : {1500u, 3000u, 4400u}) force[k] = spike;
    });
    EXPECT_THAT(d.findings, finds("3 values of recorded inputs are out of line")) << spike;
    expect_coulomb_friction(d);
  }
}
TEST(BadRecord, ZerosOfADeviceThatWasNotReadyAreTakenAway) {
  size_t zeros = 0;
  const Diagnosis d = with_spoilt_command([&](std::vector<double>& force) {
    for (size_t k = 300; k < force.size(); k += 130)
      if (std::abs(force[k]) > 0.5) force[k] = 0, ++zeros;
  });
  EXPECT_GT(zeros, 10u);
  EXPECT_THAT(d.findings, finds("of recorded inputs are out of line"));
  expect_coulomb_friction(d);
}
/// A force that is straight between its rows spreads a wrong value over two samples.
TEST(BadRecord, AWrongValueOfAnInputThatIsNotHeldIsTakenAway) {
  FlawedMachine machine;
  machine.input_is_linear = true, machine.coulomb = 0.6, machine.duration = 8;
  const FlawedAxis axis(machine);
  const std::filesystem::path file = std::filesystem::path(axis.diagram()).parent_path() / "record.csv";
  std::stringstream read, written;
  read << std::ifstream(file).rdbuf();
  std::string line;
  for (size_t row = 0; std::getline(read, line); ++row) {
    const size_t from = line.find(','), to = line.find(',', from + 1);
    written << (row % 1500 == 700 ? line.substr(0, from) + ",40" + line.substr(to) : line) << '\n';
  }
  std::ofstream(file) << written.str();
  const Diagnosis d = diagnose(axis.diagram(), {axis.experiment()});
  EXPECT_THAT(d.findings, finds("of recorded inputs are out of line")) << to_text(d);
  ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
  EXPECT_EQ(d.effects[0].name, "coulomb_friction");
  EXPECT_NEAR(d.effects[0].parameters[0].value, 0.6, 0.02);
}
TEST(BadRecord, PulsesThatTheMachineFeelsAreACommand) {
  HiddenAxis axis;
  WantedMotion wanted = there_and_back(0.3, 0.4);
  wanted.added_force.assign(wanted.position.size(), 0.0);
  for (size_t k = 700; k + 10 < wanted.position.size(); k += 900) wanted.added_force[k] = 15;
  const std::string record = axis.record("pulses", axis.nominal(), wanted);
  const Diagnosis d = diagnose(axis.diagram(), {record});
  EXPECT_THAT(d.findings, Not(finds("out of line"))) << to_text(d);
  EXPECT_EQ(name_of(d.verdict), "nothing_missing") << to_text(d);
}

/// Without roles too.
TEST(BadRecord, AnAngleThatBeginsAnewGivesNoVerdict) {
  Plant plant = motor({}, 6);
  plant.outputs = [](const Numbers& x) {
    constexpr double turn = 2 * std::numbers::pi;
    return Numbers{x[0], x[1] - turn * std::floor(x[1] / turn)};
  };
  const Diagnosis d = diagnosed(plant);
  EXPECT_THAT(d.findings, finds("the measured rotor.position leaps by a turn")) << to_text(d);
  EXPECT_EQ(d.verdict, Verdict::unexplained);
}

TEST(BadRecord, ASensorThatShowsNoiseAloneGivesNoVerdict) {
  const Diagnosis d = spoilt([](auto&, auto& position) {
    uint64_t bits = 1;
    for (double& x : position) {
      bits = bits * 6364136223846793005u + 1442695040888963407u;
      x = 0.5 + 1e-7 * double(bits >> 62);  // 0 to 3 counts
    }
  });
  EXPECT_THAT(d.findings, finds("from row to row as much as over the whole record"));
  EXPECT_TRUE(d.effects.empty());
  EXPECT_EQ(d.verdict, Verdict::unexplained);
}

void scale_times(const RecordedAxis& axis, double factor) {
  std::stringstream read, written;
  read << std::ifstream(axis.file("train.csv")).rdbuf();
  std::string line;
  std::getline(read, line), written << line << '\n';
  while (std::getline(read, line)) {
    const size_t end = line.find(',');
    written << factor * std::stod(line.substr(0, end)) << line.substr(end) << '\n';
  }
  std::ofstream(axis.file("train.csv")) << written.str();
}

TEST(BadRecord, RowsThatAreThousandsOfStepsApartAreRefused) {
  const RecordedAxis axis{Truth{}};
  scale_times(axis, 1e4);
  try {
    diagnose(axis.diagram(), {axis.experiment()});
    FAIL() << "no motion can be followed from one such row to the next";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("steps of the diagram's solver"));
  }
}

TEST(BadRecord, AStiffDiagramOfAnAxisMayHaveShortSteps) {
  Truth truth;
  truth.duration_s = 6;
  const RecordedAxis axis(truth);
  DiagnoseOptions options;
  options.load.set.emplace_back("solver.step", "4e-7");  // 2500 in a row
  EXPECT_EQ(name_of(diagnose(axis.diagram(), {axis.experiment()}, options).verdict), "nothing_missing");
}

TEST(BadRecord, MillisecondsTakenForSecondsAreNoDeadBand) {
  Truth truth;
  truth.duration_s = 6;
  const RecordedAxis axis(truth);
  scale_times(axis, 1e3);
  const Diagnosis d = diagnose(axis.diagram(), {axis.experiment()});
  EXPECT_NE(name_of(d.verdict), "explained") << to_text(d);
  EXPECT_NE(name_of(d.verdict), "nothing_missing") << to_text(d);
  EXPECT_THAT(d.contradictions, Contains(HasSubstr("takes nearly all of the input away"))) << to_text(d);
}

/// What is said of a record with another text in the place of a role.
std::string said_with_role(const std::string& instead) {
  const RecordedAxis axis{Truth{}};
  std::stringstream read;
  read << std::ifstream(axis.experiment()).rdbuf();
  std::string text = read.str();
  const std::string role = R"("velocity": "mass.velocity", )";
  text.replace(text.find(role), role.size(), instead);
  std::ofstream(axis.experiment()) << text;
  try {
    diagnose(axis.diagram(), {axis.experiment()});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(BadRecord, ARoleThatIsNotGivenIsSaid) {
  EXPECT_THAT(said_with_role(""), HasSubstr("no role \"velocity\""));
}

TEST(BadRecord, AVelocityThatIsThePositionIsSaid) {
  EXPECT_THAT(said_with_role(R"("velocity": "mass.position", )"),
              HasSubstr("\"position\" and \"velocity\" lead to one state"));
}

TEST(BadRecord, ColumnsThatAreNotSynchronousAreTold) {
  const Diagnosis d =
      spoilt([](auto& force, auto&) { std::rotate(force.begin(), force.end() - 30, force.end()); });
  EXPECT_THAT(d.findings, finds("fit best when shifted by -"));
}

TEST(BadRecord, TooFewRowsGiveNoVerdict) {
  const Diagnosis d = spoilt([](auto&, auto&) {}, 0.6);
  EXPECT_THAT(d.findings, finds("the machine moves for"));
  EXPECT_TRUE(d.effects.empty());
  EXPECT_EQ(d.verdict, Verdict::unexplained);
}

/// Friction that grows along the way pulls as a spring does, as long as nothing comes back.
TEST(BadRecord, OfOneDirectionASpringMayBeFrictionAlongTheWay) {
  Truth truth;
  truth.force = [](double x, double v, double) { return v > 0 ? 0.5 * x : 0; };
  truth.returns = false, truth.duration_s = 8;
  const RecordedAxis one_way(truth);
  const Diagnosis d = diagnose(one_way.diagram(), {one_way.experiment()});
  EXPECT_THAT(d.findings, Contains(Field(&RecordFinding::cost, HasSubstr("friction that changes along"))))
      << to_text(d);
  truth.force = [](double x, double, double) { return 0.5 * x; };
  truth.returns = true;
  const RecordedAxis both_ways(truth);
  const Diagnosis spring = diagnose(both_ways.diagram(), {both_ways.experiment()});
  EXPECT_EQ(spring.verdict, Verdict::explained) << to_text(spring);
  EXPECT_THAT(spring.findings,
              Not(Contains(Field(&RecordFinding::cost, HasSubstr("friction that changes")))));
}

/// Fewer rows than a window that is simulated has.
TEST(BadRecord, AHandfulOfRowsGivesNoVerdict) {
  FlawedMachine machine;
  machine.sample_time = 0.03, machine.duration = 0.48;
  const FlawedAxis axis(machine);
  const Diagnosis d = diagnose(axis.diagram(), {axis.experiment()});
  EXPECT_EQ(d.verdict, Verdict::unexplained) << to_text(d);
  EXPECT_TRUE(d.effects.empty()) << to_text(d);
  EXPECT_THAT(d.findings, finds("rows that may be fitted"));
}

TEST(BadRecord, OutliersAreCounted) {
  const Diagnosis d = spoilt([](auto&, auto& position) { position[2000] += 1e-3, position[3500] -= 1e-3; });
  EXPECT_THAT(d.findings, finds("2 readings are not those of their rows"));
}

TEST(BadRecord, OldReadingsAreCounted) {
  const Diagnosis d = spoilt([](auto&, auto& position) { position[2000] = position[1999]; });
  EXPECT_THAT(d.findings, finds("1 reading is not that of its row"));
}

TEST(BadRecord, LeapsOfAnyDiagramCountAsMissing) {
  Plant plant = motor({}, 5);
  plant.outputs = [row = 0](const Numbers& x) mutable {
    constexpr double leap_rad = 0.5;
    return Numbers{x[0], ++row % 101 == 0 ? x[1] + leap_rad : x[1]};
  };
  const Diagnosis d = diagnosed(plant);
  EXPECT_EQ(name_of(d.verdict), "nothing_missing") << to_text(d);
  EXPECT_THAT(d.findings, finds("24 readings are not those of their rows"));
}

TEST(BadRecord, LostSamplesAreCountedAndTakenForNoDeadTime) {
  for (const size_t every : {1500, 60}) {
    SCOPED_TRACE(every);
    HiddenMachine machine;
    machine.loses_every = every;
    HiddenAxis axis(machine);
    Physics truth = axis.nominal();
    truth.added_damping_n_s_per_m = 2;
    const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(0.2, 0.4))});
    EXPECT_THAT(names(d), testing::ElementsAre("viscous_friction"));
    EXPECT_EQ(name_of(d.verdict), "explained");
    expect_parameter(d.effects[0], "damping", 2, 0.5, "N*s/m");
    EXPECT_THAT(d.findings, finds("missing at"));
  }
}

auto says(const char* words) { return Contains(HasSubstr(words)); }

TEST(BadRecord, ErrorsThatComeInBurstsAreNotNoise) {
  HiddenMachine machine;
  uint64_t bits = 1;  // a linear congruential generator
  machine.drive = [&](double command, double time) {
    bits = bits * 6364136223846793005u + 1442695040888963407u;
    const double shake = double(bits >> 33) / 2147483648.0 - 0.5;
    return command + (std::fmod(time, 0.13) < 0.012 ? 0.5 * shake : 0.0);
  };
  HiddenAxis axis(machine);
  WantedMotion motion;
  for (int repeat = 0; repeat < 2; ++repeat)
    for (const double speed : {0.1, -0.1, 0.3, -0.3, 0.2, -0.2})
      motion.stroke(std::copysign(0.15, speed), std::abs(speed), 0.1).rest(0.1);
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", axis.nominal(), motion)});
  EXPECT_EQ(d.verdict, Verdict::unexplained) << to_text(d);
  EXPECT_THAT(d.contradictions, says("keep together in time")) << to_text(d);
}

FlawedMachine oscillating(double hz, double sample_time, double duration) {
  FlawedMachine machine;
  machine.oscillation_hz = hz, machine.sample_time = sample_time, machine.duration = duration;
  machine.stroke = 1e-3;
  return machine;
}

/// Sixty reversals a second: dry friction is named as one that is smooth below the lowest speed asked for.
TEST(BadRecord, AParameterAtTheLimitOfItsRangeStandsForSomethingElse) {
  FlawedMachine machine = oscillating(60, 1e-4, 3);
  machine.coulomb = 0.3;
  const FlawedAxis axis(machine);
  const Diagnosis d = diagnose(axis.diagram(), {axis.experiment()});
  const bool is_any_at_limit = std::ranges::any_of(d.effects, [](const DiagnosedEffect& effect) {
    return std::ranges::any_of(effect.parameters, &DiagnosedParameter::at_limit);
  });
  ASSERT_TRUE(is_any_at_limit) << to_text(d);
  EXPECT_EQ(d.verdict, Verdict::partly_explained) << to_text(d);
  EXPECT_THAT(d.contradictions, says("at the limit of its range")) << to_text(d);
}

TEST(BadRecord, OfMotionsThatAreTooShortTheResidualForceIsNotKnown) {
  FlawedMachine machine = oscillating(200, 5e-5, 1);
  machine.added_mass = 0.1;
  const FlawedAxis axis(machine);
  const Diagnosis d = diagnose(axis.diagram(), {axis.experiment()});
  EXPECT_THAT(d.findings, finds("too short for the filter of the residual force")) << to_text(d);
  EXPECT_THAT(d.findings, Not(finds("one way"))) << to_text(d);
  for (const DiagnosisStep& step : d.steps) EXPECT_TRUE(std::isnan(step.force_rmse)) << to_text(d);
}

}  // namespace
}  // namespace loopwright::bad_record_test
