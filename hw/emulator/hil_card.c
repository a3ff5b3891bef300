/* Opening, configuring, immediate input and output, watchdog, termination states. */
#include <math.h>
#include <string.h>

#include "hil_abi.h"

struct tag_card {
  int unused;
};
/* A handle is valid until the next opening: a program whose card was taken over holds an invalid handle. */
enum { CARD_HANDLES = 16 };
static struct tag_card handles[CARD_HANDLES];
static int64_t opened_here; /* number of the world's opening that was this process's last */

t_error leave(struct world* w, t_error answer) {
  world_unlock(w);
  return answer;
}

int is_own(const struct world* w) { return w->card.openings == opened_here; }

t_error check_card(const struct world* w, t_card card) {
  if (!w->card.is_open || card != &handles[w->card.openings % CARD_HANDLES] || !is_own(w)) return -INVALID_CARD_HANDLE;
  return w->is_unplugged ? -DEVICE_DISCONNECTED : 0;
}

t_error check_channels(channels list, uint32_t count, uint32_t limit, int code, const void* buffer, int missing) {
  if (count == 0) return 0;
  if (!list) return -INVALID_ARGUMENT;
  if (!buffer) return -missing;
  for (uint32_t i = 0; i < count; ++i)
    if (list[i] >= limit) return -code;
  return 0;
}

/* ---- open and close ---- */

static int is_known_board(const char* type) {
  static const char* const boards[] = {"qpid_e", "qpid", "q8_usb", "q2_usb", "q8"};
  for (size_t i = 0; i < sizeof boards / sizeof *boards; ++i)
    if (strcmp(type, boards[i]) == 0) return 1;
  return 0;
}

static t_error open_card(struct world* w, const char* type, const char* identifier, t_card* card) {
  const int fault = world_fault(w, FAULT_OPEN);
  if (fault) return fault;
  if (!type || !card) return -INVALID_ARGUMENT;
  if (!identifier) return -IDENTIFIER_IS_NULL;
  if (!is_known_board(type)) return -UNRECOGNIZED_BOARD_TYPE;
  if (strcmp(identifier, "0") != 0) return -BOARD_NOT_FOUND;
  if (w->card.is_open) return -BOARD_ALREADY_OPEN;
  w->card.is_open = 1;
  opened_here = ++w->card.openings;
  *card = &handles[opened_here % CARD_HANDLES];
  return 0;
}

EXPORT t_error hil_open(const char* type, const char* identifier, t_card* card) {
  struct world* w = enter("hil_open");
  return leave(w, open_card(w, type, identifier, card));
}

static void close_card(struct world* w) {
  memset(w->tasks, 0, sizeof w->tasks);
  w->card.is_open = 0;
}

EXPORT t_error hil_close(t_card card) {
  struct world* w = enter("hil_close");
  const t_error bad = check_card(w, card);
  if (bad == 0 || bad == -DEVICE_DISCONNECTED) close_card(w);
  return leave(w, bad == -DEVICE_DISCONNECTED ? 0 : bad);
}

EXPORT t_error hil_close_all(void) {
  struct world* w = enter("hil_close_all");
  close_card(w);
  return leave(w, 0);
}

EXPORT t_boolean hil_is_valid(t_card card) {
  struct world* w = enter("hil_is_valid");
  return (t_boolean)leave(w, check_card(w, card) == 0);
}

struct t_version {
  uint32_t size;
  uint16_t major, minor, release, build;
};
EXPORT t_error hil_get_version(struct t_version* version) {
  struct world* w = enter("hil_get_version");
  if (!version || version->size != sizeof *version) return leave(w, -INVALID_ARGUMENT);
  version->major = 0, version->minor = 1, version->release = 0, version->build = 0;
  return leave(w, 0);
}

/* ---- configuration: first the injected error, then the checks ---- */

static t_error configures(struct world* w, t_card card) {
  const t_error bad = check_card(w, card);
  return bad ? bad : world_fault(w, FAULT_CONFIGURE);
}

EXPORT t_error hil_set_card_specific_options(t_card card, const char* options, size_t size) {
  struct world* w = enter("hil_set_card_specific_options");
  t_error bad = configures(w, card);
  if (!bad && w->refuses_options != 0) bad = -OPTIONS_NOT_SUPPORTED;
  if (!bad && (!options || size > sizeof w->card.options || size != strlen(options) + 1)) bad = -INVALID_ARGUMENT;
  if (!bad && strstr(options, "unknown")) bad = -OPTION_NOT_RECOGNIZED;
  if (bad) return leave(w, bad);
  memcpy(w->card.options, options, size);
  w->card.options_size = (uint32_t)size;
  return leave(w, 0);
}

