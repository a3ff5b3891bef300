#include "hw/device/description.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "engine/block/parameter_shape.h"
#include "engine/json/file_kind.h"
#include "hw/device/device_shape.h"
#include "engine/json/json.h"
#include "engine/diagram/parameter_scope.h"
#include "engine/json/reader.h"
#include "hw/device/units.h"

namespace loopwright::hw {
namespace {

class DeviceReader {
 public:
  DeviceReader(std::span<const std::string> drivers, Problems& problems)
      : drivers_(drivers.begin(), drivers.end()), problems_(problems), reader_{problems, ""} {}

  void read(const Value& file, DeviceDescription& to) {
    reader_.check_version(file);
    to.title = reader_.text(file, "title"), to.place = file.place;
    read_driver(file, to);
    std::vector<std::pair<std::string_view, FileShape>> drivers;  // each has a key of its own
    for (const std::string& name : drivers_) drivers.emplace_back(name, shapes::anything());
    reject_unknown(reader_, file, device_shape(drivers), "a device");
    read_channels(file, "inputs", to.inputs);
    read_channels(file, "outputs", to.outputs);
    section(file, "clock", to.clock);
    section(file, "watchdog", to.watchdog);
    section(file, "policy", to.policy);
  }

 private:
  bool is_driver(std::string_view name) const { return std::ranges::find(drivers_, name) != drivers_.end(); }

  void read_driver(const Value& file, DeviceDescription& to) {
    to.driver = reader_.text(file, "driver");
    const Value::Member* named = file.find("driver");
    if (!named || !is_driver(to.driver)) {
      auto& p = named ? reader_.error(*named, "there is no such driver")
                      : reader_.error(file, "the device has no driver");
      if (named) p.found = shown(named->value);
      KnownNames(drivers_).explain(p, to.driver);
    }
    to.driver_settings.kind = Value::Kind::object;
    to.driver_settings.place = file.place;
    const Value::Member* settings = to.driver.empty() ? nullptr : file.find(to.driver);
    if (settings && reader_.expect(settings->value, Value::Kind::object, fmt::format("\"{}\"", to.driver),
                                   "an object: the settings of the driver"))
      to.driver_settings = settings->value;
  }

  template <class T> void section(const Value& file, std::string_view key, T& to) {
    const Value::Member* found = file.find(key);
    if (found && reading::object(found->value, "", problems_))
      read_with_units(to, found->value, std::string(key), problems_);
  }

  template <class Channel> static ChannelUnits units_of(const Value& object) {
    const auto text = [&](std::string_view key) {
      const Value::Member* member = object.find(key);
      return member ? member->value.text : std::string();
    };
    ChannelUnits units{text("unit"), "/V"};
    if (!std::is_same_v<Channel, InputChannel>) return units;
    if (text("kind") == "encoder") units.per_raw = "";
    if (text("kind") == "encoder_velocity") units.per_raw = "*s";
    return units;
  }

  template <class Channel>
  void read_channels(const Value& file, std::string_view key, std::vector<Channel>& to) {
    const Value::Member* list = file.find(key);
    if (!list || !reader_.expect(list->value, Value::Kind::object, fmt::format("\"{}\"", key),
                                 "an object: name → channel"))
      return;
    for (const Value::Member& member : list->value.members) {
      reader_.check_name(member, "a channel");
      if (!reading::object(member.value, member.name, problems_)) continue;
      Channel channel;
      channel.name = member.name;
      const size_t before = problems_.list().size();
      read_with_units(channel, member.value, member.name, problems_, units_of<Channel>(member.value));
      if (problems_.list().size() == before) check(channel, member.value, to);
      to.push_back(std::move(channel));
    }
  }

  Problem& error(const Value& object, std::string_view key, const std::string& name, std::string message) {
    const Value::Member* member = object.find(key);
    const Value& at = member ? member->value : object;
    return problems_.error(at.place, at.place.pointer(), name, std::move(message));
  }

  template <class Channel> void check_common(const Channel& channel, const Value& object) {
    const auto unit = parse_unit(channel.unit);
    if (!unit || unit->scale != 1 || unit->offset != 0) {
      auto& p = error(object, "unit", channel.name, "values are in SI units");
      p.expected = "a unit without prefix, as in \"m\", \"N\" or \"V\"";
      p.found = "\"" + channel.unit + "\"";
      p.hint = "put the prefix into \"scale\"";
    }
    if (channel.scale == 0)
      error(object, "scale", channel.name, "a scale of 0 makes all values alike").expected =
          "a number other than 0";
    if (!(channel.low < channel.high)) {
      auto& p = error(object, "low", channel.name, "the range is empty");
      p.found = fmt::format("{:g} V to {:g} V", channel.low, channel.high);
      p.expected = "low below high";
    }
  }

