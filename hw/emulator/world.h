/* The state behind the emulated library: a card, a motor connected to it, and time.
 *
 * No thread runs here. Every call first advances the world to "now": motor, sampling task and watchdog
 * advance in the exact order of their events. So a watchdog expires at its exact instant even if no call was
 * made for some time, and in virtual time every run repeats bit for bit. The world holds no pointers, so it
 * may be in memory that two processes share. */
#ifndef HIL_EMULATOR_WORLD_H
#define HIL_EMULATOR_WORLD_H

#include <pthread.h>
#include <stdint.h>

#include "plant.h"

enum {
  CHANNELS = 8,
  DIGITAL_CHANNELS = 56,
  CLOCKS = 17,
  CLOCK_TASKS = 4,
  LARGEST_BUFFER = 1024,
  CALLS_KEPT = 2000,
  OTHER_VELOCITY = 14000, /* "other" input 14000+n: hardware velocity of encoder n in counts/s */
};

/* Where a fault can be injected: from the n-th call of a group, for a number of calls. */
enum fault_point {
  FAULT_OPEN,
  FAULT_CONFIGURE,
  FAULT_CREATE,
  FAULT_START,
  FAULT_READ,
  FAULT_WRITE,
  FAULT_WATCHDOG,
  FAULT_RELOAD,
  FAULT_STOP,
  FAULT_POINTS
};
struct fault {
  double code;  /* of the error, positive; 0: none */
  double from;  /* first call, from 0 */
  double count; /* how many calls; 0: all later ones */
};

struct sample {
  double analog[CHANNELS];
  double velocity[CHANNELS];
  int32_t encoder[CHANNELS];
};

struct task {
  int is_created, is_running, is_finished, has_overflowed;
  int clock;
  int overflow_mode;
  int overflows;
  uint32_t counts[4]; /* channels: analog, encoder, digital, other */
  uint32_t channels[4][DIGITAL_CHANNELS];
  uint32_t capacity, head, stored;
  int64_t start_ns, period_ns;
  int64_t samples, wanted; /* taken so far; -1: unlimited */
  struct sample ring[LARGEST_BUFFER];
};

struct card {
  int is_open;
  int64_t openings;         /* number of openings */
  double volts[CHANNELS];   /* at the terminals */
  double pending[CHANNELS]; /* written, but held until the next sample */
  double output_low[CHANNELS], output_high[CHANNELS];
  double expiry[CHANNELS];
  int has_expiry[CHANNELS];
  double termination[CHANNELS];
  int32_t quadrature[CHANNELS];
  int32_t preset[CHANNELS]; /* counts to add, from hil_set_encoder_counts */
  int8_t digital[DIGITAL_CHANNELS];
  int is_watched, is_expired;
  int64_t watchdog_ns, expires_at, expired_at;
  char options[2048];
  uint32_t options_size;
};

struct world {
  uint64_t magic;
  pthread_mutex_t lock;
  int64_t now, origin; /* ns since the start; the start by the system's clock */
  /* settings, all numbers so that they can be set by name */
  double is_real_time, drift_ppm;
  double compute; /* s that pass with every write in virtual time */
  double resolution, encoder_bits, encoder_sign, encoder_scale, encoder_drift;
  double dac_bits, dac_hold, dac_latched_nan;
  double analog_noise, analog_per_ampere;
  double switch_position, switch_volts; /* m; volts at analog input 1 below it, 0: there is no switch */
  double watchdog_longest, watchdog_zero_only, watchdog_needs_all;
  double watchdog_write_error; /* of a write after expiry, unspecified by any source; 0: silently ignored */
  double refuses_watchdog, refuses_ranges, refuses_options, refuses_termination, refuses_filter,
      refuses_write, refuses_overflow_mode;
  struct fault faults[FAULT_POINTS];
  double unplug_at;                              /* sample */
  double lose_from, lose_count;                  /* samples that are not stored */
  double lose_every, lose_length;                /* number not stored, repeatedly */
  double lose_told;                              /* counted as overflows, if those drop the oldest */
  double bad_from, bad_count, bad_volts;         /* samples of analog input 0 with this reading */
  double stall_at, stall_seconds;                /* the read of that sample is delayed */
  double glitch_at, glitch_count, glitch_counts; /* samples, counts */
  double stuck_at;                               /* sample */
  double hang_at;                                /* read */
  struct plant plant;
  /* state */
  struct card card;
  struct task tasks[CLOCK_TASKS];
  double position_seen; /* as seen by the encoder, with its faults */
  int64_t calls_of[FAULT_POINTS];
  int64_t samples; /* of the first task */
  int64_t reads;
  int is_unplugged;
  int32_t stuck_count;
  uint64_t random;
  int calls; /* names of the calls made, for tests of their order */
  uint16_t call[CALLS_KEPT];
};

/* The world of this process, created at the first call: from $HIL_EMU, a settings file, and in memory shared
 * with the daemon when $HIL_EMU_SHARED names its file. */
struct world* world_lock(void); /* at "now" */
void world_unlock(struct world* w);
void world_reset(struct world* w);
/* For the process that owns a shared world. */
void world_create_shared(struct world* w);

void world_advance(struct world* w, int64_t to);
int64_t world_clock(const struct world* w); /* "now" by the system's clock; in virtual time, by its own */
int32_t world_counts(struct world* w, uint32_t channel);
void world_write(struct world* w, uint32_t channel, double volts);
void world_apply_expiry(struct world* w);
/* The code of an injected fault, negative, or 0. Counts the call. */
int world_fault(struct world* w, enum fault_point point);

/* settings.c: numbers by name. 0: unknown name. */
int setting_set(struct world* w, const char* name, double value);
int setting_get(const struct world* w, const char* name, double* value);
/* Reads {"name": number, …}; 0 after a message on stderr. */
int settings_read(struct world* w, const char* path);

#endif