EXPORT t_error hil_set_analog_input_ranges(t_card card, channels list, uint32_t count, const double low[],
                                           const double high[]) {
  struct world* w = enter("hil_set_analog_input_ranges");
  t_error bad = configures(w, card);
  if (!bad && w->refuses_ranges != 0) bad = -INPUT_RANGES_NOT_SUPPORTED;
  if (!bad) bad = check_channels(list, count, CHANNELS, INVALID_ANALOG_INPUT, low && high ? low : NULL, INVALID_ARGUMENT);
  return leave(w, bad);
}

EXPORT t_error hil_set_analog_output_ranges(t_card card, channels list, uint32_t count, const double low[],
                                            const double high[]) {
  struct world* w = enter("hil_set_analog_output_ranges");
  t_error bad = configures(w, card);
  if (!bad && w->refuses_ranges != 0) bad = -OUTPUT_RANGES_NOT_SUPPORTED;
  if (!bad) bad = check_channels(list, count, CHANNELS, INVALID_ANALOG_OUTPUT, low && high ? low : NULL, INVALID_ARGUMENT);
  for (uint32_t i = 0; !bad && i < count; ++i)
    if (low[i] < -10.8 || high[i] > 10.8 || low[i] >= high[i]) bad = -INVALID_ANALOG_OUTPUT_RANGE;
  for (uint32_t i = 0; !bad && i < count; ++i)
    w->card.output_low[list[i]] = low[i], w->card.output_high[list[i]] = high[i];
  return leave(w, bad);
}

EXPORT t_error hil_set_encoder_counts(t_card card, channels list, uint32_t count, const int32_t counts[]) {
  struct world* w = enter("hil_set_encoder_counts");
  t_error bad = configures(w, card);
  if (!bad) bad = check_channels(list, count, CHANNELS, INVALID_ENCODER_INPUT, counts, INVALID_ARGUMENT);
  for (uint32_t i = 0; !bad && i < count; ++i) {
    w->card.preset[list[i]] = 0;
    w->card.preset[list[i]] = counts[i] - world_counts(w, list[i]);
  }
  return leave(w, bad);
}

EXPORT t_error hil_set_encoder_quadrature_mode(t_card card, channels list, uint32_t count, const int32_t mode[]) {
  struct world* w = enter("hil_set_encoder_quadrature_mode");
  t_error bad = configures(w, card);
  if (!bad) bad = check_channels(list, count, CHANNELS, INVALID_ENCODER_INPUT, mode, INVALID_ARGUMENT);
  for (uint32_t i = 0; !bad && i < count; ++i)
    if (mode[i] != 0 && mode[i] != 1 && mode[i] != 2 && mode[i] != 4) bad = -QUADRATURE_NOT_SUPPORTED;
  for (uint32_t i = 0; !bad && i < count; ++i) w->card.quadrature[list[i]] = mode[i];
  return leave(w, bad);
}

EXPORT t_error hil_set_encoder_filter_frequency(t_card card, channels list, uint32_t count, const double hz[]) {
  struct world* w = enter("hil_set_encoder_filter_frequency");
  t_error bad = configures(w, card);
  if (!bad && w->refuses_filter != 0) bad = -FILTER_NOT_SUPPORTED;
  if (!bad) bad = check_channels(list, count, CHANNELS, INVALID_ENCODER_INPUT, hz, INVALID_ARGUMENT);
  return leave(w, bad);
}

EXPORT t_error hil_set_digital_directions(t_card card, channels in, uint32_t ins, channels out, uint32_t outs) {
  struct world* w = enter("hil_set_digital_directions");
  t_error bad = configures(w, card);
  if (!bad) bad = check_channels(in, ins, DIGITAL_CHANNELS, INVALID_DIGITAL_INPUT, in, INVALID_ARGUMENT);
  if (!bad) bad = check_channels(out, outs, DIGITAL_CHANNELS, INVALID_DIGITAL_OUTPUT, out, INVALID_ARGUMENT);
  return leave(w, bad);
}

