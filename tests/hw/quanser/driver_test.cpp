// The backend on the emulated card: order of calls, every result of a read, every class of error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <fstream>
#include <sys/wait.h>
#include <unistd.h>
#include "hw/device/io_device.h"
#include "hw/quanser/card_in_use.h"
#include "hw/quanser/errors.h"
#include "hw/quanser/library.h"
#include "hw/quanser/quanser.h"
#include "tests/hw/device_file.h"
#include "tests/hw/emulated_card.h"
#include "where.h"

namespace loopwright::hw::driver_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class Quanser : public testing::Test {
 protected:
  /// A device ready to run on the emulated card.
  void make(const std::string& patch = "{}") {
    Problems problems;
    auto description = device_of(patch);
    auto driver = quanser::make_driver(description, problems);
    ASSERT_EQ(problems.text(), "");
    device = std::make_unique<IoDevice>(description, std::move(driver));
  }
  void begin(const std::string& patch = "{}") {
    make(patch);
    ASSERT_EQ(device->open().code, Code::ok);
    ASSERT_EQ(device->preset().code, Code::ok) << device->describe(device->fault());
    ASSERT_EQ(device->start(0.001).code, Code::ok);
  }
  Status cycle(double command = 1) {
    std::array<double, 1> position{};
    if (const Status read = device->read(sample, position); !read.ok()) return read;
    if (const Status written = device->write(std::array{command}); !written.ok()) return written;
    return device->kick();
  }
  Code first_failure(int cycles = 50) {
    for (int i = 0; i < cycles; ++i)
      if (const Status status = cycle(); !status.ok()) return status.code;
    return Code::ok;
  }
  EmulatedCard card{own_emulator_library()};
  std::unique_ptr<IoDevice> device;
  Sample sample;
};

TEST_F(Quanser, CallsComeInTheOrderOfTheVendorsOwnPrograms) {
  begin(R"({"quanser": {"options": "enc0_filter=1;latch_on_adc=1"},
            "inputs": {"current": {"kind": "analog", "channel": 0, "unit": "A", "scale": 1}, "position": {"filter": 1e6}}})");
  cycle(), cycle();
  device->stop();
  device->close();
  EXPECT_THAT(
      card.calls(),
      ElementsAre("hil_open", "hil_set_card_specific_options", "hil_watchdog_clear",
                  "hil_set_analog_input_ranges", "hil_set_analog_output_ranges", "hil_write_analog",
                  "hil_watchdog_set_analog_expiration_state", "hil_set_analog_termination_state",
                  "hil_set_encoder_quadrature_mode", "hil_set_encoder_filter_frequency",
                  "hil_set_encoder_counts", "hil_task_create_reader", "hil_task_set_buffer_overflow_mode",
                  "hil_task_start", "hil_watchdog_start",                      // before the first command
                  "hil_task_read", "hil_write_analog", "hil_watchdog_reload",  // two samples that agree
                  "hil_task_read", "hil_write_analog", "hil_watchdog_reload",  //
                  "hil_task_read", "hil_write_analog", "hil_watchdog_reload",  //
                  "hil_write_analog", "hil_task_stop", "hil_write_analog", "hil_write_termination_states",
                  "hil_watchdog_stop", "hil_task_delete", "hil_close"));
}

TEST_F(Quanser, OptionsArriveByteForByteWithTheirFinalZero) {
  begin(R"({"quanser": {"options": "enc0_filter=1;latch_on_adc=1"}})");
  EXPECT_EQ(card.options(), std::pair(std::string("enc0_filter=1;latch_on_adc=1"), 29));
}

TEST_F(Quanser, PositionsComeInMetresAndPresetsCount) {
  card.set("plant.position", 0.1);
  begin(R"({"inputs": {"position": {"preset": 1000, "offset": 0.5}}})");
  std::array<double, 1> position{};
  ASSERT_TRUE(device->read(sample, position).ok());
  EXPECT_NEAR(position[0], 0.5 + 1000 * 2e-7, 3e-6) << "cogging moves the motor by some counts";
}

TEST_F(Quanser, AStoppedTaskIsNoErrorAndNoEndlessLoop) {
  begin();
  EXPECT_TRUE(cycle().ok());
  device->request_stop();
  EXPECT_EQ(cycle().code, Code::stopped);
  EXPECT_EQ(device->stop(), OutputsSafe::confirmed);
}

TEST_F(Quanser, EveryClassOfErrorIsReached) {
  const struct {
    double code;
    Code status;
  } errors[] = {{111, Code::device_fault},  {843, Code::disconnected}, {1160, Code::disconnected},
                {1029, Code::disconnected}, {108, Code::disconnected}, {35, Code::stopped},
                {145, Code::busy},          {487, Code::unsupported},  {121, Code::config_error},
                {1202, Code::device_fault}, {986, Code::no_driver}};
  for (const auto& [code, status] : errors) {
    SCOPED_TRACE(code);
    card.set("reset", 0);
    begin();
    card.set("fault.read.from", 3), card.set("fault.read.code", code);
    EXPECT_EQ(first_failure(), status);
    device->stop(), device->close();
  }
}

