/// The vendor's functions as an independent program would declare them, without any code of Loopwright.
#pragma once
#include <cstddef>
#include <cstdint>

extern "C" {
struct tag_card;
struct tag_task;
int hil_open(const char*, const char*, tag_card**);
int hil_close(tag_card*);
int hil_set_card_specific_options(tag_card*, const char*, size_t);
int hil_set_analog_output_ranges(tag_card*, const uint32_t*, uint32_t, const double*, const double*);
int hil_set_encoder_counts(tag_card*, const uint32_t*, uint32_t, const int32_t*);
int hil_set_encoder_quadrature_mode(tag_card*, const uint32_t*, uint32_t, const int32_t*);
int hil_read_encoder(tag_card*, const uint32_t*, uint32_t, int32_t*);
int hil_read_analog(tag_card*, const uint32_t*, uint32_t, double*);
int hil_read_digital(tag_card*, const uint32_t*, uint32_t, char*);
int hil_write_analog(tag_card*, const uint32_t*, uint32_t, const double*);
int hil_task_create_reader(tag_card*, uint32_t, const uint32_t*, uint32_t, const uint32_t*, uint32_t,
                           const uint32_t*, uint32_t, const uint32_t*, uint32_t, tag_task**);
int hil_task_set_buffer_overflow_mode(tag_task*, int);
int hil_task_get_buffer_overflows(tag_task*);
int hil_task_start(tag_task*, int, double, uint32_t);
int hil_task_read(tag_task*, uint32_t, double*, int32_t*, char*, double*);
int hil_task_stop(tag_task*);
int hil_task_delete(tag_task*);
int hil_watchdog_set_analog_expiration_state(tag_card*, const uint32_t*, uint32_t, const double*);
int hil_watchdog_start(tag_card*, double);
int hil_watchdog_reload(tag_card*);
int hil_watchdog_is_expired(tag_card*);
int hil_watchdog_clear(tag_card*);
int hil_emu_set(const char*, double);
double hil_emu_get(const char*);
}
