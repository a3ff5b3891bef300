/// Contents of a device file: channels with their physical meaning, limits, clock, watchdog, policies.
///
/// Every channel obeys one equation: value = scale · raw + offset. Raw numbers are counts (encoder), counts/s
/// (encoder velocity) or volts (analog). See docs/hardware.md for the format, hw/device/units.h for "$unit".
#pragma once
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>
#include "engine/block/parameters.h"
#include "engine/json/problem.h"
#include "engine/json/value.h"

namespace loopwright::hw {

enum class InputKind { encoder, encoder_velocity, analog };
constexpr auto names_of(InputKind) {
  return std::array<std::string_view, 3>{"encoder", "encoder_velocity", "analog"};
}
enum class ClockSource { device, host };
constexpr auto names_of(ClockSource) { return std::array<std::string_view, 2>{"device", "host"}; }
enum class Overflow { error, overwrite };
constexpr auto names_of(Overflow) { return std::array<std::string_view, 2>{"error", "overwrite"}; }
enum class Time { real, simulated };
constexpr auto names_of(Time) { return std::array<std::string_view, 2>{"real", "simulated"}; }
enum class OnOverrun { fault, count };
constexpr auto names_of(OnOverrun) { return std::array<std::string_view, 2>{"fault", "count"}; }
enum class OnLost { fault, hold, count };
constexpr auto names_of(OnLost) { return std::array<std::string_view, 3>{"fault", "hold", "count"}; }
enum class OnInvalid { fault, hold };
constexpr auto names_of(OnInvalid) { return std::array<std::string_view, 2>{"fault", "hold"}; }

struct InputChannel {
  std::string name;
  InputKind kind = InputKind::encoder;
  int channel = 0;
  std::string unit;             ///< of the value, SI
  double scale = 1;             ///< unit per raw
  double offset = 0;            ///< unit; of an encoder: the position at which it counts zero (homing)
  int quadrature = 4;           ///< edges counted per period
  int counter_bits = 24;        ///< wraps at this width are undone; less than the card's width is harmless
  int preset = 0;               ///< counts at the start
  double filter = 0;            ///< Hz; 0: the card's own setting
  double maximum_rate = 0;      ///< unit/s; a faster change is a glitch; 0: not checked
  double low = -10, high = 10;  ///< V, of an analog input
  static constexpr auto describe() {
    return fields(
        parameter(&InputChannel::kind, "kind", "", "What the channel measures"),
        parameter(&InputChannel::channel, "channel", "", "Number on the device").not_negative(),
        parameter(&InputChannel::unit, "unit", "", "SI unit of the value"),
        parameter(&InputChannel::scale, "scale", "$unit/$raw",
                  "Value per count (after quadrature), count/s or volt"),
        parameter(&InputChannel::offset, "offset", "$unit", "Value at raw zero").optional(),
        parameter(&InputChannel::quadrature, "quadrature", "", "Edges counted a period: 0, 1, 2 or 4")
            .between(0, 4)
            .optional(),
        parameter(&InputChannel::counter_bits, "counter_bits", "", "Width of the counter")
            .between(8, 32)
            .optional(),
        parameter(&InputChannel::preset, "preset", "", "Counts that the encoder is set to at the start")
            .optional(),
        parameter(&InputChannel::filter, "filter", "Hz", "Cut-off of the encoder's digital filter")
            .not_negative()
            .optional(),
        parameter(&InputChannel::maximum_rate, "maximum_rate", "$unit/s",
                  "Change of the value per second beyond which a sample is a glitch; 0: none")
            .not_negative()
            .optional(),
        parameter(&InputChannel::low, "low", "V", "Lower end of the range").optional(),
        parameter(&InputChannel::high, "high", "V", "Upper end of the range").optional());
  }
};

struct OutputChannel {
  std::string name;
  int channel = 0;
  std::string unit;
  double scale = 1, offset = 0;                    ///< value = scale · volts + offset
  double low = -10, high = 10;                     ///< V, range of the card
  double minimum = -infinity, maximum = infinity;  ///< unit; additional limits of the value
  double maximum_rate = 0;                         ///< unit/s; 0: unlimited
  double initial = 0, safe = 0;                    ///< unit
  static constexpr auto describe() {
    return fields(
        parameter(&OutputChannel::channel, "channel", "", "Number on the device").not_negative(),
        parameter(&OutputChannel::unit, "unit", "", "SI unit of the value"),
        parameter(&OutputChannel::scale, "scale", "$unit/$raw", "Value per volt"),
        parameter(&OutputChannel::offset, "offset", "$unit", "Value at 0 V").optional(),
        parameter(&OutputChannel::low, "low", "V", "Lower end of the range").optional(),
        parameter(&OutputChannel::high, "high", "V", "Upper end of the range").optional(),
        parameter(&OutputChannel::minimum, "minimum", "$unit", "Least value that is ever sent").optional(),
        parameter(&OutputChannel::maximum, "maximum", "$unit", "Greatest value that is ever sent").optional(),
        parameter(&OutputChannel::maximum_rate, "maximum_rate", "$unit/s",
                  "Greatest change per second; 0: not limited")
            .not_negative()
            .optional(),
        parameter(&OutputChannel::initial, "initial", "$unit", "Value before the first step").optional(),
        parameter(&OutputChannel::safe, "safe", "$unit",
                  "Value at which nothing can move, sent at every stop"));
  }
  double volts(double value) const { return (value - offset) / scale; }
  double least() const { return std::max(minimum, std::min(scale * low, scale * high) + offset); }
  double greatest() const { return std::min(maximum, std::max(scale * low, scale * high) + offset); }
};

struct ClockSettings {
  ClockSource source = ClockSource::device;
  int buffer = 2;
  Overflow overflow = Overflow::error;
  Time time = Time::real;
  static constexpr auto describe() {
    return fields(
        parameter(&ClockSettings::source, "source", "", "Who owns time: the device's clock or the computer's")
            .optional(),
        parameter(&ClockSettings::buffer, "buffer", "", "Samples that the device keeps for a late reader")
            .between(1, 1000)
            .optional(),
        parameter(&ClockSettings::overflow, "overflow", "",
                  "A full buffer is an error, or drops its oldest sample")
            .optional(),
        parameter(&ClockSettings::time, "time", "", "Simulated: a card in a computer, whose time is not ours")
            .optional());
  }
};

struct WatchdogSettings {
  double timeout = 0;  ///< s; 0: no watchdog
  static constexpr auto describe() {
    return fields(
        parameter(&WatchdogSettings::timeout, "timeout", "s",
                  "Without a sign of life for so long, the device goes to its safe values itself; 0: none")
            .not_negative());
  }
};

/// Consecutive samples or periods. The diagram is stepped through every instant without a sample, in the
/// period in which the next sample arrives. A longer gap is a fault under every policy.
inline constexpr int longest_gap = 1000;

/// How the loop treats samples that are late, missing, or implausible (docs/hardware.md).
struct Policy {
  OnOverrun on_overrun = OnOverrun::fault;
  int most_overruns = 3;
  OnLost on_lost = OnLost::fault;
  int most_lost = 3;
  int most_skipped = 20;
  OnInvalid on_invalid = OnInvalid::fault;
  int most_invalid = 3;
  static constexpr auto describe() {
    return fields(
        parameter(&Policy::on_overrun, "on_overrun", "", "Whether overruns end the run").optional(),
        parameter(&Policy::most_overruns, "most_overruns", "", "So many in a row are a fault")
            .at_least(1)
            .optional(),
        parameter(&Policy::on_lost, "on_lost", "",
                  "Samples that the device lost: few in a row are interpolated and many end the run, few are "
                  "held and many end the run, or they are interpolated and counted")
            .optional(),
        parameter(&Policy::most_lost, "most_lost", "",
                  "So many lost samples in a row are a fault, unless they are only counted")
            .between(1, longest_gap)
            .optional(),
        parameter(&Policy::most_skipped, "most_skipped", "",
                  "So many periods in a row that the computer's clock left out are a fault")
            .between(1, longest_gap)
            .optional(),
        parameter(&Policy::on_invalid, "on_invalid", "",
                  "A raw number that cannot be: a fault, or the value before it is held")
            .optional(),
        parameter(&Policy::most_invalid, "most_invalid", "",
                  "So many of them in a row are a fault where they are held")
            .between(1, longest_gap)
            .optional());
  }
  /// Number of consecutive lost samples that ends the run.
  int64_t lost_that_end() const { return on_lost == OnLost::count ? longest_gap : most_lost; }
};

struct DeviceDescription {
  std::string path, title;
  Place place;            ///< of the file's object
  std::string driver;     ///< "quanser", "udp"
  Value driver_settings;  ///< the object with the driver's name in the file; empty if absent
  std::vector<InputChannel> inputs;
  std::vector<OutputChannel> outputs;
  ClockSettings clock;
  WatchdogSettings watchdog;
  Policy policy;

  /// Index among inputs or outputs; -1: no channel has the name.
  int find_input(std::string_view name) const;
  int find_output(std::string_view name) const;
};

/// Reads a device file. `reference` is where it was named, `drivers` are the valid values of "driver". Null
/// when there are errors. Opens no device.
std::shared_ptr<const DeviceDescription> read_device(const std::string& path, const Place& reference,
                                                     std::span<const std::string> drivers,
                                                     Problems& problems);

}  // namespace loopwright::hw
