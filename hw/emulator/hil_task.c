/* Tasks that sample the inputs into a buffer, timed by a clock of the card. */
#include <string.h>
#include <time.h>

#include "hil_abi.h"

struct tag_task {
  int unused;
};
static struct tag_task handles[CLOCK_TASKS];

t_error check_task(const struct world* w, t_task task, struct task** found) {
  for (int i = 0; i < CLOCK_TASKS; ++i)
    if (task == &handles[i] && w->tasks[i].is_created && is_own(w)) {
      *found = (struct task*)&w->tasks[i];
      return w->is_unplugged ? -DEVICE_DISCONNECTED : 0;
    }
  return -INVALID_TASK_HANDLE;
}

/* ---- creation ---- */

struct inputs {
  channels list[4];
  uint32_t count[4];
};

static t_error check_inputs(const struct inputs* in) {
  static const uint32_t limit[3] = {CHANNELS, CHANNELS, DIGITAL_CHANNELS};
  static const int code[3] = {INVALID_ANALOG_INPUT, INVALID_ENCODER_INPUT, INVALID_DIGITAL_INPUT};
  for (int kind = 0; kind < 3; ++kind) {
    const t_error bad = check_channels(in->list[kind], in->count[kind], limit[kind], code[kind], in, INVALID_ARGUMENT);
    if (bad) return bad;
  }
  for (uint32_t i = 0; i < in->count[3]; ++i)
    if (!in->list[3] || in->list[3][i] < OTHER_VELOCITY || in->list[3][i] >= OTHER_VELOCITY + CHANNELS)
      return -INVALID_OTHER_INPUT;
  return 0;
}

static t_error create_reader(struct world* w, t_card card, uint32_t capacity, const struct inputs* in, t_task* task) {
  t_error bad = check_card(w, card);
  if (!bad) bad = world_fault(w, FAULT_CREATE);
  if (!bad && !task) bad = -INVALID_ARGUMENT;
  if (!bad && capacity == 0) bad = -INVALID_BUFFER_SIZE;
  if (!bad && capacity > LARGEST_BUFFER) bad = -OUT_OF_MEMORY;
  if (!bad) bad = check_inputs(in);
  if (bad) return bad;
  for (int i = 0; i < CLOCK_TASKS; ++i) {
    struct task* t = &w->tasks[i];
    if (t->is_created) continue;
    memset(t, 0, sizeof *t);
    t->is_created = 1, t->capacity = capacity;
    for (int kind = 0; kind < 4; ++kind) {
      t->counts[kind] = in->count[kind];
      if (in->count[kind]) memcpy(t->channels[kind], in->list[kind], in->count[kind] * sizeof(uint32_t));
    }
    *task = &handles[i];
    return 0;
  }
  return -OUT_OF_MEMORY;
}

EXPORT t_error hil_task_create_reader(t_card card, uint32_t capacity, channels analog, uint32_t analogs,
                                      channels encoder, uint32_t encoders, channels digital, uint32_t digitals,
                                      channels other, uint32_t others, t_task* task) {
  struct world* w = enter("hil_task_create_reader");
  const struct inputs in = {{analog, encoder, digital, other}, {analogs, encoders, digitals, others}};
  return leave(w, create_reader(w, card, capacity, &in, task));
}

EXPORT t_error hil_task_create_encoder_reader(t_card card, uint32_t capacity, channels encoder, uint32_t encoders,
                                              t_task* task) {
  struct world* w = enter("hil_task_create_encoder_reader");
  const struct inputs in = {{NULL, encoder, NULL, NULL}, {0, encoders, 0, 0}};
  return leave(w, create_reader(w, card, capacity, &in, task));
}

EXPORT t_error hil_task_create_analog_reader(t_card card, uint32_t capacity, channels analog, uint32_t analogs,
                                             t_task* task) {
  struct world* w = enter("hil_task_create_analog_reader");
  const struct inputs in = {{analog, NULL, NULL, NULL}, {analogs, 0, 0, 0}};
  return leave(w, create_reader(w, card, capacity, &in, task));
}

/* ---- start and stop ---- */

static int clock_is_taken(const struct world* w, int clock) {
  for (const struct task* t = w->tasks; t < w->tasks + CLOCK_TASKS; ++t)
    if (t->is_running && t->clock == clock) return 1;
  return 0;
}

