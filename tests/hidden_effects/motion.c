#include "motion.h"

#include <math.h>

#include "hw/emulator/elementary.h"

const char* const trajectory_names[TRAJECTORIES] = {"paper",   "many_speeds", "constant_speeds", "multisine",
                                                    "forward", "held_out",    "oscillation"};

static const double pi = 3.14159265358979323846;

static void change_velocity(Motion* motion, double duration_s, double velocity_m_per_s) {
  const double from = motion->piece_count ? motion->pieces[motion->piece_count - 1].to_m_per_s : 0.0;
  motion->pieces[motion->piece_count++] =
      (Piece){motion->stop_s, duration_s, motion->end_m, from, velocity_m_per_s};
  motion->stop_s += duration_s;
  motion->end_m += 0.5 * (from + velocity_m_per_s) * duration_s;
}

static void rest(Motion* motion, double duration_s) { change_velocity(motion, duration_s, 0.0); }

/// To the right (distance > 0) or left at one speed, and stop. Short strokes stay below the speed.
static void stroke(Motion* motion, double distance_m, double speed_m_per_s, double ramp_s) {
  const double length = fabs(distance_m), sign = distance_m < 0 ? -1.0 : 1.0;
  const double speed = fmin(speed_m_per_s, length / ramp_s);
  change_velocity(motion, ramp_s, sign * speed);
  if (length > speed * ramp_s) change_velocity(motion, length / speed - ramp_s, sign * speed);
  change_velocity(motion, ramp_s, 0.0);
}

/// 600 mm through two speeds, the first over 180 mm, forward (direction 1) or back (−1).
static void two_speed_pass(Motion* motion, double direction, double first_m_per_s, double second_m_per_s) {
  const double ramp = 0.2, first = direction * first_m_per_s, second = direction * second_m_per_s;
  change_velocity(motion, ramp, first);
  change_velocity(motion, (0.18 - 0.5 * ramp * first_m_per_s) / first_m_per_s, first);
  change_velocity(motion, ramp, second);
  const double ramps_m = 0.5 * ramp * (first_m_per_s + second_m_per_s) + 0.5 * ramp * second_m_per_s;
  change_velocity(motion, (0.42 - ramps_m) / second_m_per_s, second);
  change_velocity(motion, ramp, 0.0);
}

static void make_paper(Motion* motion) {
  rest(motion, 0.3);
  for (int pass = 0; pass < 4; ++pass) {
    two_speed_pass(motion, pass % 2 ? -1.0 : 1.0, 0.15, 0.35);
    rest(motion, 0.4);
  }
}

static void make_forward(Motion* motion) {
  rest(motion, 0.3);
  two_speed_pass(motion, 1.0, 0.15, 0.35);
  rest(motion, 0.3);
}

/// Nine speeds forward and back, and strokes of half a millimetre to eight millimetres in between.
static void make_many_speeds(Motion* motion, Random* random) {
  static const double speeds[] = {0.02, 0.30, 0.04, 0.40, 0.20, 0.10, 0.35, 0.15, 0.25};
  static const double lengths[] = {0.05, 0.60, 0.10, 0.60, 0.50, 0.20, 0.60, 0.30, 0.50};
  static const double short_lengths[] = {0.0005, 0.001, 0.002, 0.004, 0.008};
  rest(motion, 0.3);
  for (int i = 0; i < 9; ++i) {
    const double speed = speeds[i] * random_uniform(random, 0.95, 1.05);
    stroke(motion, lengths[i], speed, 0.15);
    rest(motion, 0.1);
    stroke(motion, -lengths[i], speed, 0.15);
    rest(motion, 0.1);
    if (i % 3 == 1) {
      stroke(motion, random_uniform(random, 0.02, 0.3), 0.15, 0.15);
      const double home = motion->end_m;
      for (int j = 0; j < 5; ++j) {
        stroke(motion, short_lengths[j], 0.05, 0.12);
        stroke(motion, -short_lengths[j], 0.05, 0.12);
      }
      stroke(motion, -home, 0.2, 0.15);
    }
  }
}

/// Ten constant speeds forward and back with ramps of one second: hardly any acceleration.
static void make_constant_speeds(Motion* motion, Random* random) {
  static const double speeds[] = {0.02, 0.04, 0.07, 0.10, 0.14, 0.18, 0.23, 0.28, 0.34, 0.40};
  static const double lengths[] = {0.05, 0.10, 0.15, 0.20, 0.30, 0.40, 0.50, 0.55, 0.60, 0.60};
  rest(motion, 0.3);
  for (int i = 0; i < 10; ++i) {
    const double speed = speeds[i] * random_uniform(random, 0.95, 1.05);
    stroke(motion, lengths[i], speed, 1.0);
    rest(motion, 0.2);
    stroke(motion, -lengths[i], speed, 1.0);
    rest(motion, 0.2);
  }
}

