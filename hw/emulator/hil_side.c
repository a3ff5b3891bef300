/* Messages, and the side channel through which tests access the card's internal state. */
#include <stdio.h>
#include <string.h>

#include "hil_abi.h"

/* Names of the calls made, in order, for tests of their order; identified by their index in this table. */
static const char* names[128];

static uint16_t number_of(const char* name) {
  uint16_t i = 0;
  while (i < 127 && names[i] && strcmp(names[i], name) != 0) ++i;
  names[i] = name;
  return i;
}

struct world* enter(const char* function) {
  struct world* w = world_lock();
  if (w->calls < CALLS_KEPT) w->call[w->calls++] = number_of(function);
  return w;
}

EXPORT t_error msg_get_error_messageA(const char* locale, t_error code, char* text, size_t size) {
  (void)locale;
  if (!text || size == 0) return -INVALID_ARGUMENT;
  const char* message = code == -BOARD_NOT_FOUND       ? "The specified board was not found."
                        : code == -DEVICE_DISCONNECTED ? "The device has been disconnected."
                        : code == -BUFFER_OVERFLOW     ? "The buffer has overflowed."
                                                       : "An error occurred in the emulated card.";
  return (t_error)snprintf(text, size, "%s", message);
}

EXPORT int hil_emu_set(const char* name, double value) {
  struct world* w = world_lock();
  const int found = setting_set(w, name, value);
  world_unlock(w);
  return found;
}

/* NaN: there is no number with this name. */
EXPORT double hil_emu_get(const char* name) {
  struct world* w = world_lock();
  double value = 0;
  const int found = setting_get(w, name, &value);
  world_unlock(w);
  return found ? value : 0.0 / 0.0;
}

/* "hil_open,hil_watchdog_clear,…": the calls of this process, at most 2000. Returns their number. */
EXPORT int hil_emu_calls(char* text, size_t size) {
  struct world* w = world_lock();
  size_t used = 0;
  for (int i = 0; i < w->calls; ++i) {
    const char* name = names[w->call[i]];
    if (used + strlen(name) + 2 > size) break;
    used += (size_t)snprintf(text + used, size - used, "%s%s", i ? "," : "", name);
  }
  const int count = w->calls;
  world_unlock(w);
  return count;
}

/* The text last passed to hil_set_card_specific_options, and the size passed with it. */
EXPORT int hil_emu_options(char* text, size_t size) {
  struct world* w = world_lock();
  snprintf(text, size, "%s", w->card.options);
  const int length = (int)w->card.options_size;
  world_unlock(w);
  return length;
}
