#include "hw/realtime/axes.h"
#include <fmt/format.h>

namespace loopwright::hw {
namespace {

void check_unit(const Plan::Block& block, std::string_view port, const std::optional<Unit>& in_diagram,
                const std::string& channel, const std::string& of_channel, Problems& problems) {
  const auto in_device = parse_unit(of_channel);
  if (!in_diagram || !in_device || in_diagram->fits(*in_device)) return;
  auto& p = problems.error(block.place, "", block.path,
                           fmt::format("\"{}\" and the device's \"{}\" differ in unit", port, channel));
  p.expected = of_channel + " as the device file says";
  p.found = to_string(*in_diagram) + " in the diagram";
}

void check_units(const Plan& plan, const Axis& axis, Problems& problems) {
  const Plan::Block& block = plan.blocks[size_t(axis.block)];
  const DeviceDescription& device = *axis.io->device;
  const InputChannel& position = device.inputs[size_t(axis.io->position_channel)];
  const OutputChannel& command = device.outputs[size_t(axis.io->command_channel)];
  check_unit(block, "position", block.output_units[0], position.name, position.unit, problems);
  check_unit(block, "command", plan.unit_of(axis.command), command.name, command.unit, problems);
  if (axis.io->velocity_channel < 0) return;
  const InputChannel& velocity = device.inputs[size_t(axis.io->velocity_channel)];
  check_unit(block, "velocity", block.output_units[1], velocity.name, velocity.unit, problems);
}

void check_shared(const Plan& plan, const Hardware& hardware, const Axis& axis, Problems& problems) {
  const Plan::Block& block = plan.blocks[size_t(axis.block)];
  const auto error = [&](std::string message) -> Problem& {
    return problems.error(block.place, "", block.path, std::move(message));
  };
  if (axis.io->device->path != hardware.device->path)
    error("a diagram is deployed on one device").found =
        fmt::format("{} and {}", hardware.device->path, axis.io->device->path);
  if (block.period != hardware.period_ticks || block.offset != 0)
    error("all axes of a device are sampled together").expected =
        fmt::format("sample_time {:g} s, no offset", hardware.period_s);
  for (const Axis& other : hardware.axes)
    if (other.io->command_channel == axis.io->command_channel)
      error(fmt::format("\"{}\" commands the same output of the device", other.path));
}

/// The loop steps from one sample to the next, from the start on. Between samples the blocks of the axes
/// would not be due, and every measurement would be used a period too late.
void check_start(const Plan& plan, const Hardware& hardware, Problems& problems) {
  if (plan.start_tick % hardware.period_ticks == 0) return;
  auto& p = problems.error(plan.solver_place, plan.solver_place.pointer(), "",
                           "a loop on hardware begins with a sample");
  p.expected = fmt::format("a start that is a multiple of the sample_time of {:g} s", hardware.period_s);
  p.found = fmt::format("{:g} s", plan.clock.time(plan.start_tick));
}

/// The watchdog is reloaded once a sample: with less than two periods a sample that is a little late lets it
/// expire.
void check_watchdog(const Hardware& hardware, Problems& problems) {
  const DeviceDescription& device = *hardware.device;
  const double timeout = device.watchdog.timeout;
  if (timeout == 0 || timeout >= 2 * hardware.period_s) return;
  auto& p =
      problems.error(device.place, "/watchdog/timeout", "", "the watchdog would expire between two commands");
  p.expected =
      fmt::format("at least two periods of {:g} s; ten leave room for late samples", hardware.period_s);
  p.found = fmt::format("{:g} s", timeout);
}

}  // namespace

Hardware find_hardware(const Plan& plan, Problems& problems) {
  Hardware hardware;
  for (size_t b = 0; b < plan.blocks.size(); ++b) {
    const Plan::Block& block = plan.blocks[b];
    if (block.type->info.type != "HardwareIo") continue;
    const Axis axis{int(b), block.path, static_cast<const blocks::HardwareIo*>(block.value.get()),
                    block.inputs[0][0]};
    if (hardware.axes.empty())
      hardware.device = axis.io->device, hardware.period_ticks = block.period,
      hardware.period_s = block.sample_time;
    check_shared(plan, hardware, axis, problems);
    check_units(plan, axis, problems);
    hardware.axes.push_back(axis);
  }
  if (!hardware.axes.empty()) check_start(plan, hardware, problems), check_watchdog(hardware, problems);
  if (!hardware.axes.empty() && plan.states > 0 && !is_fixed_step(plan.method)) {
    auto& p = problems.error(plan.solver_place, plan.solver_place.pointer(), "",
                             "a loop on hardware needs steps whose length is known beforehand");
    p.expected = "euler, heun or rk4";
    p.found = std::string(to_name(plan.method));
  }
  return hardware;
}

}  // namespace loopwright::hw
