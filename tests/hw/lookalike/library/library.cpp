// A second library with the vendor's symbols, for tests. It is written from public information on the
// interface, independently of hw/emulator and without shared code. Time is the number of samples, the counter
// has 32 bits, and the motor is an exact solution of m dv/dt = u - d v.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <deque>
#include <mutex>
#include <vector>
#include "tests/hw/lookalike/card.h"

namespace {

constexpr int outputs = 8;
constexpr double mass = 0.2621, damping = 2.4, resolution = 2e-7;

struct Sample {
  int32_t counts;
  double volts;
};

LookalikeCard card;
std::recursive_mutex mutex;
double expiry[outputs];
double timeout = 0, deadline = 0;
int32_t preset = 0;

struct Task {
  bool exists = false, is_deleted = false, runs = false, overwrites = false, has_overflowed = false;
  uint32_t capacity = 0, analogs = 0, encoders = 0, others = 0;
  std::vector<uint32_t> analog_channels, encoder_channels;
  double period = 0;
  int64_t taken = 0;
  int32_t dropped = 0;
  std::deque<Sample> buffer;
} task;

char card_handle, task_handle;

int32_t counts() { return preset + int32_t(std::floor(card.position / resolution)); }

void pass(double seconds) {
  while (seconds > 0) {
    const bool expires = card.is_watched && card.time + seconds >= deadline;
    const double step = expires ? std::max(0.0, deadline - card.time) : seconds;
    const double decay = std::exp(-damping / mass * step), rest = card.volts[0] / damping;
    card.position += rest * step + (card.velocity - rest) * mass / damping * (1 - decay);
    card.velocity = rest + (card.velocity - rest) * decay;
    card.time += step, seconds -= step;
    if (!expires) continue;
    card.is_watched = false, card.has_expired = true;
    std::memcpy(card.volts, expiry, sizeof expiry);
  }
}

bool is_unplugged() { return card.unplugged_from >= 0 && task.taken >= card.unplugged_from; }

void take_sample() {
  pass(task.period);
  const int64_t index = task.taken++;
  const Sample sample{counts(), index == card.strange_at ? card.strange : card.volts[0]};
  if (index >= card.lost_from && card.lost_from >= 0 && index < card.lost_from + card.lost) {
    ++task.dropped;
    return;
  }
  if (task.buffer.size() == task.capacity) {
    ++task.dropped;
    if (!task.overwrites) {
      task.has_overflowed = true;
      return;
    }
    task.buffer.pop_front();
  }
  task.buffer.push_back(sample);
}

/// Every call counts, and an unplugged card answers no call.
int32_t begin(const void* handle) {
  ++card.calls;
  if (handle != &card_handle || !card.is_open) return -88;
  return is_unplugged() ? -1160 : 0;
}

using Lock = std::scoped_lock<std::recursive_mutex>;

}  // namespace