TEST_F(Quanser, OpeningTellsWhyItCannot) {
  make(R"({"quanser": {"board": "nothing"}})");
  const Status unknown = device->open();
  EXPECT_EQ(unknown.code, Code::no_driver);
  EXPECT_THAT(device->describe(unknown), AllOf(HasSubstr("-179"), HasSubstr("UNRECOGNIZED_BOARD_TYPE")));
  make(R"({"quanser": {"identifier": "3"}})");
  EXPECT_EQ(device->open().code, Code::no_driver) << "no board";
}

TEST_F(Quanser, ACardInUseIsRefusedAndNothingOfItTouched) {
  begin();
  cycle(3);
  auto first = std::move(device);
  const size_t calls = card.calls().size();
  make();
  const Status status = device->open();
  EXPECT_EQ(status.code, Code::busy);
  EXPECT_THAT(device->describe(status),
              AllOf(HasSubstr("the device is in use: card qpid_e 0 (-1073, BOARD_ALREADY_OPEN)"),
                    HasSubstr("Nothing of it was touched"), HasSubstr("--take-over")));
  device->stop(), device->close();
  EXPECT_EQ(card.calls().size(), calls + 1) << "hil_open alone";
  device = std::move(first);
  EXPECT_EQ(first_failure(20), Code::ok) << "the first goes on";
  EXPECT_EQ(device->stop(), OutputsSafe::confirmed);
}

TEST_F(Quanser, ACardInUseIsTakenOverWhereThatIsAskedFor) {
  begin();
  auto first = std::move(device);
  make();
  ASSERT_EQ(device->open().code, Code::busy);
  EXPECT_TRUE(device->take_over().ok());
  ASSERT_EQ(device->preset().code, Code::ok);
  ASSERT_EQ(device->start(0.001).code, Code::ok);
  EXPECT_EQ(first_failure(5), Code::ok);
}

TEST_F(Quanser, NamesAreGivenOfProcessesThatHaveTheLibraryLoaded) {
  int to_child[2];
  ASSERT_EQ(pipe(to_child), 0);
  const pid_t child = fork();
  if (child == 0) {  // has loaded the library in this process
    close(to_child[1]);
    char ignored;
    [[maybe_unused]] const ssize_t end = ::read(to_child[0], &ignored, 1);
    _exit(0);
  }
  close(to_child[0]);
  const auto processes = quanser::processes_with(own_emulator_library());
  close(to_child[1]);
  waitpid(child, nullptr, 0);
  EXPECT_THAT(processes, testing::Contains(HasSubstr(std::to_string(child) + " (")));
  EXPECT_THAT(processes, testing::Not(testing::Contains(HasSubstr(std::to_string(getpid()) + " ("))));
  EXPECT_THAT(quanser::processes_with("/nowhere/libhil.so"), ElementsAre());
}

TEST_F(Quanser, WhatTheCardLacksIsAnErrorOnlyWhereItWasAskedFor) {
  for (const char* refusal :
       {"refuses.ranges", "refuses.termination", "refuses.overflow_mode", "refuses.filter"}) {
    card.set("reset", 0), card.set(refusal, 1);
    begin();
    EXPECT_EQ(first_failure(5), Code::ok) << refusal;
    device->stop(), device->close();
  }
  card.set("reset", 0), card.set("refuses.ranges", 1);
  make(R"({"outputs": {"drive": {"low": -5, "high": 5}}})");
  device->open();
  EXPECT_EQ(device->preset().code, Code::unsupported);
  card.set("reset", 0), card.set("refuses.watchdog", 1);
  make();
  device->open();
  EXPECT_EQ(device->preset().code, Code::unsupported);
  make(R"({"watchdog": {"timeout": 0}})");
  device->open();
  EXPECT_EQ(device->preset().code, Code::ok);
}

TEST_F(Quanser, AnOverflowIsAFaultOrCountsAsLostSamples) {
  begin();
  cycle();
  card.set("stall.at", 2), card.set("stall.seconds", 0.0045);
  EXPECT_EQ(first_failure(), Code::device_fault);
  EXPECT_EQ(device->fault().native, -111);
  card.set("reset", 0);
  begin(R"({"clock": {"buffer": 1, "overflow": "overwrite"}, "watchdog": {"timeout": 0.1}})");
  card.set("stall.at", 3), card.set("stall.seconds", 0.0045);
  int64_t lost = 0;
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(cycle().ok());
    lost += sample.lost;
  }
  EXPECT_EQ(lost, 3) << "of four samples during the stall the newest is kept";
}

TEST_F(Quanser, AnExpiredWatchdogLatchesAndIsReported) {
  begin();
  EXPECT_EQ(first_failure(3), Code::ok);
  card.set("advance", 0.0125);
  EXPECT_EQ(card.get("dac.0"), 0) << "the expiry value";
  EXPECT_TRUE(latches(first_failure()));
  EXPECT_EQ(device->stop(), OutputsSafe::by_watchdog);
}

