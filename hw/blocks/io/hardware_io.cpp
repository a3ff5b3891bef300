/// position, velocity = device(command)
#include "hw/blocks/io/hardware_io.h"
#include <fmt/format.h>
#include "engine/json/reader.h"
#include "hw/drivers.h"

namespace loopwright::blocks {
namespace {

/// The channel with this name; without a name, the first one for which `serves` is true. Reports a problem if
/// there is none.
template <class Channel, class Serves>
int choose(const Checker& checker, const char* parameter, const std::string& name,
           const std::vector<Channel>& channels, Serves&& serves) {
  KnownNames known;
  for (size_t i = 0; i < channels.size(); ++i) {
    if (name.empty() ? serves(channels[i]) : channels[i].name == name) return int(i);
    known.add(channels[i].name);
  }
  auto& p = checker.error(name.empty() ? "device" : parameter,
                          name.empty() ? fmt::format("the device offers nothing for \"{}\"", parameter)
                                       : fmt::format("the device has no channel \"{}\"", name));
  known.explain(p, name);
  return -1;
}

}  // namespace

void HardwareIo::check(const Checker& checker) {
  device = hw::load_device(checker.resolve_file("device", device_file), checker.place("device"),
                           checker.problems());
  if (!device) {
    checker.error("device", "the device file cannot be used").found = device_file;
    return;
  }
  const auto is_encoder = [](const hw::InputChannel& c) { return c.kind == hw::InputKind::encoder; };
  position_channel = choose(checker, "position_input", position_input, device->inputs, is_encoder);
  command_channel =
      choose(checker, "command_output", command_output, device->outputs, [](auto&) { return true; });
  if (!velocity_input.empty())
    velocity_channel =
        choose(checker, "velocity_input", velocity_input, device->inputs, [](auto&) { return false; });
}

std::vector<UnitClaim> HardwareIo::unit_claims() const {
  std::vector<UnitClaim> claims;
  const auto claim = [&](std::string_view port, int channel, const auto& channels,
                         std::string_view parameter) {
    const auto unit = device && channel >= 0 ? parse_unit(channels[size_t(channel)].unit) : std::nullopt;
    if (unit) claims.push_back({port, unit->in_si(), parameter});
  };
  if (!device) return claims;
  claim("$position", position_channel, device->inputs, "position_input");
  claim("$position/s", velocity_channel, device->inputs, "velocity_input");
  claim("$command", command_channel, device->outputs, "command_output");
  return claims;
}
LOOPWRIGHT_BLOCK(HardwareIo)

}  // namespace loopwright::blocks