extern "C" {

LookalikeCard* lookalike_reset() {
  card = {}, task = {};
  std::memset(expiry, 0, sizeof expiry);
  timeout = deadline = 0, preset = 0;
  return &card;
}

int32_t hil_open(const char* type, const char* identifier, void** handle) {
  const Lock lock(mutex);
  ++card.calls;
  if (std::strcmp(type, "qpid_e") != 0) return -179;
  if (std::strcmp(identifier, "0") != 0) return -108;
  if (card.is_open) return -109;  // the other of the two reports it
  card.is_open = true, *handle = &card_handle;
  return 0;
}
int32_t hil_close(void* handle) {
  const Lock lock(mutex);
  if (begin(handle) == -88) return -88;
  card.is_open = false, task = {};
  return 0;
}
int32_t hil_close_all() {
  const Lock lock(mutex);
  ++card.calls;
  card.is_open = false, task = {};
  return 0;
}

int32_t hil_write_analog(void* handle, const uint32_t* channels, uint32_t count, const double* volts) {
  const Lock lock(mutex);
  if (const int32_t error = begin(handle)) return error;
  for (uint32_t i = 0; i < count; ++i)
    if (channels[i] >= outputs) return -133;
  if (card.has_expired) return card.stays_expired_in_silence ? 0 : -1202;
  if (++card.writes > card.refused_from && card.refused_from >= 0) return -1160;
  for (uint32_t i = 0; i < count; ++i) {
    if (!card.is_watched) card.unwatched_peak = std::fmax(card.unwatched_peak, std::fabs(volts[i]));
    const double code = std::round(std::fmin(std::fmax(volts[i], -10), 10) * 3276.7);
    card.volts[channels[i]] = code / 3276.7;
  }
  return 0;
}
int32_t hil_set_encoder_counts(void* handle, const uint32_t*, uint32_t count, const int32_t* wanted) {
  const Lock lock(mutex);
  if (const int32_t error = begin(handle)) return error;
  if (count > 0) preset += wanted[0] - counts();
  return 0;
}

int32_t hil_task_create_reader(void* handle, uint32_t capacity, const uint32_t* analog, uint32_t analogs,
                               const uint32_t* encoder, uint32_t encoders, const uint32_t*, uint32_t digitals,
                               const uint32_t*, uint32_t others, void** created) {
  const Lock lock(mutex);
  if (const int32_t error = begin(handle)) return error;
  if (capacity == 0) return -320;
  if (digitals > 0 || others > 0) return -482;
  task = {};
  task.exists = true, task.capacity = capacity, task.analogs = analogs, task.encoders = encoders;
  task.analog_channels.assign(analog, analog + analogs),
      task.encoder_channels.assign(encoder, encoder + encoders);
  *created = &task_handle;
  return 0;
}
int32_t hil_task_set_buffer_overflow_mode(void*, int32_t mode) {
  const Lock lock(mutex);
  if (mode != 0 && mode != 1) return -1265;
  task.overwrites = mode == 1;
  return 0;
}
int32_t hil_task_get_buffer_overflows(void*) {
  const Lock lock(mutex);
  return is_unplugged() ? -1160 : task.dropped;
}
int32_t hil_task_start(void*, int32_t clock, double frequency, uint32_t) {
  const Lock lock(mutex);
  if (clock != 0) return -144;
  if (!(frequency > 0)) return -149;
  task.period = 1 / frequency, task.runs = true;
  return 0;
}
int32_t hil_task_stop(void*) {
  const Lock lock(mutex);
  task.runs = false, card.stops_after_delete += task.is_deleted;
  return is_unplugged() ? -1160 : 0;
}
int32_t hil_task_delete(void*) {
  const Lock lock(mutex);
  task = {}, task.is_deleted = true;
  if (card.in_delete) card.in_delete();
  return 0;
}
int32_t hil_task_read(void*, uint32_t samples, double* analog, int32_t* encoder, char*, double*) {
  const Lock lock(mutex);
  ++card.calls;
  if (samples != 1) return -159;
  while (task.buffer.empty() && task.runs && !task.has_overflowed && !is_unplugged()) take_sample();
  if (is_unplugged()) return -1160;
  if (card.error_from >= 0 && task.taken > card.error_from) return card.read_error;
  if (task.has_overflowed) return -111;
  if (task.buffer.empty()) return 0;
  const Sample sample = task.buffer.front();
  task.buffer.pop_front();
  for (uint32_t i = 0; i < task.analogs; ++i) analog[i] = task.analog_channels[i] == 0 ? sample.volts : 0;
  for (uint32_t i = 0; i < task.encoders; ++i) encoder[i] = task.encoder_channels[i] == 0 ? sample.counts : 0;
  if (task.taken - 1 == card.stalled_at)
    for (double left = card.stalled_for; left > 0; left -= task.period) take_sample();
  return 1;
}

int32_t hil_watchdog_set_analog_expiration_state(void* handle, const uint32_t* channels, uint32_t count,
                                                 const double* volts) {
  const Lock lock(mutex);
  if (const int32_t error = begin(handle)) return error;
  if (count != outputs) return -604;  // all or none
  for (uint32_t i = 0; i < count; ++i) expiry[channels[i]] = volts[i];
  return 0;
}
int32_t hil_watchdog_start(void* handle, double seconds) {
  const Lock lock(mutex);
  if (const int32_t error = begin(handle)) return error;
  if (!(seconds > 0) || seconds > 0.419) return -151;
  timeout = seconds, deadline = card.time + seconds, card.is_watched = true;
  return 0;
}
int32_t hil_watchdog_reload(void* handle) {
  const Lock lock(mutex);
  if (const int32_t error = begin(handle)) return error;
  if (!card.is_watched) return 0;
  deadline = card.time + timeout;
  return 1;
}
int32_t hil_watchdog_is_expired(void* handle) {
  const Lock lock(mutex);
  if (const int32_t error = begin(handle)) return error;
  return card.has_expired;
}
int32_t hil_watchdog_stop(void* handle) {
  const Lock lock(mutex);
  if (const int32_t error = begin(handle)) return error;
  card.is_watched = false;
  return 0;
}
int32_t hil_watchdog_clear(void* handle) {
  const Lock lock(mutex);
  if (const int32_t error = begin(handle)) return error;
  card.is_watched = card.has_expired = false;
  return 0;
}
int32_t msg_get_error_messageA(const char*, int32_t code, char* text, size_t size) {
  return std::snprintf(text, size, "Second library, error %d.", -code);
}

}  // extern "C"