/* Clock 0 is a 24-bit counter at 40 MHz, clock 1 the watchdog's; the system's timer has a resolution of 1 ms. */
static t_error check_frequency(int clock, double hz) {
  if (!(hz > 0)) return -FREQUENCY_NOT_POSITIVE;
  if (clock < 0) return hz > 1000 ? -FREQUENCY_TOO_HIGH : 0;
  if (hz > 100e3) return -FREQUENCY_TOO_HIGH;
  return hz < 40e6 / (1 << 24) ? -FREQUENCY_TOO_LOW : 0;
}

static t_error start(struct world* w, t_task handle, int32_t clock, double hz, uint32_t samples) {
  struct task* t = NULL;
  t_error bad = check_task(w, handle, &t);
  if (!bad) bad = world_fault(w, FAULT_START);
  if (!bad && (clock < -1 || clock >= CLOCKS || clock == 1)) bad = -CLOCK_NOT_SUPPORTED;
  if (!bad) bad = check_frequency(clock, hz);
  if (!bad && clock_is_taken(w, clock)) bad = -HARDWARE_CLOCK_IN_USE;
  if (bad) return bad;
  t->clock = clock, t->wanted = samples == UINT32_MAX ? -1 : (int64_t)samples;
  t->start_ns = w->now, t->period_ns = (int64_t)(1e9 / hz + 0.5);
  t->samples = 0, t->head = t->stored = 0, t->overflows = 0, t->has_overflowed = 0, t->is_finished = 0;
  t->is_running = 1;
  return 0;
}

EXPORT t_error hil_task_start(t_task task, int32_t clock, double hz, uint32_t samples) {
  struct world* w = enter("hil_task_start");
  return leave(w, start(w, task, clock, hz, samples));
}

EXPORT t_error hil_task_stop(t_task task) {
  struct world* w = enter("hil_task_stop");
  struct task* t = NULL;
  t_error bad = check_task(w, task, &t);
  if (t) t->is_running = 0; /* also for an unplugged card: a blocked read ends */
  if (!bad) bad = world_fault(w, FAULT_STOP);
  return leave(w, bad);
}

EXPORT t_error hil_task_stop_all(t_card card) {
  struct world* w = enter("hil_task_stop_all");
  const t_error bad = check_card(w, card);
  for (int i = 0; i < CLOCK_TASKS; ++i) w->tasks[i].is_running = 0;
  return leave(w, bad);
}

EXPORT t_error hil_task_delete(t_task task) {
  struct world* w = enter("hil_task_delete");
  struct task* t = NULL;
  const t_error bad = check_task(w, task, &t);
  if (t) memset(t, 0, sizeof *t);
  return leave(w, bad == -DEVICE_DISCONNECTED ? 0 : bad);
}

EXPORT t_error hil_task_delete_all(t_card card) {
  struct world* w = enter("hil_task_delete_all");
  const t_error bad = check_card(w, card);
  memset(w->tasks, 0, sizeof w->tasks);
  return leave(w, bad == -DEVICE_DISCONNECTED ? 0 : bad);
}

EXPORT t_error hil_task_flush(t_task task) {
  struct world* w = enter("hil_task_flush");
  struct task* t = NULL;
  const t_error bad = check_task(w, task, &t);
  if (!bad) t->head = t->stored = 0;
  return leave(w, bad);
}

EXPORT t_boolean hil_task_is_valid(t_task task) {
  struct world* w = enter("hil_task_is_valid");
  struct task* t = NULL;
  return (t_boolean)leave(w, check_task(w, task, &t) == 0);
}

EXPORT t_error hil_task_set_buffer_overflow_mode(t_task task, int32_t mode) {
  struct world* w = enter("hil_task_set_buffer_overflow_mode");
  struct task* t = NULL;
  t_error bad = check_task(w, task, &t);
  if (!bad && w->refuses_overflow_mode != 0) bad = -OVERFLOW_MODE_NOT_SUPPORTED;
  if (!bad && (mode < 0 || mode > 4)) bad = -INVALID_BUFFER_MODE;
  if (!bad && mode > 2) bad = -BUFFER_MODE_NOT_SUPPORTED; /* for simulated cards */
  if (!bad) t->overflow_mode = mode;
  return leave(w, bad);
}

EXPORT t_error hil_task_get_buffer_overflows(t_task task) {
  struct world* w = enter("hil_task_get_buffer_overflows");
  struct task* t = NULL;
  const t_error bad = check_task(w, task, &t);
  return leave(w, bad ? bad : t->overflows);
}

/* ---- reading ---- */

static void sleep_ns(int64_t ns) {
  const struct timespec t = {ns / 1000000000, ns % 1000000000};
  nanosleep(&t, NULL);
}

