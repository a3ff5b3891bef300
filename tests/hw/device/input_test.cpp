// No raw number becomes an impossible position: all kinds of inputs, all kinds of doubles.
#include "hw/device/input.h"
#include <gtest/gtest.h>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace loopwright::hw::input_test {
namespace {

constexpr double period = 1e-3;

InputChannel channel_of(InputKind kind, int bits, double maximum_rate) {
  InputChannel channel;
  channel.kind = kind, channel.counter_bits = bits, channel.maximum_rate = maximum_rate;
  channel.scale = 2e-7, channel.offset = 0.1;
  return channel;
}

/// Numbers at which conversions fail, and random bits, which include every kind of double.
class HostileNumbers {
 public:
  double next() {
    switch (random_() % 6) {
      case 0:
        return special_[random_() % std::size(special_)];
      case 1:
        return std::bit_cast<double>(random_());
      case 2:
        return double(int64_t(random_()) >> (random_() % 63));  // whole, of every size
      case 3:
        return std::ldexp(1.0, int(random_() % 70)) + double(int(random_() % 5) - 2);
      case 4:
        return double(int(random_() % 2001) - 1000) / 4;
      default:
        return double(int(random_() % 2001) - 1000);
    }
  }

 private:
  static constexpr double huge = std::numeric_limits<double>::max();
  const double special_[18] = {std::nan(""),
                               -std::nan(""),
                               std::numeric_limits<double>::signaling_NaN(),
                               std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity(),
                               huge,
                               -huge,
                               std::numeric_limits<double>::denorm_min(),
                               -0.0,
                               0.5,
                               2147483647.0,
                               2147483648.0,
                               -2147483648.0,
                               -2147483649.0,
                               4294967295.0,
                               4294967296.0,
                               9223372036854775808.0,
                               -9223372036854775809.0};
  std::mt19937_64 random_{20};
};

TEST(Input, NoNumberWhateverIsAPlausibleValueThatTheAxisCannotHave) {
  HostileNumbers numbers;
  for (const InputKind kind : {InputKind::encoder, InputKind::encoder_velocity, InputKind::analog})
    for (const int bits : {8, 24, 31, 32})
      for (const double rate : {0.0, 3.0}) {
        const InputChannel channel = channel_of(kind, bits, rate);
        Input input(channel, period);
        int64_t since_good = 0;
        for (int i = 0; i < 20000; ++i) {
          const bool was_known = input.is_known();
          const double before = input.value();
          const double raw = numbers.next();
          const int64_t instants = 1 + i % 3;
          since_good += instants;
          const Reading reading = input.take(raw, instants);
          ASSERT_TRUE(std::isfinite(input.value())) << raw;
          if (reading != Reading::good) {
            ASSERT_EQ(input.value(), before) << raw;
            ASSERT_GT(input.bad_in_row(), 0);
            continue;
          }
          ASSERT_TRUE(std::isfinite(raw));
          ASSERT_EQ(input.bad_in_row(), 0);
          if (kind == InputKind::analog) {
            ASSERT_LE(std::abs(raw), 12);
          }
          if (kind == InputKind::encoder_velocity) {
            ASSERT_LE(std::abs(raw) * period, std::ldexp(0.5, bits));
          }
          if (kind != InputKind::encoder) {
            ASSERT_EQ(input.value(), 2e-7 * raw + 0.1);
          }
          if (kind == InputKind::encoder && was_known) {
            ASSERT_LE(std::abs(input.value() - before), 2e-7 * std::ldexp(0.5, bits) * (1 + 1e-9)) << raw;
          }
          if (rate > 0 && was_known) {
            ASSERT_LE(std::abs(input.value() - before), rate * period * double(since_good));
          }
          since_good = 0;
          if (i % 7 == 6) input.forget();
        }
      }
}

TEST(Input, ACounterIsFollowedAcrossItsWrapHoweverItIsRead) {
  std::mt19937_64 random(3);
  for (const int bits : {8, 16, 24, 31, 32})
    for (const int width : {bits, 32})             // of the device's counter
      for (const bool has_sign : {true, false}) {  // and its form in the interface
        const InputChannel channel = channel_of(InputKind::encoder, bits, 0);
        Input input(channel, period);
        int64_t counts = 0;
        const int64_t most = (int64_t(1) << (bits - 1)) - 1;
        for (int i = 0; i < 5000; ++i) {
          const uint64_t range = uint64_t(1) << width, low = uint64_t(counts) & (range - 1);
          const double raw = has_sign && low >= range / 2 ? double(low) - double(range) : double(low);
          ASSERT_EQ(input.take(raw, 1), Reading::good) << bits << " of " << width << ": " << raw;
          ASSERT_EQ(input.value(), 2e-7 * double(counts) + 0.1);
          counts += int64_t(random() % uint64_t(2 * most + 1)) - most;
        }
      }
}

}  // namespace
}  // namespace loopwright::hw::input_test
