#include "hw/device/explain.h"
#include <fmt/format.h>

namespace loopwright::hw {
namespace {

std::string_view raw_unit(InputKind kind) {
  return kind == InputKind::encoder ? "counts" : kind == InputKind::encoder_velocity ? "counts/s" : "V";
}

/// "input "position" (encoder 0)"
std::string named(const InputChannel& input) {
  return fmt::format("input \"{}\" ({} {})", input.name, names_of(input.kind)[size_t(input.kind)],
                     input.channel);
}

std::string what_was_read(const Incident& incident, const InputChannel& input) {
  const auto read = fmt::format("{} read {} {}", named(input), incident.number, raw_unit(input.kind));
  switch (incident.reading) {
    case Reading::good:
      break;
    case Reading::not_finite:
      return read + ", which is not finite";
    case Reading::not_whole:
      return read + ": a counter counts whole edges";
    case Reading::beyond_counter:
      return fmt::format("{}, which its counter of {} bits cannot do (\"counter_bits\")", read,
                         input.counter_bits);
    case Reading::beyond_range:
      return fmt::format("{}, far beyond its range of {:g} V to {:g} V (\"low\", \"high\")", read, input.low,
                         input.high);
    case Reading::jump:
      return fmt::format("{}, a jump from {:g} {} beyond its maximum rate of {:g} {}/s", read,
                         incident.value_before, input.unit, input.maximum_rate, input.unit);
  }
  return read;
}

std::string explain_input(const Incident& incident, const InputChannel& input) {
  std::string text = what_was_read(incident, input);
  if (!incident.has_begun) return text + ", before two samples agreed; the diagram has not begun";
  if (incident.in_row > 1) text += fmt::format("; {} bad readings in a row", incident.in_row);
  return text;
}

}  // namespace

std::string explain(const Incident& incident, const DeviceDescription& device) {
  using What = Incident::What;
  switch (incident.what) {
    case What::none:
      break;
    case What::input:
      return explain_input(incident, device.inputs[incident.channel]);
    case What::numbering:
      return fmt::format("the device numbered a sample {} after sample {}: what time it is cannot be told",
                         incident.sample, incident.sample_before);
    case What::output: {
      const OutputChannel& output = device.outputs[incident.channel];
      return fmt::format(
          "the command for output \"{}\" (channel {}) became {:g}, which is not finite; "
          "the safe values were sent instead",
          output.name, output.channel, incident.number);
    }
  }
  return "";
}

std::string_view sentence_of(Code code) {
  switch (code) {
    case Code::ok:
      return "the device is fine";
    case Code::stopped:
      return "the device stopped sampling";
    case Code::late:
      return "commands come too late";
    case Code::lost:
      return "too many samples in a row are missing";
    case Code::range:
      return "a value to put out is not a finite number";
    case Code::watchdog:
      return "the device's watchdog has expired: it saw no sign of life for longer than its timeout";
    case Code::device_fault:
      return "the device reports a fault";
    case Code::disconnected:
      return "the device does not answer any more";
    case Code::unsupported:
      return "the device cannot do what it was asked for";
    case Code::config_error:
      return "the device refuses a setting";
    case Code::not_open:
      return "the device is not open";
    case Code::busy:
      return "the device is in use";
    case Code::no_driver:
      return "there is no such device, or no driver for it";
  }
  return "";
}

}  // namespace loopwright::hw
