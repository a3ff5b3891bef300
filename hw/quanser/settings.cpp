#include <fmt/format.h>
#include <algorithm>
#include "engine/diagram/diagram.h"
#include "engine/json/reader.h"
#include "hw/device/units.h"
#include "hw/quanser/quanser.h"

namespace loopwright::hw::quanser {
namespace {

/// Options of the QPIDe, as its block in the vendor's environment provides them.
std::vector<std::string> known_options() {
  std::vector<std::string> names{
      "ext_int_polarity", "fuse_polarity",  "convert_polarity",  "watchdog_polarity", "ext_int_watchdog",
      "fuse_watchdog",    "trig1_watchdog", "watchdog_to_trig1", "watchdog_to_trig2", "counter_to_trig0",
      "trigger_adcs",     "latch_on_adc",   "pwm_immediate",     "analog_min",        "analog_max"};
  for (int i = 0; i < 8; ++i)
    for (const char* of_encoder : {"dir", "filter", "a", "b", "z", "reload"})
      names.push_back(fmt::format("enc{}_{}", i, of_encoder));
  return names;
}

void check_options(const Settings& settings, const Value& section, Problems& problems) {
  const Value::Member* member = section.find("options");
  if (!member || settings.board != "qpid_e") return;
  KnownNames known(known_options());
  const std::vector<std::string> names = known_options();
  std::string_view rest = settings.options;
  while (!rest.empty()) {
    const size_t end = rest.find(';');
    const std::string_view option = rest.substr(0, end);
    rest = end == rest.npos ? std::string_view{} : rest.substr(end + 1);
    const std::string name(option.substr(0, option.find('=')));
    if (option.find('=') == option.npos) {
      auto& p =
          problems.error(member->value.place, member->value.place.pointer(), "", "an option has no value");
      p.found = fmt::format("\"{}\"", option);
      p.expected = "name=value, separated by semicolons";
    } else if (std::ranges::find(names, name) == names.end()) {
      auto& p = problems.error(member->value.place, member->value.place.pointer(), "",
                               fmt::format("the {} has no option \"{}\"", settings.board, name));
      known.explain(p, name);
    }
  }
}

template <class Channel>
void check_channels(const std::vector<Channel>& channels, int most, const Settings& settings,
                    const Value& section, Problems& problems) {
  for (const Channel& channel : channels)
    if (channel.channel >= most) {
      auto& p = problems.error(section.place, section.place.pointer(), channel.name,
                               "the card has no such channel");
      p.found = fmt::format("channel {}", channel.channel);
      p.expected = fmt::format("0 to {} on a {}", most - 1, settings.board);
    }
}

/// The card's watchdog puts out safe values on as many channels as `analog_outputs` says. A command on
/// another channel would stay there after a crash of this program, although the watchdog is armed.
void check_watched(const DeviceDescription& device, const Settings& settings, const Value& section,
                   Problems& problems) {
  const Value::Member* member = section.find("analog_outputs");
  const Value& at = member ? member->value : section;
  for (const OutputChannel& output : device.outputs)
    if (output.channel >= settings.analog_outputs) {
      auto& p = problems.error(at.place, at.place.pointer(), output.name,
                               "the card's watchdog would not put out the safe value of this output");
      p.found =
          fmt::format("channel {}, and \"analog_outputs\": {}", output.channel, settings.analog_outputs);
      p.expected = "the number of analog outputs that the card has, above the channel of every output";
    }
}

}  // namespace

Settings read_settings(const DeviceDescription& device, Problems& problems) {
  Settings settings;
  const Value& section = device.driver_settings;
  read_with_units(settings, section, device.driver, problems);
  if (settings.library.find('/') != settings.library.npos)
    settings.library = resolve_relative(section.find("library")->value.place, settings.library);
  check_options(settings, section, problems);
  if (settings.board == "qpid_e" || settings.board.starts_with("q8") || settings.board == "qpid") {
    check_channels(device.inputs, 8, settings, section, problems);
    check_channels(device.outputs, 8, settings, section, problems);
  }
  check_watched(device, settings, section, problems);
  if (settings.clock == 1 && settings.board == "qpid_e")
    problems
        .error(section.place, section.place.pointer(), "", "hardware clock 1 of the QPIDe is its watchdog")
        .expected = "\"clock\": 0";
  if (device.watchdog.timeout > 0.419 && settings.board == "qpid_e") {
    auto& p = problems.error(section.place, section.place.pointer(), "",
                             "the watchdog of the QPIDe does not count so far");
    p.expected = "a timeout of at most 0.419 s";
    p.found = fmt::format("{:g} s", device.watchdog.timeout);
  }
  return settings;
}

}  // namespace loopwright::hw::quanser