/* ---- immediate input ---- */

EXPORT t_error hil_read_encoder(t_card card, channels list, uint32_t count, int32_t counts[]) {
  struct world* w = enter("hil_read_encoder");
  t_error bad = check_card(w, card);
  if (!bad) bad = check_channels(list, count, CHANNELS, INVALID_ENCODER_INPUT, counts, MISSING_ENCODER_INPUT_BUFFER);
  for (uint32_t i = 0; !bad && i < count; ++i) counts[i] = world_counts(w, list[i]);
  return leave(w, bad);
}

EXPORT t_error hil_read_analog(t_card card, channels list, uint32_t count, double volts[]) {
  struct world* w = enter("hil_read_analog");
  t_error bad = check_card(w, card);
  if (!bad) bad = check_channels(list, count, CHANNELS, INVALID_ANALOG_INPUT, volts, MISSING_ANALOG_INPUT_BUFFER);
  for (uint32_t i = 0; !bad && i < count; ++i)
    volts[i] = list[i] == 0 ? w->plant.current * w->analog_per_ampere : w->card.volts[list[i]];
  return leave(w, bad);
}

/* ---- immediate output ---- */

/* A write in protected mode fails or is ignored, depending on the settings: the real card's behavior is unknown. */
static t_error write_analog(struct world* w, t_card card, channels list, uint32_t count, const double volts[]) {
  t_error bad = check_card(w, card);
  if (!bad) bad = world_fault(w, FAULT_WRITE);
  if (!bad) bad = check_channels(list, count, CHANNELS, INVALID_ANALOG_OUTPUT, volts, MISSING_ANALOG_OUTPUT_BUFFER);
  if (bad) return bad;
  if (w->card.is_expired) return -(t_error)w->watchdog_write_error;
  for (uint32_t i = 0; i < count; ++i) world_write(w, list[i], volts[i]);
  if (w->is_real_time == 0 && w->compute > 0) world_advance(w, w->now + (int64_t)(1e9 * w->compute));
  return 0;
}

EXPORT t_error hil_write_analog(t_card card, channels list, uint32_t count, const double volts[]) {
  struct world* w = enter("hil_write_analog");
  return leave(w, write_analog(w, card, list, count, volts));
}

EXPORT t_error hil_write(t_card card, channels analog, uint32_t analogs, channels pwm, uint32_t pwms,
                         channels digital, uint32_t digitals, channels other, uint32_t others, const double volts[],
                         const double duty[], const t_boolean levels[], const double values[]) {
  struct world* w = enter("hil_write");
  (void)other, (void)values;
  t_error bad = w->refuses_write != 0 ? -WRITE_NOT_SUPPORTED : 0;
  if (!bad) bad = check_channels(pwm, pwms, CHANNELS, INVALID_PWM_OUTPUT, duty, INVALID_ARGUMENT);
  if (!bad) bad = check_channels(digital, digitals, DIGITAL_CHANNELS, INVALID_DIGITAL_OUTPUT, levels, INVALID_ARGUMENT);
  if (!bad && others > 0) bad = -OTHER_OUTPUTS_NOT_SUPPORTED;
  if (!bad) bad = write_analog(w, card, analog, analogs, volts);
  for (uint32_t i = 0; !bad && i < digitals; ++i) w->card.digital[digital[i]] = levels[i];
  return leave(w, bad);
}

EXPORT t_error hil_write_digital(t_card card, channels list, uint32_t count, const t_boolean levels[]) {
  struct world* w = enter("hil_write_digital");
  t_error bad = check_card(w, card);
  if (!bad) bad = world_fault(w, FAULT_WRITE);
  if (!bad) bad = check_channels(list, count, DIGITAL_CHANNELS, INVALID_DIGITAL_OUTPUT, levels, INVALID_ARGUMENT);
  for (uint32_t i = 0; !bad && i < count; ++i) w->card.digital[list[i]] = levels[i];
  return leave(w, bad);
}

EXPORT t_error hil_set_analog_termination_state(t_card card, channels list, uint32_t count, const double volts[]) {
  struct world* w = enter("hil_set_analog_termination_state");
  t_error bad = configures(w, card);
  if (!bad && w->refuses_termination != 0) bad = -ANALOG_TERMINATION_NOT_SUPPORTED;
  if (!bad) bad = check_channels(list, count, CHANNELS, INVALID_ANALOG_OUTPUT, volts, INVALID_ARGUMENT);
  for (uint32_t i = 0; !bad && i < count; ++i) w->card.termination[list[i]] = volts[i];
  return leave(w, bad);
}