  void check(const InputChannel& channel, const Value& object, const std::vector<InputChannel>& before) {
    check_common(channel, object);
    for (const InputChannel& other : before)
      if (other.kind == channel.kind && other.channel == channel.channel)
        taken_twice(channel, object, other.name);
    if (channel.quadrature == 3) {
      auto& p = error(object, "quadrature", channel.name, "no counter counts three edges");
      p.expected = "0, 1, 2 or 4";
    }
    const double most = std::ldexp(1.0, channel.counter_bits - 1);
    if (channel.preset < -most || channel.preset >= most) {
      auto& p = error(object, "preset", channel.name, "the counter does not reach this preset");
      p.expected = fmt::format("from {:.0f} to {:.0f}", -most, most - 1);
      p.found = fmt::format("{}", channel.preset);
    }
  }

  void check(const OutputChannel& channel, const Value& object, const std::vector<OutputChannel>& before) {
    check_common(channel, object);
    for (const OutputChannel& other : before)
      if (other.channel == channel.channel) taken_twice(channel, object, other.name);
    if (channel.scale == 0) return;
    for (const auto& [key, value] :
         {std::pair{"safe", channel.safe}, std::pair{"initial", channel.initial}}) {
      if (value >= channel.least() && value <= channel.greatest()) continue;
      auto& p = error(object, key, channel.name, fmt::format("the value \"{}\" cannot be put out", key));
      p.expected = fmt::format("from {:g} to {:g} {}", channel.least(), channel.greatest(), channel.unit);
      p.found = fmt::format("{:g} {}", value, channel.unit);
      p.hint = "limits are low and high (volts), minimum and maximum (values)";
    }
  }

  template <class Channel>
  void taken_twice(const Channel& channel, const Value& object, const std::string& other) {
    auto& p = error(object, "channel", channel.name, "the channel is taken twice");
    p.found = fmt::format("{}, which is also \"{}\"", channel.channel, other);
  }

  std::vector<std::string> drivers_;
  Problems& problems_;
  Reader reader_;
};

template <class Channel> int place_of(const std::vector<Channel>& channels, std::string_view name) {
  for (size_t i = 0; i < channels.size(); ++i)
    if (channels[i].name == name) return int(i);
  return -1;
}

}  // namespace

int DeviceDescription::find_input(std::string_view name) const { return place_of(inputs, name); }
int DeviceDescription::find_output(std::string_view name) const { return place_of(outputs, name); }

FileShape device_shape(const std::vector<std::pair<std::string_view, FileShape>>& drivers) {
  using namespace shapes;
  const auto section = [](const std::vector<ParameterInfo>& fields) {
    return shape_of(fields, Writing::evaluated);
  };
  std::vector<FileShape> alternatives;
  for (const auto& [name, settings] : drivers) {
    std::vector<FileShape::Key> keys = {
        optional("title", text()),
        optional("description", text()),
        required("driver", choice({name}), "The kind of hardware"),
        optional("inputs", by_name(section(parameters_of<InputChannel>())), "Channels that are read"),
        optional("outputs", by_name(section(parameters_of<OutputChannel>())), "Channels that are written"),
        optional("clock", section(parameters_of<ClockSettings>()), "Who owns time"),
        optional("watchdog", section(parameters_of<WatchdogSettings>()), "What the device does alone"),
        optional("policy", section(parameters_of<Policy>()), "Late, lost and invalid samples")};
    for (const auto& [other, of_other] : drivers) {
      const bool is_needed =
          other == name && std::ranges::any_of(settings.keys, &FileShape::Key::is_required);
      keys.push_back({other, other == name ? settings : anything(), is_needed});
    }
    alternatives.push_back(file(std::move(keys)));
  }
  return either(std::move(alternatives));
}

std::shared_ptr<const DeviceDescription> read_device(const std::string& path, const Place& reference,
                                                     std::span<const std::string> drivers,
                                                     Problems& problems) {
  Problems own;
  auto device = std::make_shared<DeviceDescription>();
  device->path = path;
  if (const auto source = read_source(path, reference, own)) {
    ParameterScope expressions("", own);
    const Value file = expressions.evaluate(parse_json(source, own), "");
    if (!own.has_errors() &&
        Reader{own, ""}.expect(file, Value::Kind::object, "a device", "an object in braces") &&
        expect_kind(file, FileKind::device, own))
      DeviceReader(drivers, own).read(file, *device);
  }
  problems.add(own);
  return own.has_errors() ? nullptr : device;
}

}  // namespace loopwright::hw
