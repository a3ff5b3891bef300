#include <ctype.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "world.h"

struct setting {
  const char* name;
  size_t offset;
};
#define WORLD(name, member) {name, offsetof(struct world, member)}
#define PLANT(name, member) {"plant." name, offsetof(struct world, plant.member)}
#define FAULT(name, point)                                              \
  {"fault." name ".code", offsetof(struct world, faults[point].code)},  \
      {"fault." name ".from", offsetof(struct world, faults[point].from)}, \
      {"fault." name ".count", offsetof(struct world, faults[point].count)}

static const struct setting settings[] = {
    WORLD("real_time", is_real_time),
    WORLD("drift_ppm", drift_ppm),
    WORLD("compute", compute),
    WORLD("encoder.resolution", resolution),
    WORLD("encoder.bits", encoder_bits),
    WORLD("encoder.sign", encoder_sign),
    WORLD("encoder.scale", encoder_scale),
    WORLD("encoder.drift", encoder_drift),
    WORLD("dac.bits", dac_bits),
    WORLD("dac.hold", dac_hold),
    WORLD("analog.noise", analog_noise),
    WORLD("analog.per_ampere", analog_per_ampere),
    WORLD("switch.position", switch_position),
    WORLD("switch.volts", switch_volts),
    WORLD("watchdog.longest", watchdog_longest),
    WORLD("watchdog.zero_only", watchdog_zero_only),
    WORLD("watchdog.needs_all", watchdog_needs_all),
    WORLD("watchdog.write_error", watchdog_write_error),
    WORLD("refuses.watchdog", refuses_watchdog),
    WORLD("refuses.ranges", refuses_ranges),
    WORLD("refuses.options", refuses_options),
    WORLD("refuses.termination", refuses_termination),
    WORLD("refuses.filter", refuses_filter),
    WORLD("refuses.write", refuses_write),
    WORLD("refuses.overflow_mode", refuses_overflow_mode),
    FAULT("open", FAULT_OPEN),
    FAULT("configure", FAULT_CONFIGURE),
    FAULT("create", FAULT_CREATE),
    FAULT("start", FAULT_START),
    FAULT("read", FAULT_READ),
    FAULT("write", FAULT_WRITE),
    FAULT("watchdog", FAULT_WATCHDOG),
    FAULT("reload", FAULT_RELOAD),
    FAULT("stop", FAULT_STOP),
    WORLD("unplug.at", unplug_at),
    WORLD("lose.from", lose_from),
    WORLD("lose.count", lose_count),
    WORLD("lose.every", lose_every),
    WORLD("lose.length", lose_length),
    WORLD("lose.told", lose_told),
    WORLD("analog.bad_from", bad_from),
    WORLD("analog.bad_count", bad_count),
    WORLD("analog.bad_volts", bad_volts),
    WORLD("stall.at", stall_at),
    WORLD("stall.seconds", stall_seconds),
    WORLD("glitch.at", glitch_at),
    WORLD("glitch.count", glitch_count),
    WORLD("glitch.counts", glitch_counts),
    WORLD("stuck.at", stuck_at),
    WORLD("hang.at", hang_at),
    PLANT("amplifier_gain", amplifier_gain),
    PLANT("current_limit", current_limit),
    PLANT("current_lag", current_lag),
    PLANT("force_constant", force_constant),
    PLANT("mass", mass),
    PLANT("payload", payload),
    PLANT("load_at", load_at),
    PLANT("load_change", load_change),
    PLANT("damping", damping),
    PLANT("drag", drag),
    PLANT("coulomb", coulomb),
    PLANT("transition_speed", transition_speed),
    PLANT("coulomb_backward", coulomb_backward),
    PLANT("stribeck", stribeck),
    PLANT("stribeck_speed", stribeck_speed),
    PLANT("offset", offset),
    PLANT("tilt", tilt),
    PLANT("cable", cable),
    PLANT("cable_center", cable_center),
    PLANT("pole_pitch", pole_pitch),
    PLANT("cogging", cogging[0]),
    PLANT("cogging_phase", cogging_phase[0]),
    PLANT("cogging_2", cogging[1]),
    PLANT("cogging_phase_2", cogging_phase[1]),
    PLANT("cogging_3", cogging[2]),
    PLANT("cogging_phase_3", cogging_phase[2]),
    PLANT("cogging_4", cogging[3]),
    PLANT("cogging_phase_4", cogging_phase[3]),
    PLANT("cogging_slope", cogging_slope),
    PLANT("cogging_modulation", cogging_modulation),
    PLANT("modulation_period", modulation_period),
    PLANT("stop_low", stop_low),
    PLANT("stop_high", stop_high),
    PLANT("restitution", restitution),
    PLANT("position", position),
    PLANT("velocity", velocity),
    PLANT("current", current),
};

