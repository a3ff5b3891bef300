// The complete workflow with the program: deploy on a motor with hidden dry friction, find it in the log,
// simulate with it, learn a compensation from the same log, deploy again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <nlohmann/json.hpp>
#include "engine/record/recording_file.h"
#include "tests/hw/emulated_card.h"
#include "tests/tools/command/program.h"
#include "where.h"

namespace loopwright::circle_test {
namespace {

const std::string root = LOOPWRIGHT_SOURCE;

class Circle : public testing::Test {
 protected:
  void SetUp() override {
    setenv("HIL_LIBRARY", hw::emulator_library().c_str(), 1);
    setenv("HIL_EMU", (root + "/hw/emulator/hidden_friction.json").c_str(), 1);
    setenv("LOOPWRIGHT_DATA", folder_.path("").c_str(), 1);
  }
  void TearDown() override { unsetenv("HIL_EMU"), unsetenv("LOOPWRIGHT_DATA"); }

  Outcome deploy(const std::string& diagram, const std::string& log,
                 const std::vector<std::string>& changes = {}) {
    std::vector<std::string> arguments{
        "deploy",    root + "/diagrams/" + diagram,
        "--variant", "stage=quanser",
        "--set",     "stage.device=" + root + "/hw/devices/qpid_e_emulated.json",
        "-o",        folder_.path(log)};
    for (const std::string& change : changes) arguments.insert(arguments.end(), {"--set", change});
    return loopwright_program(arguments);
  }
  /// The missing force in identification.csv, by `compare`.
  double missing_force(const std::vector<std::string>& changes,
                       const std::string& diagram = "identification.json") {
    std::vector<std::string> arguments{"compare", root + "/diagrams/linear_motor/" + diagram,
                                       root + "/diagrams/circle/deployed.experiment.json", "--json", "-"};
    for (const std::string& change : changes) arguments.insert(arguments.end(), {"--set", change});
    const Outcome outcome = loopwright_program(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out).at("force_residual").at("rmse");
  }
  double tracking_error(const std::string& log) {
    Problems problems;
    const Recording recording = read_recording(folder_.path(log), problems);
    EXPECT_EQ(problems.text(), "");
    double sum = 0;
    for (double e : recording.find("error.sum")->values) sum += e * e;
    return std::sqrt(sum / double(recording.rows()));
  }
  DiagramFolder folder_;
};

TEST_F(Circle, AWrongParameterOfTheDeviceShowsInTheComparison) {
  std::vector<double> missing;
  for (const char* card : {"{}", R"({"plant.mass": 0.3})", R"({"plant.damping": 3.5})",
                           R"({"plant.cogging": 1.2})", R"({"encoder.scale": 1.02})"}) {
    folder_.with("card.json", card);
    setenv("HIL_EMU", folder_.path("card.json").c_str(), 1);
    ASSERT_EQ(deploy("linear_motor/conventional.json", "identification.csv").code, 0);
    missing.push_back(missing_force({}, "conventional.json"));
    if (missing.size() > 1) {
      EXPECT_GT(missing.back(), 1.3 * missing.front()) << card;
    }
  }
  EXPECT_LT(missing.front(), 0.04) << "[V]: of the right model nothing is left but counts of the encoder";
}

TEST_F(Circle, TheDiagnosisOfALogNamesTheHiddenFrictionAndTheImprovedDiagramHasIt) {
  ASSERT_EQ(deploy("linear_motor/identification.json", "identification.csv", {"solver.stop=14"}).code, 0);
  const std::string diagram = root + "/diagrams/linear_motor/identification.json";
  const std::string experiment = root + "/diagrams/circle/deployed.experiment.json";
  const std::string improved = folder_.path("improved.json");
  Outcome outcome = loopwright_program({"diagnose", diagram, experiment, "--json", "-", "-o", improved});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto effects = nlohmann::json::parse(outcome.out).at("effects");
  ASSERT_FALSE(effects.empty()) << outcome.err;
  EXPECT_EQ(effects[0]["effect"], "coulomb_friction") << outcome.err;
  EXPECT_NEAR(effects[0]["parameters"]["level"]["value"], 0.4, 0.02) << "what hidden_friction.json hides";

  const double before = missing_force({});
  outcome = loopwright_program({"compare", improved, experiment, "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_LT(nlohmann::json::parse(outcome.out).at("force_residual").at("rmse"), 0.2 * before);
  // Only the simulated stage was improved: the same diagram is deployed as before.
  outcome = loopwright_program({"check", improved, "--variant", "stage=quanser", "--set",
                                "stage.device=" + root + "/hw/devices/qpid_e_emulated.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST_F(Circle, TheLogNamesWhatIsMissingAndTeachesTheCompensation) {
  Outcome outcome = deploy("linear_motor/identification.json", "identification.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.err;

  const double before = missing_force({});
  const double with_damping = missing_force({"stage.motor.damping=3.5 N*s/m"});
  const double with_offset = missing_force({"stage.motor.offset=0.4 N"});
  const double with_friction =
      missing_force({"stage.motor.coulomb=0.4 N", "stage.motor.transition_speed=0.001 m/s"});
  EXPECT_LT(with_friction, 0.5 * before);
  EXPECT_LT(with_friction, 0.6 * std::min(with_damping, with_offset)) << "the other suspects explain less";

  outcome = loopwright_program({"gp", "train", root + "/diagrams/circle/deployed.training.json", "--set",
                                "recordings=[\"" + folder_.path("identification.csv") + "\"]", "--model",
                                folder_.path("learned.model.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  outcome = deploy("linear_motor/conventional.json", "conventional.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  outcome = deploy("linear_motor/ps.json", "compensated.csv",
                   {"model=" + folder_.path("learned.model.json"), "compensation.lead=2.6 ms"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_LT(tracking_error("compensated.csv"), 0.5 * tracking_error("conventional.csv"));
}

}  // namespace
}  // namespace loopwright::circle_test