EXPORT t_error hil_write_termination_states(t_card card) {
  struct world* w = enter("hil_write_termination_states");
  t_error bad = check_card(w, card);
  if (!bad && w->refuses_termination != 0) bad = -TERMINATION_NOT_SUPPORTED;
  if (!bad) bad = world_fault(w, FAULT_WRITE);
  for (uint32_t i = 0; !bad && i < CHANNELS; ++i) world_write(w, i, w->card.termination[i]);
  return leave(w, bad);
}

/* ---- watchdog ---- */

static t_error watches(struct world* w, t_card card, int not_supported) {
  t_error bad = check_card(w, card);
  if (!bad && w->refuses_watchdog != 0) bad = -not_supported;
  return bad;
}

EXPORT t_error hil_watchdog_set_analog_expiration_state(t_card card, channels list, uint32_t count,
                                                        const double volts[]) {
  struct world* w = enter("hil_watchdog_set_analog_expiration_state");
  t_error bad = watches(w, card, EXPIRY_NOT_SUPPORTED);
  if (!bad) bad = world_fault(w, FAULT_CONFIGURE);
  if (!bad) bad = check_channels(list, count, CHANNELS, INVALID_ANALOG_OUTPUT, volts, INVALID_ARGUMENT);
  for (uint32_t i = 0; !bad && i < count; ++i)
    if (w->watchdog_zero_only != 0 && volts[i] != 0) bad = -EXPIRY_NOT_ZERO;
  for (uint32_t i = 0; !bad && i < count; ++i) w->card.expiry[list[i]] = volts[i], w->card.has_expiry[list[i]] = 1;
  return leave(w, bad);
}

EXPORT t_error hil_watchdog_start(t_card card, double timeout_s) {
  struct world* w = enter("hil_watchdog_start");
  t_error bad = watches(w, card, WATCHDOG_START_NOT_SUPPORTED);
  if (!bad) bad = world_fault(w, FAULT_WATCHDOG);
  if (!bad && !(timeout_s > 0)) bad = -FREQUENCY_NOT_POSITIVE;
  if (!bad && timeout_s > w->watchdog_longest) bad = -FREQUENCY_TOO_LOW;
  for (int i = 0; !bad && w->watchdog_needs_all != 0 && i < CHANNELS; ++i)
    if (!w->card.has_expiry[i]) bad = -EXPIRIES_NOT_CONFIGURED;
  if (bad) return leave(w, bad);
  w->card.watchdog_ns = (int64_t)(1e9 * timeout_s);
  w->card.expires_at = w->now + w->card.watchdog_ns;
  w->card.is_watched = 1, w->card.is_expired = 0;
  return leave(w, 0);
}

EXPORT t_error hil_watchdog_reload(t_card card) {
  struct world* w = enter("hil_watchdog_reload");
  t_error bad = watches(w, card, WATCHDOG_RELOAD_NOT_SUPPORTED);
  if (!bad) bad = world_fault(w, FAULT_RELOAD);
  if (bad) return leave(w, bad);
  if (w->card.is_expired || !w->card.is_watched) return leave(w, 0);
  w->card.expires_at = w->now + w->card.watchdog_ns;
  return leave(w, 1);
}

EXPORT t_error hil_watchdog_is_expired(t_card card) {
  struct world* w = enter("hil_watchdog_is_expired");
  const t_error bad = watches(w, card, WATCHDOG_IS_EXPIRED_NOT_SUPPORTED);
  return leave(w, bad ? bad : w->card.is_expired);
}

EXPORT t_error hil_watchdog_stop(t_card card) {
  struct world* w = enter("hil_watchdog_stop");
  const t_error bad = watches(w, card, WATCHDOG_STOP_NOT_SUPPORTED);
  if (!bad) w->card.is_watched = 0;
  return leave(w, bad);
}

EXPORT t_error hil_watchdog_clear(t_card card) {
  struct world* w = enter("hil_watchdog_clear");
  const t_error bad = watches(w, card, WATCHDOG_CLEAR_NOT_SUPPORTED);
  if (!bad) w->card.is_watched = 0, w->card.is_expired = 0;
  return leave(w, bad);
}