/// Slow strokes with an added multisine whose amplitudes decrease with frequency.
static void make_multisine(Motion* motion, Random* random) {
  static const double frequencies[] = {0.7, 1.3, 2.3, 3.7, 6.1, 10.3};
  rest(motion, 0.3);
  motion->sines_start_s = motion->stop_s;
  for (int i = 0; i < 4; ++i) {
    stroke(motion, i % 2 ? -0.58 : 0.58, i < 2 ? 0.06 : 0.12, 0.3);
    rest(motion, 0.5);
  }
  motion->sines_end_s = motion->stop_s;
  rest(motion, 0.3);
  for (int i = 0; i < 6; ++i) {
    const double frequency = frequencies[i] * random_uniform(random, 0.97, 1.03);
    motion->sines[motion->sine_count++] = (Sine){0.045 / (2 * pi * frequency) / sqrt(1 + 0.1 * frequency),
                                                 frequency, random_uniform(random, 0, 2 * pi)};
  }
}

/// Speeds that no training record contains, forward and back, and three short strokes.
static void make_held_out(Motion* motion) {
  rest(motion, 0.3);
  two_speed_pass(motion, 1.0, 0.12, 0.30);
  rest(motion, 0.3);
  two_speed_pass(motion, -1.0, 0.22, 0.26);
  rest(motion, 0.3);
  for (int i = 0; i < 3; ++i) {
    stroke(motion, 0.003, 0.05, 0.12);
    stroke(motion, -0.003, 0.05, 0.12);
  }
  rest(motion, 0.2);
}

/// To the middle of the track, and there two sines: no piece of the motion is steady.
static void make_oscillation(Motion* motion, Random* random) {
  rest(motion, 0.3);
  stroke(motion, 0.3, 0.2, 0.2);
  motion->sines_start_s = motion->stop_s;
  rest(motion, 120);
  motion->sines_end_s = motion->stop_s;
  const double frequency = random_uniform(random, 0.6, 1.0);
  motion->sines[motion->sine_count++] = (Sine){0.17, frequency, random_uniform(random, 0, 2 * pi)};
  motion->sines[motion->sine_count++] = (Sine){0.05, 1.62 * frequency, random_uniform(random, 0, 2 * pi)};
  stroke(motion, -0.3, 0.2, 0.2);
  rest(motion, 0.3);
}

Motion motion_make(Trajectory trajectory, Random* random) {
  Motion motion = {.piece_count = 0};
  switch (trajectory) {
    case PAPER:
      make_paper(&motion);
      break;
    case MANY_SPEEDS:
      make_many_speeds(&motion, random);
      break;
    case CONSTANT_SPEEDS:
      make_constant_speeds(&motion, random);
      break;
    case MULTISINE:
      make_multisine(&motion, random);
      break;
    case FORWARD:
      make_forward(&motion);
      break;
    case OSCILLATION:
      make_oscillation(&motion, random);
      break;
    default:
      make_held_out(&motion);
      break;
  }
  return motion;
}

/// v = v0 + (v1 − v0)(1 − cos(π t/T))/2 within a piece of length T.
static Wanted on_piece(const Piece* piece, double time_s) {
  const double t = fmin(time_s - piece->start_s, piece->duration_s),
               change = piece->to_m_per_s - piece->from_m_per_s;
  const double w = pi / piece->duration_s;
  return (Wanted){piece->position_m + piece->from_m_per_s * t + 0.5 * change * (t - sine_of(w * t) / w),
                  piece->from_m_per_s + 0.5 * change * (1 - cosine_of(w * t)),
                  0.5 * change * w * sine_of(w * t)};
}

/// Fades a sine in and out: e(t) = (1 − cos(π t/1 s))/2 at both ends, with its two derivatives.
static void fade(const Motion* motion, double time_s, double envelope[3]) {
  const double since = time_s - motion->sines_start_s, left = motion->sines_end_s - time_s;
  const double t = fmin(since, left), direction = since < left ? 1.0 : -1.0;
  envelope[0] = t >= 1 ? 1 : t <= 0 ? 0 : 0.5 * (1 - cosine_of(pi * t));
  envelope[1] = t >= 1 || t <= 0 ? 0 : direction * 0.5 * pi * sine_of(pi * t);
  envelope[2] = t >= 1 || t <= 0 ? 0 : 0.5 * pi * pi * cosine_of(pi * t);
}

Wanted motion_at(const Motion* motion, double time_s) {
  int i = 0;
  while (i + 1 < motion->piece_count && motion->pieces[i + 1].start_s <= time_s) ++i;
  Wanted wanted = on_piece(&motion->pieces[i], time_s);
  double envelope[3];
  fade(motion, time_s, envelope);
  for (int j = 0; j < motion->sine_count; ++j) {
    const Sine* sine = &motion->sines[j];
    const double w = 2 * pi * sine->frequency_hz, angle = w * time_s + sine->phase_rad;
    const double y = sine->amplitude_m * sine_of(angle), dy = sine->amplitude_m * w * cosine_of(angle),
                 ddy = -w * w * y;
    wanted.position_m += envelope[0] * y;
    wanted.velocity_m_per_s += envelope[0] * dy + envelope[1] * y;
    wanted.acceleration_m_per_s2 += envelope[0] * ddy + 2 * envelope[1] * dy + envelope[2] * y;
  }
  return wanted;
}
