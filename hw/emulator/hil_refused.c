/* Functions that the library exports but this card lacks: each returns its own "not supported" error. */
#include <stdio.h>
#include <string.h>

#include "hil_abi.h"

/* The arguments are not read, so one signature fits all. */
#define REFUSED(name, code) \
  EXPORT t_error name(void) { return leave(enter(#name), -(code)); }

REFUSED(hil_acquire_exclusive_access, 543)
REFUSED(hil_release_exclusive_access, 544)
REFUSED(hil_set_analog_input_configuration, 1148)
REFUSED(hil_set_digital_output_configuration, 715)
REFUSED(hil_set_clock_mode, 463)
REFUSED(hil_set_clock_frequency, 833)
REFUSED(hil_set_pwm_mode, 470)
REFUSED(hil_set_pwm_configuration, 716)
REFUSED(hil_set_pwm_deadband, 717)
REFUSED(hil_set_pwm_frequency, 469)
REFUSED(hil_set_pwm_duty_cycle, 468)
REFUSED(hil_get_double_property, 676)
REFUSED(hil_set_integer_property, 678)
REFUSED(hil_set_double_property, 679)
REFUSED(hil_set_string_property, 680)
REFUSED(hil_write_pwm, 513)
REFUSED(hil_write_other, 511)
REFUSED(hil_read_analog_codes, 442)
REFUSED(hil_write_analog_codes, 507)
REFUSED(hil_read_digital, 446)
REFUSED(hil_read_other, 454)
REFUSED(hil_read, 439)
REFUSED(hil_read_write, 458)
REFUSED(hil_read_analog_write_analog, 443)
REFUSED(hil_read_encoder_write_pwm, 452)
REFUSED(hil_read_digital_write_digital, 448)
REFUSED(hil_read_other_write_other, 456)
REFUSED(hil_task_create_digital_reader, 473)
REFUSED(hil_task_create_other_reader, 478)
REFUSED(hil_task_create_analog_writer, 608)
REFUSED(hil_task_create_digital_writer, 475)
REFUSED(hil_task_create_other_writer, 480)
REFUSED(hil_task_create_pwm_writer, 481)
REFUSED(hil_task_create_writer, 484)
REFUSED(hil_task_create_reader_writer, 483)
REFUSED(hil_task_read_digital, 490)
REFUSED(hil_task_read_other, 494)
REFUSED(hil_task_write, 499)
REFUSED(hil_task_write_analog, 500)
REFUSED(hil_task_read_write, 496)
REFUSED(hil_watchdog_set_digital_expiration_state, 592)
REFUSED(hil_watchdog_set_pwm_expiration_state, 593)
REFUSED(hil_watchdog_set_other_expiration_state, 594)
REFUSED(hil_set_digital_termination_state, 975)
REFUSED(hil_set_pwm_termination_state, 976)
REFUSED(hil_set_other_termination_state, 977)
REFUSED(hil_poll_interrupt, 819)
REFUSED(hil_monitor_create_interrupt_reader, 822)
REFUSED(hil_monitor_start, 823)
REFUSED(hil_monitor_stop, 824)
REFUSED(hil_monitor_delete, 825)
REFUSED(hil_monitor_read_interrupt, 826)

enum { ANALOG_INPUTS = 16, ENCODER_INPUTS, DIGITAL_INPUTS, OTHER_INPUTS, ANALOG_OUTPUTS, PWM_OUTPUTS, DIGITAL_OUTPUTS };

EXPORT t_error hil_get_integer_property(t_card card, const int32_t property[], uint32_t count, int32_t value[]) {
  struct world* w = enter("hil_get_integer_property");
  t_error bad = check_card(w, card);
  for (uint32_t i = 0; !bad && i < count; ++i) {
    const int32_t p = property[i];
    const int has_eight = p == ANALOG_INPUTS || p == ENCODER_INPUTS || p == OTHER_INPUTS || p == ANALOG_OUTPUTS;
    value[i] = has_eight ? CHANNELS : p == DIGITAL_INPUTS || p == DIGITAL_OUTPUTS ? DIGITAL_CHANNELS : 0;
  }
  return leave(w, bad);
}

EXPORT t_error hil_get_string_property(t_card card, int32_t property, char* text, size_t size) {
  struct world* w = enter("hil_get_string_property");
  static const char* const values[] = {"Nobody", "Emulated card", "emulator", "0", "1"};
  t_error bad = check_card(w, card);
  if (!bad && (property < 0 || property > 4 || !text || size == 0)) bad = -INVALID_ARGUMENT;
  if (!bad) snprintf(text, size, "%s", values[property]);
  return leave(w, bad);
}
