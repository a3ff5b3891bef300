/// The functions used from the vendor's C interface, in one table: name, signature, and whether a library is
/// usable without it. hil_abi_check.cpp compares the table with the vendor's header where that is installed.
#pragma once
#include <cstddef>
#include <cstdint>

// The vendor's opaque handles, under the vendor's names: the signatures must be the same types.
struct tag_card;
struct tag_task;

namespace loopwright::hw::quanser {

using t_card = tag_card*;
using t_task = tag_task*;
using t_error = int32_t;  // negative: an error
using t_boolean = char;
using channel_list = const uint32_t*;
using volts = const double*;

struct t_version {
  uint32_t size;  ///< of this struct, filled in by the caller
  uint16_t major, minor, release, build;
};

enum : int32_t { overflow_is_error = 0, overflow_drops_oldest = 1 };
enum : int32_t { property_product_name = 1, property_serial_number = 3, property_firmware = 4 };
enum : int32_t { property_encoder_inputs = 17, property_analog_outputs = 20 };
constexpr uint32_t other_encoder_velocity = 14000;  ///< "other" input 14000 + n: counts/s of encoder n
constexpr uint32_t until_stopped = UINT32_MAX;

// Enumerations are passed as 32-bit integers. Arrays are pointers.
// clang-format off
#define LOOPWRIGHT_HIL_FUNCTIONS(REQUIRED, OPTIONAL) \
  REQUIRED(hil_open, t_error(const char* type, const char* identifier, t_card* card)) \
  REQUIRED(hil_close, t_error(t_card)) \
  REQUIRED(hil_write_analog, t_error(t_card, channel_list, uint32_t, volts)) \
  REQUIRED(hil_task_create_reader, t_error(t_card, uint32_t samples_in_buffer, channel_list analog, uint32_t, \
           channel_list encoder, uint32_t, channel_list digital, uint32_t, channel_list other, uint32_t, t_task*)) \
  REQUIRED(hil_task_start, t_error(t_task, int32_t clock, double frequency_hz, uint32_t samples)) \
  REQUIRED(hil_task_read, t_error(t_task, uint32_t samples, double* analog, int32_t* encoder, t_boolean* digital, \
           double* other)) \
  REQUIRED(hil_task_stop, t_error(t_task)) \
  REQUIRED(hil_task_delete, t_error(t_task)) \
  OPTIONAL(hil_close_all, t_error()) \
  OPTIONAL(hil_get_version, t_error(t_version*)) \
  OPTIONAL(hil_set_card_specific_options, t_error(t_card, const char* options, size_t size)) \
  OPTIONAL(hil_set_analog_input_ranges, t_error(t_card, channel_list, uint32_t, volts low, volts high)) \
  OPTIONAL(hil_set_analog_output_ranges, t_error(t_card, channel_list, uint32_t, volts low, volts high)) \
  OPTIONAL(hil_set_encoder_counts, t_error(t_card, channel_list, uint32_t, const int32_t* counts)) \
  OPTIONAL(hil_set_encoder_quadrature_mode, t_error(t_card, channel_list, uint32_t, const int32_t* mode)) \
  OPTIONAL(hil_set_encoder_filter_frequency, t_error(t_card, channel_list, uint32_t, const double* hz)) \
  OPTIONAL(hil_read_encoder, t_error(t_card, channel_list, uint32_t, int32_t*)) \
  OPTIONAL(hil_read_analog, t_error(t_card, channel_list, uint32_t, double*)) \
  OPTIONAL(hil_read_other, t_error(t_card, channel_list, uint32_t, double*)) \
  OPTIONAL(hil_task_set_buffer_overflow_mode, t_error(t_task, int32_t mode)) \
  OPTIONAL(hil_task_get_buffer_overflows, t_error(t_task)) \
  OPTIONAL(hil_watchdog_set_analog_expiration_state, t_error(t_card, channel_list, uint32_t, volts)) \
  OPTIONAL(hil_watchdog_start, t_error(t_card, double timeout_s)) \
  OPTIONAL(hil_watchdog_reload, t_error(t_card)) \
  OPTIONAL(hil_watchdog_is_expired, t_error(t_card)) \
  OPTIONAL(hil_watchdog_stop, t_error(t_card)) \
  OPTIONAL(hil_watchdog_clear, t_error(t_card)) \
  OPTIONAL(hil_set_analog_termination_state, t_error(t_card, channel_list, uint32_t, volts)) \
  OPTIONAL(hil_write_termination_states, t_error(t_card)) \
  OPTIONAL(hil_get_integer_property, t_error(t_card, const int32_t* property, uint32_t, int32_t*)) \
  OPTIONAL(hil_get_string_property, t_error(t_card, int32_t property, char*, size_t)) \
  OPTIONAL(msg_get_error_messageA, t_error(const char* locale, t_error code, char*, size_t))
// clang-format on

namespace signatures {
#define LOOPWRIGHT_HIL_SIGNATURE(name, ...) using name = __VA_ARGS__;
LOOPWRIGHT_HIL_FUNCTIONS(LOOPWRIGHT_HIL_SIGNATURE, LOOPWRIGHT_HIL_SIGNATURE)
#undef LOOPWRIGHT_HIL_SIGNATURE
}  // namespace signatures

/// The functions of a library; null if it lacks an optional function.
struct HilFunctions {
#define LOOPWRIGHT_HIL_MEMBER(name, ...) signatures::name* name = nullptr;
  LOOPWRIGHT_HIL_FUNCTIONS(LOOPWRIGHT_HIL_MEMBER, LOOPWRIGHT_HIL_MEMBER)
#undef LOOPWRIGHT_HIL_MEMBER
};

}  // namespace loopwright::hw::quanser
