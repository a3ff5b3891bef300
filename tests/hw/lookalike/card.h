/// The test's access to the card behind the second library.
#pragma once
#include <cstdint>

/// Everything in SI units and volts. Time is virtual and advances with every sample that is read.
struct LookalikeCard {
  // set by a test
  int32_t read_error = 0;                // returned by hil_task_read from sample `error_from` on, negative
  int64_t error_from = -1;               // sample; -1: never
  int64_t unplugged_from = -1;           // sample
  int64_t lost_from = -1;                // first sample that the buffer drops and counts
  int64_t lost = 0;                      // how many
  int64_t stalled_at = -1;               // sample after which the reader's computer sleeps …
  double stalled_for = 0;                // … for this time [s]
  int64_t strange_at = -1;               // sample in which analog input 0 reads `strange`
  double strange = 0;                    // V
  int64_t refused_from = -1;             // write of analog outputs from which on all are refused
  void (*in_delete)() = nullptr;         // called while the task is deleted
  bool stays_expired_in_silence = true;  // writes after expiry return 0; else -1202
  // observed by a test
  double volts[8] = {};
  double position = 0, velocity = 0;
  double time = 0;
  bool is_open = false, is_watched = false, has_expired = false;
  int64_t calls = 0, writes = 0;
  int64_t stops_after_delete = 0;  // of a task that was deleted
  double unwatched_peak = 0;       // V, greatest output while the watchdog was not armed
};

/// A card as after power-on, and the access to it.
using LookalikeReset = LookalikeCard*();
