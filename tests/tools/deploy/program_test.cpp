// The program on the emulated card, used like by a person: signals, a killed controller, exit codes, output
// files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <nlohmann/json.hpp>
#include <thread>
#include "tests/hw/card_daemon.h"
#include "tests/hw/device_file.h"
#include "tests/hw/emulated_card.h"
#include "tests/tools/command/program.h"
#include "where.h"

namespace loopwright::program_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using namespace std::chrono_literals;

const std::string conventional = LOOPWRIGHT_SOURCE "/diagrams/linear_motor/conventional.json";

class DeployProgram : public testing::Test {
 protected:
  void SetUp() override {
    setenv("HIL_LIBRARY", hw::own_emulator_library().c_str(), 1);
    unsetenv("HIL_EMU"), unsetenv("HIL_EMU_SHARED");
  }
  void TearDown() override { unsetenv("HIL_EMU"), unsetenv("HIL_EMU_SHARED"); }
  /// A device file, and the settings of the emulated card.
  void files(const std::string& device_patch, const std::string& card) {
    folder_.with("device.json", hw::device_text(device_patch)).with("card.json", card);
    setenv("HIL_EMU", folder_.path("card.json").c_str(), 1);
  }
  std::vector<std::string> arguments(std::vector<std::string> more = {}) {
    std::vector<std::string> all{"deploy",        conventional, "--variant",
                                 "stage=quanser", "--set",      "stage.device=" + folder_.path("device.json"),
                                 "--priority",    "0"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  nlohmann::json figures() { return nlohmann::json::parse(text_of(folder_.path("figures.json"))); }
  static bool wait_for(const std::function<bool()>& what) {
    for (int i = 0; i < 1000; ++i) {
      if (what()) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }
  DiagramFolder folder_;
};

const std::string in_virtual_time = R"({"clock": {"time": "simulated"}})";
/// For a busy computer: late commands are only counted, and the watchdog has a long timeout.
const std::string patient =
    R"({"clock": {"buffer": 1, "overflow": "overwrite"}, "policy": {"on_overrun": "count", "on_lost": "count"}, "watchdog": {"timeout": 0.4}})";

TEST_F(DeployProgram, MovesTheStageAndWritesLogPageAndFigures) {
  files(in_virtual_time, "{}");
  const Outcome outcome =
      loopwright_program(arguments({"-o", folder_.path("log.csv"), "--report", folder_.path("page.html"),
                                    "--json", folder_.path("figures.json")}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(figures().at("outputs_safe"), "confirmed");
  EXPECT_EQ(figures().at("cycles"), 3101);
  EXPECT_THAT(text_of(folder_.path("page.html")),
              AllOf(HasSubstr("Outputs safe"), HasSubstr("From sample to command")));
  const Outcome replayed = loopwright_program({"run", conventional, "--variant", "stage=quanser", "--set",
                                               "stage.device=" + folder_.path("device.json"), "--replay",
                                               folder_.path("log.csv")});
  EXPECT_EQ(replayed.code, 0) << replayed.err;
  EXPECT_THAT(replayed.out, HasSubstr("explain each other"));
}

TEST_F(DeployProgram, ASignalEndsItWithTheOutputsSafe) {
  files(patient, R"({"real_time": 1})");
  for (const int signal : {SIGINT, SIGTERM}) {
    Program program(arguments(
        {"--set", "solver.stop=30", "--json", folder_.path("figures.json"), "-o", folder_.path("log.csv")}));
    ASSERT_TRUE(wait_for([&] { return contains(program.err(), "deploy "); })) << "it shows how it goes";
    program.send(signal);
    const Outcome outcome = program.wait();
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_EQ(figures().at("outputs_safe"), "confirmed");
    EXPECT_EQ(figures().at("status"), "interrupted");
    EXPECT_GT(text_of(folder_.path("log.csv")).size(), 1000u) << "what was recorded is kept";
  }
}

TEST_F(DeployProgram, AnUnpluggedCardIsExitCodeOneAndUnknown) {
  files(in_virtual_time, R"({"unplug.at": 1500})");
  const Outcome outcome = loopwright_program(arguments({"--json", "-"}));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("\"outputs_safe\": \"unknown\""));
  EXPECT_THAT(outcome.err, HasSubstr("did not confirm its safe values"));
  EXPECT_THAT(outcome.err, HasSubstr("-1160, DEVICE_DISCONNECTED"));
}

TEST_F(DeployProgram, AKilledControllerLeavesTheOutputsToTheWatchdog) {
  files(patient, R"({"plant.cogging": 0, "plant.tilt": 0.2})");
  unsetenv("HIL_EMU");
  hw::CardDaemon card(folder_.path("world"), folder_.path("card.json"));
  setenv("HIL_EMU_SHARED", folder_.path("world").c_str(), 1);
  Program program(arguments());
  ASSERT_TRUE(wait_for([&] { return card.get("watchdog.armed") == 1 && card.get("dac.0") != 0; }))
      << "the motor is held against its weight";
  program.send(SIGKILL);
  EXPECT_EQ(program.wait().code, 128 + SIGKILL);
  const double killed = card.get("time");
  ASSERT_TRUE(wait_for([&] { return card.get("watchdog.expired") == 1; }));
  EXPECT_EQ(card.get("dac.0"), 0);
  EXPECT_LE(card.get("watchdog.expired_at"), killed + 0.4);
  unsetenv("HIL_EMU_SHARED");
}

TEST_F(DeployProgram, ASecondDeployOfACardInUseTouchesNothingAndTheFirstGoesOn) {
  files(patient, "{}");
  unsetenv("HIL_EMU");
  hw::CardDaemon card(folder_.path("world"), folder_.path("card.json"));
  setenv("HIL_EMU_SHARED", folder_.path("world").c_str(), 1);
  Program first(arguments({"--json", folder_.path("figures.json"), "-o", folder_.path("log.csv")}));
  ASSERT_TRUE(wait_for([&] { return card.get("watchdog.armed") == 1; }));
  const Outcome second = loopwright_program(arguments({"-o", folder_.path("second.csv")}));
  EXPECT_EQ(second.code, 1);
  EXPECT_THAT(second.err,
              AllOf(HasSubstr("the device is in use: card qpid_e 0 (-1073, BOARD_ALREADY_OPEN). "
                              "Nothing of it was touched. The vendor's library is loaded in process "),
                    HasSubstr("loopwright deploy"), HasSubstr("end that one first")));
  const Outcome unasked = loopwright_program(arguments({"--take-over"}));
  EXPECT_EQ(unasked.code, 1) << "there is no terminal to ask on";
  EXPECT_THAT(unasked.err, AllOf(HasSubstr("closes every card"), HasSubstr("--yes answers it")));
  const Outcome probed = loopwright_program({"probe", folder_.path("device.json"), "--touch"});
  EXPECT_EQ(probed.code, 1);
  EXPECT_THAT(probed.out, HasSubstr("in use: card qpid_e 0"));
  const Outcome outcome = first.wait();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(figures().at("status"), "finished");
  EXPECT_EQ(figures().at("outputs_safe"), "confirmed");
  EXPECT_GE(int(figures().at("cycles")) + int(figures().at("lost_samples")), 3101)
      << "every instant of the run";
}

TEST_F(DeployProgram, TakingOverEndsTheOtherProgramWhereSomebodyAgreed) {
  files(patient, "{}");
  unsetenv("HIL_EMU");
  hw::CardDaemon card(folder_.path("world"), folder_.path("card.json"));
  setenv("HIL_EMU_SHARED", folder_.path("world").c_str(), 1);
  Program first(arguments({"--set", "solver.stop=60"}));
  ASSERT_TRUE(wait_for([&] { return card.get("watchdog.armed") == 1; }));
  const Outcome second = loopwright_program(arguments({"--take-over", "--yes", "--set", "solver.stop=0.2"}));
  EXPECT_EQ(second.code, 0) << second.err;
  EXPECT_THAT(second.err, HasSubstr("ends in the middle of its motion"));
  EXPECT_EQ(first.wait().code, 1);
}

TEST_F(DeployProgram, ACardLeftOpenByAKilledProgramIsToldFromOneInUse) {
  files(patient, "{}");
  unsetenv("HIL_EMU");
  hw::CardDaemon card(folder_.path("world"), folder_.path("card.json"));
  setenv("HIL_EMU_SHARED", folder_.path("world").c_str(), 1);
  Program killed(arguments());
  ASSERT_TRUE(wait_for([&] { return card.get("watchdog.armed") == 1; }));
  killed.send(SIGKILL);
  killed.wait();
  const Outcome second = loopwright_program(arguments());
  EXPECT_EQ(second.code, 1);
  EXPECT_THAT(second.err,
              AllOf(HasSubstr("No other process that can be seen has the vendor's library loaded"),
                    HasSubstr("--take-over opens it")));
}

TEST_F(DeployProgram, CheckProbeAndDeployNameTheCodeThatADeviceFileLoads) {
  files(in_virtual_time, "{}");
  const Outcome checked = loopwright_program({"check", conventional, "--variant", "stage=quanser", "--set",
                                              "stage.device=" + folder_.path("device.json")});
  EXPECT_EQ(checked.code, 0);
  const std::string named = "loads and runs the code of " + hw::own_emulator_library() + " (HIL_LIBRARY)";
  EXPECT_THAT(checked.out, AllOf(HasSubstr(named), HasSubstr("check does not load it")));
  const Outcome deployed = loopwright_program(arguments());
  EXPECT_LT(deployed.err.find(named), deployed.err.find("library " + hw::own_emulator_library()));
  EXPECT_THAT(loopwright_program({"probe", folder_.path("device.json")}).out, HasSubstr(named));
  setenv("HIL_LIBRARY", "/nowhere/libhil.so", 1);
  EXPECT_THAT(loopwright_program(arguments({"-q"})).err, HasSubstr("the code of /nowhere/libhil.so"));
}

TEST_F(DeployProgram, WrongInputIsExitCodeTwoBeforeAnythingMoves) {
  files(R"({"outputs": {"drive": {"safe": null}}})", "{}");
  Outcome outcome = loopwright_program(arguments());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("device.json:"), HasSubstr("\"safe\" is missing")));
  outcome = loopwright_program({"deploy", conventional});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--variant stage=quanser"));
  files("{}", "{}");
  setenv("HIL_LIBRARY", "/nowhere/libhil.so", 1);
  outcome = loopwright_program(arguments());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("/nowhere/libhil.so"));
}

TEST_F(DeployProgram, APipeOrOneFileForTwoResultsIsRefusedBeforeAnythingMoves) {
  files(in_virtual_time, "{}");
  ASSERT_EQ(mkfifo(folder_.path("pipe.csv").c_str(), 0600), 0);
  for (const char* option : {"-o", "--report", "--json"}) {
    const Outcome outcome = loopwright_program(arguments({option, folder_.path("pipe.csv")}));
    EXPECT_EQ(outcome.code, 2) << option;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(option), HasSubstr("does not write to a pipe")));
  }
  const std::string path = folder_.path("log.csv"), again = folder_.path("./log.csv");
  for (const auto& two : {std::array{"-o", "--json"}, {"-o", "--report"}, {"--report", "--json"}}) {
    const Outcome outcome = loopwright_program(arguments({two[0], path, two[1], again}));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(two[0]), HasSubstr(two[1]), HasSubstr("name the same file")));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(DeployProgram, ASimulationOpensNoDeviceAndSaysSo) {
  setenv("HIL_LIBRARY", "/nowhere/libhil.so", 1);
  for (const char* what : {"check", "plan", "run"}) {
    const Outcome outcome = loopwright_program({what, conventional, "--variant", "stage=quanser"});
    EXPECT_EQ(outcome.code, 0) << what << outcome.err;
    EXPECT_EQ(contains(outcome.err, "stands still"), std::string(what) == "run");
  }
}

TEST_F(DeployProgram, TheProbeAnswersWhatOnlyTheMachineKnows) {
  files("{}", R"({"real_time": 1, "watchdog.zero_only": 1, "plant.cogging": 0, "plant.cogging_2": 0})");
  const Outcome outcome = loopwright_program({"probe", folder_.path("device.json"), "--touch"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("SCHED_FIFO"), HasSubstr("driver of the qpid_e: there is one"),
                    HasSubstr("preset of 8388608: -8388608"), HasSubstr("watchdog of 1 s: -151"),
                    HasSubstr("expiry value of 1 V: -601"), HasSubstr("a write after expiry: -1202")));
  setenv("HIL_LIBRARY", "/nowhere/libhil.so", 1);
  EXPECT_EQ(loopwright_program({"probe"}).code, 1);
}

}  // namespace
}  // namespace loopwright::program_test
