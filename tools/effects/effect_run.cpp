#include "tools/effects/effect_run.h"
#include "models/real/whole.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include "tools/effects/switched_effect.h"

namespace loopwright {
namespace {

/// An end stop or a short pitch is met somewhere within a sample. With few rows in a motion, a sample in
/// which the axis may go farther than a part of its stroke is divided.
size_t parts_of_a_sample(const RecordSizes& sizes) {
  constexpr double farthest = 0.005;  // [stroke] in a part
  constexpr size_t most = 4;
  const double way = sizes.top_speed * sizes.sample_time;
  if (!(way > farthest * sizes.stroke)) return 1;
  return std::min(most, whole_count(std::ceil(way / (farthest * sizes.stroke))));
}

/// These do not change within a sample.
bool reads_held_signals(const Effect& effect) {
  return std::ranges::all_of(effect.reads,
                             [](const std::string& role) { return role == "input" || role == "force"; });
}

std::span<const double> column_of(const RoleSignals& signals, std::string_view role) {
  return role == "position"       ? signals.position
         : role == "velocity"     ? signals.velocity
         : role == "acceleration" ? signals.acceleration
         : role == "input"        ? signals.input
                                  : signals.force;
}

/// Passes on rows of all lanes lane by lane, some rows at a time: to write a number to as many columns as
/// there are lanes, row by row, takes longer than to compute them.
template <class Take> class InBlocks {
 public:
  InBlocks(size_t lanes, Take& take) : lanes_(lanes), take_(take), numbers_(2 * lanes * most) {}
  ~InBlocks() { pass_on(); }
  InBlocks(const InBlocks&) = delete;
  void add(const double* means, const double* slopes) {
    for (size_t lane = 0; lane < lanes_; ++lane) {
      double* const to = &numbers_[2 * (lane * most + rows_)];
      to[0] = means[lane], to[1] = slopes[lane];
    }
    if (++rows_ == most) pass_on();
  }

 private:
  static constexpr size_t most = 16;  // rows
  void pass_on() {
    for (size_t lane = 0; lane < lanes_; ++lane)
      for (size_t row = 0; row < rows_; ++row) {
        const double* const from = &numbers_[2 * (lane * most + row)];
        take_(lane, first_ + row, from[0], from[1]);
      }
    first_ += rows_, rows_ = 0;
  }

  size_t lanes_;
  Take& take_;
  std::vector<double> numbers_;
  size_t first_ = 0, rows_ = 0;
};

}  // namespace

EffectRun::EffectRun(std::shared_ptr<const EffectPlan> plan, int lanes)
    : plan_(std::move(plan)), reads_held_signals_(reads_held_signals(plan_->effect)) {
  for (const EffectParameter& p : plan_->effect.parameters)
    if (p.is_fitted) starts_.push_back(range_of(p, plan_->sizes).start);
  if (plan_->is_linear) {
    fitted_.assign(size_t(std::max(1, lanes)), starts_);
    linear_ = std::make_unique<EffectSample>(plan_);
    return;
  }
  if (plan_->is_held) held_ = std::make_unique<HeldEffect>(plan_);
  if (plan_->is_switched) {
    fitted_.assign(size_t(std::max(1, lanes)), starts_);
    return;
  }
  // A complete arena of lanes costs about as much as four scalar runs.
  const bool is_wide = lanes > 4 || !plan_->remembers;
  const InstructionSet set = is_wide ? widest_instruction_set() : InstructionSet::scalar;
  const int width = lanes_in_arena(set);
  const int sets = set == InstructionSet::scalar || !plan_->remembers ? 1 : std::min(lanes, most_lanes);
  lanes_ = std::make_unique<EffectLanes>(*plan_, set, (sets + width - 1) / width);
  if (!is_wide && plan_->remembers_way) segments_ = std::make_unique<SegmentRun>(plan_);
  fitted_.assign(plan_->remembers ? lanes_->lanes() : 1, starts_);
  for (auto* list : {&slope_, &integral_, &area_}) list->resize(lanes_->lanes());
  samples_.resize(lanes_->lanes());
}

double EffectRun::isolate(size_t parameter, int lane) {
  size_t i = 0;
  for (const EffectParameter& p : plan_->effect.parameters) {
    if (!p.is_fitted) continue;
    if (p.is_linear) set(i, i != parameter ? 0.0 : starts_[i] != 0 ? starts_[i] : 1.0, lane);
    ++i;
  }
  return starts_[parameter] != 0 ? starts_[parameter] : 1;
}

/// Where the signals of some rows are at a fraction of their samples, each in a lane of its own, with v = v₀
/// + a t + 6 b u (1 - u), u = t / T, for a bow b. They are held at the instant of evaluation.
void EffectRun::give_at(double u, size_t rows) {
  const double T = plan_->sizes.sample_time;
  const auto give_each = [&](const EffectLanes::Wire& wire, auto&& signal) {
    if (!wire.is_read()) return;
    for (size_t i = 0; i < rows; ++i) *wire.value.lanes[i] = signal(samples_[i], samples_[i].gain(T) * T);
  };
  give_each(lanes_->position, [&](const RoleSample& s, double gain) {
    const double way = (s.velocity + 0.5 * gain * u) * u + s.velocity_bow * u * u * (3 - 2 * u);
    return s.position + T * way;
  });
  give_each(lanes_->velocity, [&](const RoleSample& s, double gain) {
    return s.velocity + gain * u + 6 * s.velocity_bow * u * (1 - u);
  });
  give_each(lanes_->acceleration,
            [&](const RoleSample& s, double) { return s.acceleration + s.jerk(T) * T * u; });
  give_each(lanes_->input, [](const RoleSample& s, double) { return s.input; });
  give_each(lanes_->force, [](const RoleSample& s, double) { return s.force; });
}

/// ∫ f du and 12 ∫ (u - ½) f du over the sample, by two Gauss points in each part of it. What is held has one
/// value in all of it.
void EffectRun::mean_of(size_t rows, double now) {
  const bool at_start = plan_->acts_on_sensor, is_constant = reads_held_signals_;
  const size_t parts = parts_of_a_sample(plan_->sizes), points = at_start || is_constant ? 1 : 2 * parts;
  const double weight = 1.0 / double(points);
  std::ranges::fill(area_, 0.0), std::ranges::fill(slope_, 0.0);
  for (size_t point = 0; point < points; ++point) {
    const double in_part = point % 2 == 0 ? gauss_point : 1 - gauss_point;
    const double u = at_start ? 0 : is_constant ? 0.5 : (double(point / 2) + in_part) / double(parts);
    give_at(u, rows);
    lanes_->read_first(now);
    for (size_t i = 0; i < rows; ++i) {
      area_[i] += weight * lanes_->value[i];
      slope_[i] += weight * (12 * (u - 0.5) * lanes_->value[i] + lanes_->stated_slope[i]);
    }
  }
  lanes_->value = area_, lanes_->slope = slope_;
}

/// ∫ (u - ½) f du = mean / 2 - ∫ I du over the sample, u = 0 … 1, with the integral I of f from its start;
/// for a straight line of slope s it is s / 12.
void EffectRun::integrate_sample() {
  const double period = plan_->sizes.sample_time;
  const int64_t whole_sample = lanes_->sample_ticks();
  LaneRun& run = lanes_->run();
  const std::vector<double>& at_start = slope_ = integral_;
  std::ranges::fill(area_, 0.0);
  for (int64_t left = whole_sample; left > 0;) {
    if (left == whole_sample)
      lanes_->read_first(run.time());
    else
      run.evaluate(run.time());
    before_ = integral_;
    const int64_t passed = run.integrate(left);  // a step of the solver
    left -= passed;
    lanes_->read(plan_->integral, integral_);
    for (size_t i = 0; i < area_.size(); ++i)
      area_[i] += 0.5 * double(passed) / double(whole_sample) * (before_[i] + integral_[i] - 2 * at_start[i]);
  }
  if (plan_->acts_on_sensor) return;
  for (size_t i = 0; i < area_.size(); ++i) {
    const double whole = integral_[i] - at_start[i];
    lanes_->value[i] = whole / period;
    lanes_->slope[i] = 12 * (0.5 * whole - area_[i]) / period + lanes_->stated_slope[i];
  }
}

void EffectRun::step(const RoleSample& s) {
  const double now = lanes_->run().time();
  lanes_->give(s.given(plan_->sizes.sample_time), now);
  if (plan_->integral >= 0) return integrate_sample();
  const double period = plan_->sizes.sample_time;
  lanes_->read_first(plan_->acts_on_sensor ? now : now + gauss_point * period);
  if (!plan_->acts_on_sensor) lanes_->read_second(now + (1 - gauss_point) * period);
  lanes_->run().integrate(lanes_->sample_ticks());
}

template <class Take>
void EffectRun::run_in_turn(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take) {
  InBlocks blocks(lanes, take);
  for (size_t row = 0; row < rows; ++row) {
    step(signals.at(row));
    blocks.add(lanes_->value.data(), lanes_->slope.data());
  }
}

template <class Take>
bool EffectRun::run_in_segments(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take) {
  std::vector<double> values, slopes;
  for (size_t lane = 0; lane < lanes; ++lane) {
    if (!segments_->run(signals, rows, fitted_[lane], values, slopes)) return false;
    for (size_t row = 0; row < rows; ++row) take(lane, row, values[row], slopes[row]);
  }
  return true;
}

template <class Take> void EffectRun::run_side_by_side(const RoleSignals& signals, size_t rows, Take&& take) {
  const double now = lanes_->run().time();
  const size_t lanes = lanes_->lanes();
  lanes_->give({}, now);  // nothing but the values changes from then on
  for (size_t first = 0; first < rows; first += lanes) {
    const size_t count = std::min(lanes, rows - first);
    for (size_t i = 0; i < count; ++i) samples_[i] = signals.at(first + i);
    mean_of(count, now);
    for (size_t i = 0; i < count; ++i) take(size_t(0), first + i, lanes_->value[i], lanes_->slope[i]);
  }
}

template <class Take>
void EffectRun::superpose(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take) {
  const RoleSample first = signals.at(0);
  std::vector<SampleMap> maps;
  std::vector<std::vector<double>> states;
  for (size_t lane = 0; lane < lanes; ++lane) {
    linear_->start(fitted_[lane], first.position, first.velocity);
    states.push_back(linear_->states()), maps.push_back(linear_->map());
  }
  SampleMaps side_by_side(maps, states);
  InBlocks blocks(lanes, take);
  for (size_t row = 0; row < rows; ++row) {
    side_by_side.step(signals.at(row).given(plan_->sizes.sample_time));
    blocks.add(side_by_side.means(), side_by_side.slopes());
  }
}

template <class Take>
void EffectRun::answer(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take) {
  const std::span<const double> signal = held_->signal(signals);
  for (size_t lane = 0; lane < lanes; ++lane) {
    const auto response = held_->response(fitted_[lane]);
    for (size_t row = 0; row < rows; ++row)
      take(lane, row, response->mean(signal, row), response->slope(signal, row));
  }
}

template <class Take>
void EffectRun::follow_modes(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take) {
  const RoleSample first = signals.at(0);
  for (size_t lane = 0; lane < lanes; ++lane) {
    SwitchedSample sample(plan_, fitted_[lane]);
    std::vector<double> states = sample.start(first.position, first.velocity);
    for (size_t row = 0; row < rows; ++row) {
      const std::vector<double>& result =
          sample.from(states, signals.at(row).given(plan_->sizes.sample_time));
      std::copy_n(result.begin(), states.size(), states.begin());
      take(lane, row, result[states.size()], result[states.size() + 1]);
    }
  }
}

template <class Take>
void EffectRun::run_lanes(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take) {
  for (const std::string& role : plan_->effect.reads) {
    if (column_of(signals, role).size() < rows)
      throw std::invalid_argument(
          fmt::format("the effect \"{}\" reads the {}, which is not given", plan_->effect.name, role));
  }
  if (rows == 0) return;
  if (linear_) return superpose(signals, rows, std::min(lanes, fitted_.size()), take);
  if (!lanes_) return follow_modes(signals, rows, std::min(lanes, fitted_.size()), take);
  if (held_ && rows > 2 * held_->remembered_rows())
    return answer(signals, rows, std::min(lanes, fitted_.size()), take);
  if (segments_ && run_in_segments(signals, rows, std::min(lanes, fitted_.size()), take)) return;
  lanes_->start(fitted_, signals.at(0));
  std::ranges::fill(integral_, 0.0);
  if (plan_->remembers)
    run_in_turn(signals, rows, std::min(lanes, lanes_->lanes()), take);
  else
    run_side_by_side(signals, rows, take);
  refuse_faults(signals, rows);
}

/// A lane in which a block has faulted is computed no further, and rows may lie side by side in it. What
/// blocks make of no numbers, beside an input of zero or along a motion that diverges, is for the caller to
/// see.
void EffectRun::refuse_faults(const RoleSignals& signals, size_t rows) const {
  const LaneRun& run = lanes_->run();
  if (!run.failed() || !(plan_->sizes.force_level > 0)) return;
  const auto is_number = [](double x) { return std::isfinite(x); };
  for (const std::string& role : plan_->effect.reads)
    if (!std::ranges::all_of(column_of(signals, role).first(rows), is_number)) return;
  for (int lane = 0; lane < run.lanes(); ++lane) {
    if (!(run.failed() >> lane & 1)) continue;
    Problems problems;
    auto& p = problems.error({}, "", "",
                             fmt::format("the effect \"{}\" cannot be computed along the record: {}",
                                         plan_->effect.name, to_text(run.failure(lane), plan_->plan)));
    p.found = plan_->effect.path;
    p.hint = "its blocks must compute wherever the record goes, as a table does with \"outside\": \"hold\"";
    throw InputError(std::move(problems));
  }
}

void EffectRun::run(const RoleSignals& signals, size_t rows, std::span<double> values) {
  run_lanes(signals, rows, rows ? values.size() / rows : 0,
            [&](size_t lane, size_t row, double value, double) { values[lane * rows + row] = value; });
}

void EffectRun::run(const RoleSignals& signals, size_t rows, std::span<Output> outputs) {
  for (Output& output : outputs) output.mean.resize(rows), output.slope.resize(rows);
  run_lanes(signals, rows, outputs.size(), [&](size_t lane, size_t row, double value, double slope) {
    Output& output = outputs[lane];
    output.mean[row] = float(output.factor * value);
    output.slope[row] = plan_->acts_on_sensor ? 0.0F : float(output.factor * slope);
  });
}

void EffectRun::column(const RoleSignals& signals, size_t parameter, std::span<double> values) {
  const std::vector<double> kept = fitted_[0];
  const double size = isolate(parameter);
  run(signals, values);
  for (double& value : values) value /= size;
  fitted_[0] = kept;
}

}  // namespace loopwright