TEST_F(Quanser, AnExpiredWatchdogIsSeenWhereWritesAreIgnoredInSilence) {
  card.set("watchdog.write_error", 0);
  begin(R"({"clock": {"buffer": 100}})");
  first_failure(3);
  card.set("advance", 0.0125);
  EXPECT_EQ(first_failure(), Code::watchdog);
  EXPECT_EQ(device->stop(), OutputsSafe::by_watchdog);
  EXPECT_TRUE(device->rearm().ok());
  EXPECT_EQ(card.get("watchdog.expired"), 0);
}

TEST_F(Quanser, AnUnpluggedCardLeavesItsOutputsUnknown) {
  begin();
  card.set("unplug.at", 20);
  EXPECT_EQ(first_failure(), Code::disconnected);
  EXPECT_EQ(device->stop(), OutputsSafe::unknown);
  device->close();
}

TEST_F(Quanser, TheComputersClockNeedsNoTask) {
  begin(R"({"clock": {"source": "host"}})");
  EXPECT_FALSE(device->capabilities().is_clock);
  EXPECT_TRUE(cycle().ok());
  const auto calls = card.calls();
  EXPECT_EQ(std::ranges::count(calls, "hil_task_create_reader"), 0);
  EXPECT_EQ(std::ranges::count(calls, "hil_read_encoder"), 2) << "two readings that agree";
}

// ---- libraries ----

TEST_F(Quanser, ALibraryWithNothingButTheNeedfulServesADeviceThatAsksForNoMore) {
  EmulatedCard old(emulator_library("hil_emulator_required"));
  begin(R"({"watchdog": {"timeout": 0}})");
  EXPECT_EQ(first_failure(5), Code::ok);
  EXPECT_EQ(device->stop(), OutputsSafe::confirmed);
  make();
  device->close(), device->open();
  EXPECT_EQ(device->preset().code, Code::unsupported) << "a watchdog was asked for";
}

std::string library_problem(const std::string& path) {
  setenv("HIL_LIBRARY", path.c_str(), 1);
  Problems problems;
  EXPECT_EQ(quanser::make_driver(device_of(), problems), nullptr);
  return problems.text();
}

TEST_F(Quanser, AMissingFunctionIsNamed) {
  EXPECT_THAT(library_problem(emulator_library("hil_emulator_broken")),
              AllOf(HasSubstr("lacks functions"), HasSubstr("hil_task_read")));
}

TEST_F(Quanser, WhichLibraryWouldBeLoadedIsToldBeforeItsCodeRuns) {
  setenv("HIL_LIBRARY", "/opt/own/libhil.so", 1);
  EXPECT_THAT(
      foreign_code_of(*device_of()),
      HasSubstr("device.json: its driver loads and runs the code of /opt/own/libhil.so (HIL_LIBRARY)"));
  unsetenv("HIL_LIBRARY");
  EXPECT_THAT(foreign_code_of(*device_of(R"({"quanser": {"library": "./mine.so"}})")),
              AllOf(HasSubstr("/mine.so (\"library\" in the device file)")));
  EXPECT_THAT(foreign_code_of(*device_of()), HasSubstr("the first that is there of libhil.so.1, "));
}

TEST_F(Quanser, NoLibraryIsToldWithWhatWasTried) {
  EXPECT_THAT(library_problem("/nowhere/libhil.so"),
              AllOf(HasSubstr("/nowhere/libhil.so"), HasSubstr("HIL_LIBRARY")));
}

TEST_F(Quanser, ALibraryForAnotherProcessorIsToldAsThat) {
  DiagramFolder folder;
  std::ifstream good(emulator_library(), std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(good)), {});
  bytes[18] = char(183), bytes[19] = 0;  // e_machine: AArch64
  folder.with("libhil.so", bytes);
  EXPECT_THAT(library_problem(folder.path("libhil.so")), HasSubstr("another processor"));
  folder.with("libhil.so", "no library at all, but a text that is long enough to have a header");
  EXPECT_THAT(library_problem(folder.path("libhil.so")), HasSubstr("no shared library"));
}

TEST_F(Quanser, EveryFunctionOfTheTableIsInTheEmulator) {
  quanser::Library library;
  quanser::LibraryProblem problem;
  ASSERT_TRUE(quanser::load_library("", library, problem)) << problem.message;
  EXPECT_THAT(library.missing, ElementsAre());
}

TEST_F(Quanser, NothingOfTheEmulatorsSideChannelIsKnownToTheBackend) {
  std::ifstream archive(LOOPWRIGHT_BINARY "/hw/libloopwright_quanser.a", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(archive)), {});
  ASSERT_GT(bytes.size(), 1000u);
  EXPECT_EQ(bytes.find("hil_emu"), bytes.npos);
}

TEST(QuanserErrors, NamesAreThoseOfTheVendor) {
  EXPECT_EQ(quanser::error_name(-111), "BUFFER_OVERFLOW");
  EXPECT_EQ(quanser::error_name(1160), "DEVICE_DISCONNECTED");
  EXPECT_EQ(quanser::error_name(-99999), "");
}

}  // namespace
}  // namespace loopwright::hw::driver_test
