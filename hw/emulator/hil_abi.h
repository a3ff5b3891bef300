/* Types of the emulated interface, and what the files that export it share. */
#ifndef HIL_EMULATOR_ABI_H
#define HIL_EMULATOR_ABI_H

#include <stddef.h>
#include <stdint.h>

#include "world.h"

typedef char t_boolean;
typedef int32_t t_error;
typedef struct tag_card* t_card;
typedef struct tag_task* t_task;
typedef const uint32_t* channels; /* a list of channel numbers */

#define EXPORT __attribute__((visibility("default")))

/* Error codes, returned negative. */
enum {
  OUT_OF_MEMORY = 1,
  INVALID_ARGUMENT = 4,
  INVALID_CARD_HANDLE = 88,
  FUNCTION_NOT_SUPPORTED = 94,
  INVALID_TASK_HANDLE = 105,
  BOARD_NOT_FOUND = 108,
  BUFFER_OVERFLOW = 111,
  INVALID_ANALOG_INPUT = 121,
  INVALID_ENCODER_INPUT = 124,
  INVALID_DIGITAL_INPUT = 127,
  INVALID_OTHER_INPUT = 130,
  INVALID_ANALOG_OUTPUT = 133,
  INVALID_PWM_OUTPUT = 136,
  INVALID_DIGITAL_OUTPUT = 139,
  OTHER_OUTPUTS_NOT_SUPPORTED = 140,
  CLOCK_NOT_SUPPORTED = 144,
  HARDWARE_CLOCK_IN_USE = 145,
  FREQUENCY_NOT_POSITIVE = 149,
  FREQUENCY_TOO_HIGH = 150,
  FREQUENCY_TOO_LOW = 151,
  FREQUENCY_INVALID = 152,
  TOO_MANY_SAMPLES = 159,
  MISSING_ANALOG_INPUT_BUFFER = 160,
  MISSING_ENCODER_INPUT_BUFFER = 161,
  MISSING_DIGITAL_INPUT_BUFFER = 162,
  MISSING_OTHER_INPUT_BUFFER = 163,
  MISSING_ANALOG_OUTPUT_BUFFER = 164,
  UNRECOGNIZED_BOARD_TYPE = 179,
  INVALID_BUFFER_SIZE = 320,
  INVALID_ANALOG_OUTPUT_RANGE = 398,
  IDENTIFIER_IS_NULL = 399,
  QUADRATURE_NOT_SUPPORTED = 434,
  INPUT_RANGES_NOT_SUPPORTED = 460,
  OUTPUT_RANGES_NOT_SUPPORTED = 461,
  OPTIONS_NOT_SUPPORTED = 462,
  FILTER_NOT_SUPPORTED = 466,
  WRITE_NOT_SUPPORTED = 504,
  OPTION_NOT_RECOGNIZED = 573,
  EXPIRY_NOT_SUPPORTED = 591,
  WATCHDOG_START_NOT_SUPPORTED = 595,
  WATCHDOG_STOP_NOT_SUPPORTED = 596,
  WATCHDOG_RELOAD_NOT_SUPPORTED = 597,
  WATCHDOG_IS_EXPIRED_NOT_SUPPORTED = 598,
  WATCHDOG_CLEAR_NOT_SUPPORTED = 599,
  EXPIRY_NOT_ZERO = 601,
  EXPIRIES_NOT_CONFIGURED = 604,
  ANALOG_TERMINATION_NOT_SUPPORTED = 974,
  TERMINATION_NOT_SUPPORTED = 980,
  BOARD_ALREADY_OPEN = 1073,
  INVALID_BUFFER_MODE = 1080,
  DEVICE_DISCONNECTED = 1160,
  OVERFLOW_MODE_NOT_SUPPORTED = 1188,
  BUFFER_MODE_NOT_SUPPORTED = 1265,
};

/* Locks the world, advances it to now and records the call by name. Every exported function begins so. */
struct world* enter(const char* function);
/* Unlocks and returns the answer. */
t_error leave(struct world* w, t_error answer);

/* Whether the card was last opened by this process. */
int is_own(const struct world* w);
/* 0, or the negative code why this card or task cannot be used. */
t_error check_card(const struct world* w, t_card card);
t_error check_task(const struct world* w, t_task task, struct task** found);
/* 0, or -code when a channel of the list is not below `limit`, or the list or buffer is missing. */
t_error check_channels(channels list, uint32_t count, uint32_t limit, int code, const void* buffer, int missing);

#endif
