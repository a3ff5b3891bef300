/// What a test sees of the card behind the second library.
#pragma once
#include <cstdint>

/// Everything in SI units and volts; time is virtual and goes on with every sample that is read.
struct LookalikeCard {
  // what a test sets
  int32_t read_error = 0;                // returned by hil_task_read from sample `error_from` on, negative
  int64_t error_from = -1;               // sample; -1: never
  int64_t unplugged_from = -1;           // sample
  int64_t lost_from = -1;                // first sample that the buffer drops and counts
  int64_t lost = 0;                      // how many
  int64_t stalled_at = -1;               // sample after which the reader's computer sleeps …
  double stalled_for = 0;                // … so long [s]
  int64_t strange_at = -1;               // sample in which analog input 0 reads `strange`
  double strange = 0;                    // V
  bool stays_expired_in_silence = true;  // writes after expiry answer 0; else -1202
  // what it looks at
  double volts[8] = {};
  double position = 0, velocity = 0;
  double time = 0;
  bool is_open = false, is_watched = false, has_expired = false;
  int64_t calls = 0;
};

/// A card as after power-on, and the way to it.
using LookalikeReset = LookalikeCard*();