static const struct setting* find(const char* name) {
  for (size_t i = 0; i < sizeof settings / sizeof *settings; ++i)
    if (strcmp(settings[i].name, name) == 0) return &settings[i];
  return NULL;
}

static int indexed(const char* name, const char* prefix) { /* "dac.3" → 3; -1: no match */
  const size_t n = strlen(prefix);
  if (strncmp(name, prefix, n) != 0 || !isdigit((unsigned char)name[n]) || name[n + 1]) return -1;
  return name[n] - '0' < CHANNELS ? name[n] - '0' : -1;
}

int setting_set(struct world* w, const char* name, double value) {
  const struct setting* s = find(name);
  if (s) return *(double*)((char*)w + s->offset) = value, 1;
  if (strcmp(name, "advance") == 0) return world_advance(w, w->now + (int64_t)(1e9 * value)), 1;
  if (strcmp(name, "reset") == 0) return world_reset(w), 1;
  return 0;
}

int setting_get(const struct world* w, const char* name, double* value) {
  const struct setting* s = find(name);
  if (s) return *value = *(const double*)((const char*)w + s->offset), 1;
  const int output = indexed(name, "dac.");
  if (output >= 0) return *value = w->card.volts[output], 1;
  if (strcmp(name, "time") == 0) return *value = 1e-9 * (double)w->now, 1;
  if (strcmp(name, "samples") == 0) return *value = (double)w->samples, 1;
  if (strcmp(name, "dac.nan") == 0) return *value = w->dac_latched_nan, 1;
  if (strcmp(name, "watchdog.expired") == 0) return *value = w->card.is_expired, 1;
  if (strcmp(name, "watchdog.armed") == 0) return *value = w->card.is_watched, 1;
  if (strcmp(name, "watchdog.expired_at") == 0) return *value = 1e-9 * (double)w->card.expired_at, 1;
  if (strcmp(name, "open") == 0) return *value = w->card.is_open, 1;
  if (strcmp(name, "overflows") == 0) return *value = w->tasks[0].overflows, 1;
  return 0;
}

/* ---- a file of settings: {"name": number, …} ---- */

static const char* blanks(const char* at) {
  while (isspace((unsigned char)*at)) ++at;
  return at;
}

static const char* read_member(struct world* w, const char* at, const char* path) {
  char name[64];
  const char* end = *at == '"' ? strchr(at + 1, '"') : NULL;
  if (!end || (size_t)(end - at) > sizeof name) {
    fprintf(stderr, "%s: a name in quotes is expected at: %.30s\n", path, at);
    return NULL;
  }
  memcpy(name, at + 1, (size_t)(end - at - 1));
  name[end - at - 1] = 0;
  at = blanks(end + 1);
  char* after = NULL;
  const double value = *at == ':' ? strtod(at + 1, &after) : 0;
  if (!after || after == at + 1) {
    fprintf(stderr, "%s: \"%s\" has no number\n", path, name);
    return NULL;
  }
  if (!setting_set(w, name, value)) {
    fprintf(stderr, "%s: there is no setting \"%s\"\n", path, name);
    return NULL;
  }
  return blanks(after);
}

static int read_text(struct world* w, const char* at, const char* path) {
  at = blanks(at);
  if (*at++ != '{') return fprintf(stderr, "%s: an object in braces is expected\n", path), 0;
  at = blanks(at);
  if (*at == '}') return 1;
  for (;;) {
    at = read_member(w, at, path);
    if (!at) return 0;
    if (*at == '}') return 1;
    if (*at != ',') return fprintf(stderr, "%s: a comma or brace is expected at: %.30s\n", path, at), 0;
    at = blanks(at + 1);
  }
}

int settings_read(struct world* w, const char* path) {
  static char text[1 << 16];
  FILE* file = fopen(path, "r");
  if (!file) return fprintf(stderr, "hil emulator: %s cannot be read\n", path), 0;
  const size_t size = fread(text, 1, sizeof text - 1, file);
  text[size] = 0;
  fclose(file);
  return read_text(w, text, path);
}
