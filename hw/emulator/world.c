#include "world.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

static const uint64_t magic = 0x6c69682d656d7531;
static struct world own;
static struct world* the_world;
static pthread_once_t once = PTHREAD_ONCE_INIT;

static int64_t system_ns(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

void world_reset(struct world* w) {
  pthread_mutex_t lock = w->lock;
  memset(w, 0, sizeof *w);
  w->lock = lock;
  w->magic = magic;
  w->origin = system_ns();
  w->resolution = 2e-7, w->encoder_bits = 24, w->encoder_sign = 1, w->encoder_scale = 1;
  w->dac_bits = 16;
  w->analog_per_ampere = 1;
  w->watchdog_longest = 0.419, w->watchdog_write_error = 1202;
  w->lose_length = 1, w->bad_count = 1;
  w->unplug_at = w->lose_from = w->bad_from = w->stall_at = w->glitch_at = w->stuck_at = w->hang_at = -1;
  w->random = 1;
  for (int i = 0; i < CHANNELS; ++i)
    w->card.output_low[i] = -10, w->card.output_high[i] = 10, w->card.quadrature[i] = 4;
  plant_reset(&w->plant);
}

void world_create_shared(struct world* w) {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setpshared(&attributes, PTHREAD_PROCESS_SHARED);
  pthread_mutexattr_setrobust(&attributes, PTHREAD_MUTEX_ROBUST); /* a client may be killed inside a call */
  pthread_mutex_init(&w->lock, &attributes);
  world_reset(w);
}

static struct world* shared_world(const char* path) {
  const int file = open(path, O_RDWR);
  if (file < 0) return NULL;
  void* memory = mmap(NULL, sizeof(struct world), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (memory == MAP_FAILED || ((struct world*)memory)->magic != magic) return NULL;
  return memory;
}

static void make_world(void) {
  const char* shared = getenv("HIL_EMU_SHARED");
  const char* settings = getenv("HIL_EMU");
  if (shared && *shared) {
    the_world = shared_world(shared);
    if (!the_world) {
      fprintf(stderr, "hil emulator: %s is no world of a daemon\n", shared);
      abort();
    }
    return;
  }
  the_world = &own;
  pthread_mutex_init(&own.lock, NULL);
  world_reset(&own);
  if (settings && *settings && !settings_read(&own, settings)) abort();
}

struct world* world_lock(void) {
  pthread_once(&once, make_world);
  if (pthread_mutex_lock(&the_world->lock) == EOWNERDEAD) pthread_mutex_consistent(&the_world->lock);
  world_advance(the_world, world_clock(the_world));
  return the_world;
}

void world_unlock(struct world* w) { pthread_mutex_unlock(&w->lock); }

int64_t world_clock(const struct world* w) {
  if (w->is_real_time == 0) return w->now;
  return (int64_t)((double)(system_ns() - w->origin) * (1 + 1e-6 * w->drift_ppm));
}

/* ---- encoder and analog inputs ---- */

static int32_t wrapped(int64_t counts, int bits) {
  const uint64_t range = (uint64_t)1 << bits;
  const uint64_t low = (uint64_t)counts & (range - 1);
  return (int32_t)(low >= range / 2 ? (int64_t)(low - range) : (int64_t)low);
}

/* Counts of an encoder line of period 4·resolution in the channel's quadrature mode, with the cable faults. */
int32_t world_counts(struct world* w, uint32_t channel) {
  if (channel != 0) return wrapped(w->card.preset[channel], (int)w->encoder_bits);
  const double edges = w->card.quadrature[0] > 0 ? w->card.quadrature[0] : 1;
  const double seen = w->plant.position * w->encoder_sign * w->encoder_scale * (1 - w->encoder_drift);
  const double edge = floor(seen / (w->resolution * 4 / edges));
  int64_t counts = (fabs(edge) < 1e15 ? (int64_t)edge : 0) + w->card.preset[0]; /* beyond any counter: 0 */
  const double since = (double)w->samples - w->glitch_at;
  if (w->glitch_at >= 0 && since >= 0 && since < w->glitch_count) counts += (int64_t)w->glitch_counts;
  if (w->stuck_at >= 0 && w->samples >= w->stuck_at) return w->stuck_count;
  return w->stuck_count = wrapped(counts, (int)w->encoder_bits);
}

static double noise(struct world* w) { /* uniform in ±1 */
  w->random = w->random * 6364136223846793005u + 1442695040888963407u;
  return (double)(int64_t)w->random / 9223372036854775808.0;
}

static struct sample take_sample(struct world* w) {
  struct sample s;
  memset(&s, 0, sizeof s);
  for (uint32_t i = 0; i < CHANNELS; ++i) s.encoder[i] = world_counts(w, i);
  s.velocity[0] = w->plant.velocity * w->encoder_sign * w->encoder_scale / w->resolution * w->card.quadrature[0] / 4;
  s.analog[0] = w->plant.current * w->analog_per_ampere;
  for (int i = 1; i < CHANNELS; ++i) s.analog[i] = w->card.volts[i]; /* outputs looped back */
  if (w->switch_volts != 0) s.analog[1] = w->plant.position < w->switch_position ? w->switch_volts : 0;
  for (int i = 0; i < CHANNELS; ++i) s.analog[i] += w->analog_noise * noise(w);
  return s;
}

static int is_lost(const struct world* w, int64_t index) {
  const double since = (double)index - w->lose_from;
  if (w->lose_from >= 0 && since >= 0 && since < w->lose_count) return 1;
  return w->lose_every > 0 && (double)index >= w->lose_every && fmod((double)index, w->lose_every) < w->lose_length;
}

/* The action of the card's interrupt at a sample instant. */
static void sample_task(struct world* w, struct task* t) {
  if (w->dac_hold != 0) memcpy(w->card.volts, w->card.pending, sizeof w->card.volts);
  struct sample s = take_sample(w);
  const int64_t index = t->samples++;
  if (t == w->tasks) w->samples = t->samples;
  if (w->unplug_at >= 0 && index >= w->unplug_at) w->is_unplugged = 1;
  if (t->wanted >= 0 && t->samples >= t->wanted) t->is_running = 0, t->is_finished = 1;
  const double since_bad = (double)index - w->bad_from;
  if (w->bad_from >= 0 && since_bad >= 0 && since_bad < w->bad_count) s.analog[0] = w->bad_volts;
  if (w->is_unplugged) return;
  if (is_lost(w, index)) {
    if (w->lose_told != 0 && t->overflow_mode == 1) ++t->overflows;
    return;
  }
  if (t->stored == t->capacity) {
    ++t->overflows;
    if (t->overflow_mode == 0) t->has_overflowed = 1;
    if (t->overflow_mode != 1) return; /* the newest is dropped */
    t->head = (t->head + 1) % t->capacity, --t->stored;
  }
  t->ring[(t->head + t->stored++) % t->capacity] = s;
}

/* ---- outputs and watchdog ---- */

void world_write(struct world* w, uint32_t channel, double volts) {
  struct card* c = &w->card;
  if (isnan(volts)) volts = 0, ++w->dac_latched_nan;
  if (volts > c->output_high[channel]) volts = c->output_high[channel];
  if (volts < c->output_low[channel]) volts = c->output_low[channel];
  if (w->dac_bits > 0) {
    const double lsb = (c->output_high[channel] - c->output_low[channel]) / exp2(w->dac_bits);
    volts = lsb * nearbyint(volts / lsb);
    if (volts > c->output_high[channel] - lsb / 2) volts = c->output_high[channel];
  }
  c->pending[channel] = volts;
  if (w->dac_hold == 0) c->volts[channel] = volts;
}

void world_apply_expiry(struct world* w) {
  for (int i = 0; i < CHANNELS; ++i)
    if (w->card.has_expiry[i]) w->card.volts[i] = w->card.pending[i] = w->card.expiry[i];
}

static void expire(struct world* w) {
  w->card.is_watched = 0, w->card.is_expired = 1, w->card.expired_at = w->now;
  world_apply_expiry(w);
}

/* ---- time ---- */

static int64_t next_sample(const struct task* t) { return t->start_ns + (t->samples + 1) * t->period_ns; }

/* The task whose sample comes next; NULL: none takes one until then. */
static struct task* first_due(struct world* w, int64_t until) {
  struct task* due = NULL;
  for (struct task* t = w->tasks; t < w->tasks + CLOCK_TASKS; ++t)
    if (t->is_running && next_sample(t) <= (due ? next_sample(due) - 1 : until)) due = t;
  return due;
}

/* Every event up to `to` takes place, also several at one instant: a reader waits for a sample that is due, and one
 * that were left out would never come. At one instant samples come before the end of the watchdog's time. */
void world_advance(struct world* w, int64_t to) {
  for (;;) {
    struct task* due = first_due(w, to);
    int64_t next = due ? next_sample(due) : to;
    const int expires = w->card.is_watched && (due ? w->card.expires_at < next : w->card.expires_at <= next);
    if (expires) next = w->card.expires_at;
    if (next > w->now) {
      plant_advance(&w->plant, w->card.volts[0], 1e-9 * (double)w->now, 1e-9 * (double)(next - w->now));
      w->now = next;
    }
    if (expires)
      expire(w);
    else if (due)
      sample_task(w, due);
    else
      return;
  }
}

int world_fault(struct world* w, enum fault_point point) {
  const struct fault* f = &w->faults[point];
  const double since = (double)w->calls_of[point]++ - f->from;
  return f->code != 0 && since >= 0 && (f->count == 0 || since < f->count) ? -(int)f->code : 0;
}