/* Advances time to the next sample. Virtual time jumps. Real time is waited for, unlocked, in pieces of at most
 * half a millisecond, so that a stop from another thread is noticed. */
static struct world* pass_time(struct world* w, const struct task* t, int hangs) {
  const int64_t next = t->start_ns + (t->samples + 1) * t->period_ns;
  if (w->is_real_time == 0 && !hangs) {
    world_advance(w, next);
    return w;
  }
  const int64_t left = hangs ? 500000 : next - w->now;
  world_unlock(w);
  sleep_ns(left < 500000 ? left : 500000);
  return world_lock();
}

struct destination {
  double* analog;
  int32_t* encoder;
  t_boolean* digital;
  double* other;
};

static void copy_out(const struct task* t, const struct sample* s, uint32_t row, const struct destination* to) {
  for (uint32_t i = 0; i < t->counts[0]; ++i) to->analog[row * t->counts[0] + i] = s->analog[t->channels[0][i]];
  for (uint32_t i = 0; i < t->counts[1]; ++i) to->encoder[row * t->counts[1] + i] = s->encoder[t->channels[1][i]];
  for (uint32_t i = 0; i < t->counts[2]; ++i) to->digital[row * t->counts[2] + i] = 0;
  for (uint32_t i = 0; i < t->counts[3]; ++i)
    to->other[row * t->counts[3] + i] = s->velocity[t->channels[3][i] - OTHER_VELOCITY];
}

static t_error check_buffers(const struct task* t, const struct destination* to) {
  if (t->counts[0] && !to->analog) return -MISSING_ANALOG_INPUT_BUFFER;
  if (t->counts[1] && !to->encoder) return -MISSING_ENCODER_INPUT_BUFFER;
  if (t->counts[2] && !to->digital) return -MISSING_DIGITAL_INPUT_BUFFER;
  return t->counts[3] && !to->other ? -MISSING_OTHER_INPUT_BUFFER : 0;
}

/* Number of samples returned; fewer, even none, once the task is stopped or finished. */
static t_error read_task(struct world** world, t_task handle, uint32_t wanted, const struct destination* to) {
  struct task* t = NULL;
  t_error bad = check_task(*world, handle, &t);
  if (!bad) bad = world_fault(*world, FAULT_READ);
  if (!bad) bad = check_buffers(t, to);
  if (!bad && wanted > t->capacity) bad = -TOO_MANY_SAMPLES;
  if (bad) return bad;
  const int hangs = (*world)->hang_at >= 0 && (double)(*world)->reads >= (*world)->hang_at;
  ++(*world)->reads;
  uint32_t row = 0;
  while (row < wanted) {
    if (t->has_overflowed) return -BUFFER_OVERFLOW;
    if (t->stored == 0 || hangs) {
      if (!t->is_running) break;
      *world = pass_time(*world, t, hangs);
      if (check_task(*world, handle, &t) != 0) return t ? -DEVICE_DISCONNECTED : -INVALID_TASK_HANDLE;
      continue;
    }
    copy_out(t, &t->ring[t->head], row++, to);
    t->head = (t->head + 1) % t->capacity, --t->stored;
  }
  return (t_error)row;
}

/* A stall of the reader's computer: the sample is available, but the reader wakes up late. */
static void stall(struct world* w, int64_t read) {
  if (w->is_real_time == 0 && w->stall_at >= 0 && (double)read == w->stall_at)
    world_advance(w, w->now + (int64_t)(1e9 * w->stall_seconds));
}

EXPORT t_error hil_task_read(t_task task, uint32_t samples, double analog[], int32_t encoder[], t_boolean digital[],
                             double other[]) {
  struct world* w = enter("hil_task_read");
  const struct destination to = {analog, encoder, digital, other};
  const t_error answer = read_task(&w, task, samples, &to);
  if (answer > 0) stall(w, w->reads - 1);
  return leave(w, answer);
}

EXPORT t_error hil_task_read_encoder(t_task task, uint32_t samples, int32_t counts[]) {
  struct world* w = enter("hil_task_read_encoder");
  const struct destination to = {NULL, counts, NULL, NULL};
  return leave(w, read_task(&w, task, samples, &to));
}

EXPORT t_error hil_task_read_analog(t_task task, uint32_t samples, double volts[]) {
  struct world* w = enter("hil_task_read_analog");
  const struct destination to = {volts, NULL, NULL, NULL};
  return leave(w, read_task(&w, task, samples, &to));
}
