#include "engine/solve/event_finder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/solve/stepper.h"

namespace loopwright {

namespace {
// Widths in rounding units of t. The bracket is narrow compared with all physical time scales, and wide
// enough for simultaneous events whose crossing functions round differently.
constexpr double bracket_width = 8.0;
constexpr double simultaneous_width = 64.0;
constexpr double departure_growth = 8.0;
constexpr double zero_band_factor = 4.0;

int8_t sign_of(double value) { return static_cast<int8_t>((value > 0.0) - (value < 0.0)); }
}  // namespace

EventFinder::EventFinder(const OdeSystem& system, int samples_per_step)
    : system_(system),
      samples_per_step_(samples_per_step),
      sign_(static_cast<size_t>(system.crossings)),
      fired_(sign_.size()),
      flipped_(sign_.size()),
      narrow_(sign_.size()),
      zero_band_(sign_.size()),
      side_(sign_.size()) {
  for (Sample* sample : {&left_, &right_, &trial_}) {
    sample->x.resize(static_cast<size_t>(system.states));
    sample->value.resize(sign_.size());
  }
}

double EventFinder::width(double t) { return (bracket_width + simultaneous_width) * rounding(t, t); }

void EventFinder::forget() {
  std::fill(sign_.begin(), sign_.end(), int8_t{0});
  std::fill(zero_band_.begin(), zero_band_.end(), 0.0);
  std::fill(flipped_.begin(), flipped_.end(), int8_t{0});
  std::fill(narrow_.begin(), narrow_.end(), int64_t{0});
  clear_fired();
  leaving_zero_ = false;
}

void EventFinder::clear_fired() { std::fill(fired_.begin(), fired_.end(), int8_t{0}); }

EventFinder::Found EventFinder::look(Stepper& stepper, double t, Sample& sample) {
  sample.t = t;
  stepper.interpolate(t, sample.x.data());
  return evaluate(stepper, sample);
}

EventFinder::Found EventFinder::evaluate(Stepper& stepper, Sample& sample) {
  ++stepper.statistics.crossing_evaluations;
  if (!system_.crossing_values(system_.self, sample.t, sample.x.data(), sample.value.data()))
    return Found::fault;
  const auto not_a_number = [](double value) { return std::isnan(value); };
  return std::any_of(sample.value.begin(), sample.value.end(), not_a_number) ? Found::non_finite
                                                                             : Found::nothing;
}

EventFinder::Found EventFinder::begin(Stepper& stepper, double t, const double* x) {
  left_.t = t;
  std::copy_n(x, left_.x.size(), left_.x.begin());
  if (const Found trouble = evaluate(stepper, left_); trouble != Found::nothing) return trouble;
  leaving_zero_ = false;
  std::fill(flipped_.begin(), flipped_.end(), int8_t{0});
  for (size_t i = 0; i < sign_.size(); ++i) {
    const double value = left_.value[i];
    if (zero_band_[i] > 0.0 && std::fabs(value) <= zero_band_[i]) {
      sign_[i] = 0;
      side_[i] = sign_of(value);
      leaving_zero_ = true;
    } else if (value != 0.0) {
      sign_[i] = sign_of(value);
    }
  }
  return Found::nothing;
}

bool EventFinder::changed(size_t i, const Sample& sample, const Crossing* wanted) const {
  const int8_t sign = sign_of(sample.value[i]);
  const bool leaves_zero = sign_[i] == 0 && zero_band_[i] > 0.0 && std::fabs(sample.value[i]) > zero_band_[i];
  if (sign * (leaves_zero ? side_[i] : sign_[i]) >= 0) return false;
  return wanted == nullptr || wanted[i] == Crossing::either || static_cast<int8_t>(wanted[i]) == sign;
}

bool EventFinder::any_changed(const Sample& sample, const Crossing* wanted) const {
  for (size_t i = 0; i < sign_.size(); ++i) {
    if (changed(i, sample, wanted)) return true;
  }
  return false;
}

/// Takes over the signs of a sample without an event: the crossings that changed sign were not requested.
void EventFinder::pass(const Sample& sample) {
  leaving_zero_ = false;
  for (size_t i = 0; i < sign_.size(); ++i) {
    const double value = sample.value[i];
    if (sign_[i] == 0 && std::fabs(value) <= zero_band_[i]) {
      leaving_zero_ = leaving_zero_ || zero_band_[i] > 0.0;
    } else if (value != 0.0) {
      sign_[i] = sign_of(value);
    }
  }
}

/// The next time to sample: evenly spaced over the step. After an event, additional samples at growing
/// distances come first, because a crossing that has just fired may leave zero and return long before the
/// step ends (a ball that hardly bounces).
double EventFinder::next_sample(double from, double to, double& departure) const {
  int index = 1;
  double even = to;
  while (index < samples_per_step_ && (even = from + (to - from) * index / samples_per_step_) <= left_.t)
    ++index;
  if (index >= samples_per_step_) even = to;
  if (!leaving_zero_ || from + departure >= even) return even;
  const double early = from + departure;
  departure *= departure_growth;
  return early;
}

EventFinder::Found EventFinder::scan(Stepper& stepper, double from, double to, const Crossing* wanted) {
  double departure = bracket_width * rounding(from, to);
  while (left_.t < to) {
    if (const Found trouble = look(stepper, next_sample(from, to, departure), right_);
        trouble != Found::nothing) {
      return trouble;
    }
    if (any_changed(right_, wanted)) {
      look_beyond(stepper, from, to, departure);
      return locate(stepper, to, wanted);
    }
    note_returns(right_);
    pass(right_);
    std::swap(left_, right_);
  }
  std::fill(zero_band_.begin(), zero_band_.end(), 0.0);
  leaving_zero_ = false;
  return Found::nothing;
}

/// Whether a crossing that changed at the last sample has changed back at this one.
void EventFinder::note_returns(const Sample& sample) {
  for (size_t i = 0; i < sign_.size(); ++i) {
    const bool flips = sign_of(sample.value[i]) * sign_[i] < 0;
    if (flips && flipped_[i]) ++narrow_[i];
    flipped_[i] = flips;
  }
}

/// Called before an event is located, which ends the step: checks whether the next sample would show its
/// crossing changed back.
void EventFinder::look_beyond(Stepper& stepper, double from, double to, double departure) {
  note_returns(right_);
  if (leaving_zero_ || right_.t >= to) return;
  std::swap(left_.t, right_.t);  // next_sample continues from the left end
  const double next = next_sample(from, to, departure);
  std::swap(left_.t, right_.t);
  if (look(stepper, next, trial_) != Found::nothing) return;
  for (size_t i = 0; i < sign_.size(); ++i)
    if (flipped_[i] && sign_of(trial_.value[i]) * sign_[i] > 0) ++narrow_[i];
}

void EventFinder::archive(StateArchive& a) {
  a.members(sign_, zero_band_, side_, flipped_, narrow_, leaving_zero_, left_.t, left_.x, left_.value);
}

/// The first zero of a crossing by the secant; the weights are those of the Illinois method.
double EventFinder::secant(double left_weight, double right_weight, const Crossing* wanted) const {
  double earliest = 1.0;
  for (size_t i = 0; i < sign_.size(); ++i) {
    if (!changed(i, right_, wanted)) continue;
    const double before = left_weight * std::fabs(left_.value[i]),
                 after = right_weight * std::fabs(right_.value[i]);
    const double fraction = before / (before + after);
    earliest = std::fmin(earliest, std::isfinite(fraction) ? fraction : 0.5);
  }
  return left_.t + earliest * (right_.t - left_.t);
}

/// Narrows (left_, right_] around the first change of sign: secant steps with the Illinois modification
/// (Dowell & Jarratt, BIT 11, 1971), and a bisection whenever three of them did not halve the bracket.
EventFinder::Found EventFinder::locate(Stepper& stepper, double to, const Crossing* wanted) {
  const double tolerance = bracket_width * rounding(left_.t, right_.t);
  double left_weight = 1.0, right_weight = 1.0, width_before = right_.t - left_.t;
  bool bisect = false, moved_left = false, moved_right = false;
  for (int trials = 1; right_.t - left_.t > tolerance; ++trials) {
    const double candidate =
        bisect ? left_.t + 0.5 * (right_.t - left_.t) : secant(left_weight, right_weight, wanted);
    const double t = std::clamp(candidate, left_.t + 0.5 * tolerance, right_.t - 0.5 * tolerance);
    if (const Found trouble = look(stepper, t, trial_); trouble != Found::nothing) return trouble;
    if (any_changed(trial_, wanted)) {
      std::swap(right_, trial_);
      right_weight = 1.0;
      if (moved_right) left_weight *= 0.5;  // the left end has stayed for long: move the secant towards it
      moved_right = true, moved_left = false;
    } else {
      pass(trial_);
      std::swap(left_, trial_);
      left_weight = 1.0;
      if (moved_left) right_weight *= 0.5;
      moved_left = true, moved_right = false;
    }
    bisect = trials % 3 == 0 && right_.t - left_.t > 0.5 * width_before;
    if (trials % 3 == 0) width_before = right_.t - left_.t;
  }
  if (const Found trouble = gather_simultaneous(stepper, to, wanted); trouble != Found::nothing)
    return trouble;
  report(wanted);
  return Found::event;
}

/// Moves the right end slightly further if more crossings have changed there and none has changed back.
EventFinder::Found EventFinder::gather_simultaneous(Stepper& stepper, double to, const Crossing* wanted) {
  const double t = std::fmin(to, right_.t + simultaneous_width * rounding(left_.t, right_.t));
  if (t <= right_.t || sign_.size() == 1) return Found::nothing;
  if (const Found trouble = look(stepper, t, trial_); trouble != Found::nothing) return trouble;
  bool more = false;
  for (size_t i = 0; i < sign_.size(); ++i) {
    const bool here = changed(i, right_, wanted), there = changed(i, trial_, wanted);
    if (here && !there) return Found::nothing;
    more = more || there != here;
  }
  if (more) std::swap(right_, trial_);
  return Found::nothing;
}

/// Records the crossings that changed in (left_, right_] and continues from the right end.
void EventFinder::report(const Crossing* wanted) {
  for (size_t i = 0; i < sign_.size(); ++i) {
    const bool fires = changed(i, right_, wanted);
    fired_[i] = fires ? sign_of(right_.value[i]) : int8_t{0};
    if (fires && sign_[i] != 0) {
      // The variation of the value over the bracket is due to rounding and its slope. A few times that counts
      // as zero.
      zero_band_[i] = zero_band_factor * std::fmax(std::fabs(left_.value[i]), std::fabs(right_.value[i]));
    } else if (sign_[i] != 0) {
      zero_band_[i] = 0.0;
    }  // otherwise it leaves zero or soon will: a wider band would hide chattering
  }
  pass(right_);
  left_.t = right_.t;
  std::copy(right_.value.begin(), right_.value.end(), left_.value.begin());
}

}  // namespace loopwright
