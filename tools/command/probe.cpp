#include <fmt/format.h>
#include "hw/drivers.h"
#include "hw/quanser/library.h"
#include "hw/quanser/probe.h"
#include "hw/realtime/system.h"
#include "tools/command/command.h"
#include "tools/command/take_over.h"

namespace loopwright {
namespace {

struct ProbeArguments {
  std::string device;
  bool may_touch = false;
  TakeOver take_over;
};

hw::quanser::Settings settings_of(const std::string& path) {
  if (path.empty()) return {};
  Problems problems;
  const auto device = hw::load_device(path, {}, problems);
  if (!device) throw InputError(std::move(problems));
  if (device->driver == "quanser") return hw::quanser::read_settings(*device, problems);
  problems.error(device->place, "/driver", "", "devices of this driver cannot be probed").expected =
      "\"quanser\"";
  throw InputError(std::move(problems));
}

int run(const ProbeArguments& a) {
  const auto settings = settings_of(a.device);
  answer("real-time service\n");
  hw::SystemReport system;
  {
    const hw::RealTimeProcess process({}, system);
    hw::make_thread_real_time({}, system);
  }
  answer("{}device\n  loads and runs the code of {}\n", hw::to_text(system),
         hw::quanser::library_to_load(settings.library));
  std::fflush(stdout);  // before that code runs
  const auto may_take_over = [&](const std::string& who) {
    return agrees(a.take_over, "in use: " + who, hw::quanser::what_taking_over_does);
  };
  bool is_good = true;
  take_time_after_interruption();  // the card is closed
  for (const hw::quanser::ProbeAnswer& given : hw::quanser::probe(settings, a.may_touch, may_take_over)) {
    answer("  {} {}: {}\n", given.is_good ? "+" : "-", given.question, given.answer);
    is_good &= given.is_good;
  }
  return is_good ? done : run_failed;
}

}  // namespace

void add_probe(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("probe", "Say what hardware and real-time service there is");
  auto a = std::make_shared<ProbeArguments>();
  command->add_option("device", a->device, "Device file (JSON); a QPIDe when left out");
  command->add_flag("--touch", a->may_touch,
                    "Set the card up too: presets encoder 0, puts out 0 V, lets the watchdog expire. "
                    "Disconnect the motor first");
  add_take_over(*command, a->take_over);
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright
