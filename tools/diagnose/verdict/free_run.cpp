#include "tools/diagnose/verdict/free_run.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include "engine/diagram/in_memory.h"
#include "engine/json/json.h"
#include "engine/run/run.h"
#include "models/real/whole.h"
#include "tools/compare/joined_bodies.h"
#include "tools/compare/machine.h"
#include "tools/diagnose/criteria.h"
#include "tools/experiment/experiment_ports.h"
#include "tools/experiment/sensor_gains.h"

namespace loopwright::diagnosis {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The diagram cut open at its input, without controller and noise.
class FreeAxis {
 public:
  FreeAxis(const Improvement& diagram, const Experiment& recorded, const AxisModel& model,
           const LoadOptions& options, int finer)
      : record_(model.record()) {
    Problems problems;
    const Value root = parse_json(diagram.file, problems);
    const auto plan_with = [&](const LoadOptions& with) {
      const auto read = read_diagram(root, diagram.file->name, with, problems);
      const auto plan = read ? compile(*read, problems) : nullptr;
      if (!plan || problems.has_errors()) throw InputError(std::move(problems));
      return plan;
    };
    const auto whole = plan_with(with_own_values(recorded, options));
    const Experiment moved = with_moved_ports(recorded, diagram.moved);
    const Experiment cut =
        cut_open(without_sensor_gains(*whole, in_units_of_ports(*whole, moved)), *whole, problems);
    if (problems.has_errors()) throw InputError(std::move(problems));
    LoadOptions driven = follow(cut, options);
    driven.set.emplace_back("solver.step", fmt::format("{}", cut.time.sample_time));
    driven.set.emplace_back("solver.method", "rk4");
    plan_ = std::make_shared<Plan>(*plan_with(driven));
    const auto number_of = [&](std::string_view name) {
      for (const auto& [role, port] : cut.roles.ports)
        if (role == name)
          if (const auto numbers = plan_->find(port); numbers.size() == 1) return numbers[0];
      return Number(-1);
    };
    input_ = number_of("input");
    measured_[0] = number_of("position"), measured_[1] = number_of("velocity");
    for (int i : {0, 1}) {
      moving_[i] = measured_[i] < 0 ? measured_[i] : state_behind(*plan_, measured_[i]);
      if (moving_[i] >= 0 && is_sampled_between(*plan_, moving_[i], measured_[i])) measured_[i] = moving_[i];
      shows_output_ |= measured_[i] >= 0 && measured_[i] < plan_->signals;
    }
    silence(*plan_, input_);
    sample_ticks_ = step_by_samples(*plan_, record_, finer * model.steps_a_sample());
    keep_only(*plan_, {moving_[0], moving_[1], measured_[0], measured_[1]});
    run_ = std::make_unique<Run<double>>(*plan_);
    switch_off_noise(*run_, *plan_);
    run_->reset({plan_->seed, 0});
    numbers_ = reinterpret_cast<double*>(run_->arena().data());
  }

  /// The present state, and back to it.
  void keep() { kept_.assign(run_->arena().begin(), run_->arena().end()), kept_at_ = run_->now(); }
  void go_back() {
    std::ranges::copy(kept_, run_->arena().begin());
    run_->restored(kept_at_);
  }
  /// With what hangs on the axis.
  void begin_at(double position, double velocity) {
    carry_along(*plan_, moving_[0], moving_[1], position, velocity, numbers_ + plan_->signals);
    place(position, velocity);
  }
  void place(double position, double velocity) {
    if (moving_[0] >= plan_->signals) numbers_[moving_[0]] = position;
    if (moving_[1] >= plan_->signals) numbers_[moving_[1]] = velocity;
  }
  /// From a row to the next.
  void step(size_t row) {
    numbers_[input_] = record_.input[row];
    const double duration = record_.duration.empty() ? 1 : record_.duration[row];
    const int64_t end = run_->now().tick + std::max<int64_t>(1, std::llround(duration * sample_ticks_));
    while (run_->now().tick < end) run_->step_fixed(end, false, [] {});
  }
  double measured(bool velocity) {
    if (shows_output_) run_->evaluate(0, true);
    return numbers_[measured_[velocity]];
  }

 private:
  const AxisRecord& record_;
  std::shared_ptr<Plan> plan_;
  double sample_ticks_ = 1;
  std::unique_ptr<Run<double>> run_;
  double* numbers_ = nullptr;  // the arena's
  Number input_ = -1, moving_[2] = {-1, -1}, measured_[2] = {-1, -1};
  bool shows_output_ = false;
  std::vector<char> kept_;
  Instant kept_at_;
};

/// Mean square of what a constant, and a straight line if `has_slope`, leave of the errors.
double square_beside_offsets(const std::vector<double>& errors, bool has_slope) {
  const double n = double(errors.size()), middle = (n - 1) / 2;
  double mean = 0, slope = 0, spread = 0;
  for (double e : errors) mean += e / n;
  for (size_t i = 0; i < errors.size(); ++i)
    slope += (double(i) - middle) * errors[i], spread += (double(i) - middle) * (double(i) - middle);
  slope = has_slope ? slope / spread : 0;
  double sum = 0;
  for (size_t i = 0; i < errors.size(); ++i) {
    const double left = errors[i] - mean - slope * (double(i) - middle);
    sum += left * left;
  }
  return sum / (n - (has_slope ? 2 : 1));
}

class Windows {
 public:
  Windows(FreeAxis& axis, const Trial& trial, const InverseDynamics& inverse, FreeRun& result)
      : axis_(axis), trial_(trial), motion_(inverse.motion), record_(trial.model->record()), result_(result) {
    const auto [low, high] = std::ranges::minmax(record_.measured.front().value);
    largest_ = high > low ? criteria::most_strokes * (high - low) : infinity;
  }

  void run(size_t length) {
    const bool has_hold_out = trial_.held_out_from < record_.rows();
    size_t k = 0;
    const auto follow_to = [&](size_t end) {
      for (; k < end; ++k) axis_.place(motion_.position[k], motion_.velocity[k]), axis_.step(k);
    };
    axis_.begin_at(motion_.position[0], motion_.velocity[0]);
    follow_to(has_hold_out ? trial_.held_out_from : std::min(length, record_.rows()));
    while (k + 2 * length < record_.rows() && !result_.diverged) {
      follow_to(k + length);
      if (is_whole(k, k + length)) run_window(k, length);
      follow_to(k + length);
    }
  }

 private:
  bool is_whole(size_t from, size_t to) const {
    for (size_t k = from; k <= to; ++k)
      if (record_.is_missing(k)) return false;
    return true;
  }
  /// Afterwards the axis is where it was: a load that moves by itself is led by the measured motion alone. If
  /// the errors of a window went on to the next, following and running freely in turn could amplify them.
  void run_window(size_t from, size_t length) {
    const MeasuredPort& port = record_.measured.front();
    const bool is_velocity = port.role == "velocity";
    axis_.keep();
    axis_.place(motion_.position[from], motion_.velocity[from]);
    errors_.clear();
    for (size_t k = from; k < from + length; ++k) {
      axis_.step(k);
      errors_.push_back(axis_.measured(is_velocity) - port.value[k + 1]);
    }
    const double square = square_beside_offsets(errors_, !is_velocity);
    if (!(square <= largest_ * largest_)) result_.diverged = true;
    result_.squares.push_back(square);
    axis_.go_back();
  }

  FreeAxis& axis_;
  const Trial& trial_;
  const MeasuredMotion& motion_;
  const AxisRecord& record_;
  FreeRun& result_;
  double largest_;
  std::vector<double> errors_;
};

/// Steps in a sample that an input with a lag needs.
int steps_for(const std::vector<Member>& members, double sample_time) {
  double steps = 1;
  for (const Member& member : members)
    if (is_late_input(*member.candidate))
      steps = std::max(steps, criteria::steps_in_a_lag * sample_time / member.nonlinear[0]);
  return int(whole_between<size_t>(std::ceil(steps), 1, criteria::most_steps_a_sample));
}

/// Rows that are run freely: those held out, where there are any.
size_t rows_run_freely(const Trial& trial) {
  const size_t rows = trial.model->record().rows();
  return trial.held_out_from < rows ? rows - trial.held_out_from : rows;
}

size_t rows_of_window(const Trial& trial, const Noise& noise) {
  AxisModel& model = *trial.model;
  const LinearAxis axis = model.linearize();
  const double constant = correction_time(axis, gains_of(axis, noise, model.nominal_inertia())),
               affordable = std::min(double(model.record().rows()) / (2 * criteria::plenty_of_windows),
                                     double(rows_run_freely(trial)) / (2 * (criteria::least_windows + 1)));
  return whole_count(
      std::ceil(std::max(criteria::least_horizon_rows, std::min(criteria::horizon * constant, affordable))));
}

/// The mean, in its standard errors.
double deviations_from_zero(const std::vector<double>& values) {
  const double n = double(values.size());
  double mean = 0, square = 0;
  for (double v : values) mean += v / n;
  for (double v : values) square += (v - mean) * (v - mean);
  const double error = std::sqrt(square / (n - 1) / n);
  return error > 0 ? mean / error : mean > 0 ? infinity : 0;
}

}  // namespace

double FreeRun::rmse() const {
  double sum = 0;
  for (double square : squares) sum += square;
  return squares.empty() ? std::nan("") : std::sqrt(sum / double(squares.size()));
}

FreeRun run_freely(const std::vector<Member>& members, const Improver& improver, const LoadOptions& load,
                   const Trials& trials, const std::vector<InverseDynamics>& inverse, const Noise& noise) {
  FreeRun result;
  if (trials.has_map()) return result;
  const Improvement diagram = improver.with(members);
  const auto holds_out = [](const Trial& trial) {
    return trial.held_out_from < trial.model->record().rows();
  };
  const bool only_held_out = std::ranges::any_of(trials.list, holds_out);
  for (size_t t = 0; t < trials.list.size() && !result.diverged; ++t) {
    if (only_held_out && !holds_out(trials.list[t])) continue;
    if (trials.interrupt && *trials.interrupt) throw Interrupted{};
    AxisModel& model = *trials.list[t].model;
    const size_t length = rows_of_window(trials.list[t], noise);
    result.horizon_s = std::max(result.horizon_s, double(length) * model.record().sample_time);
    FreeAxis axis(diagram, *improver.experiments()[t], model, load,
                  steps_for(members, model.record().sample_time));
    Windows(axis, trials.list[t], inverse[t], result).run(length);
  }
  return result;
}

bool is_worse(const FreeRun& before, const FreeRun& after) {
  if (after.diverged || before.diverged) return after.diverged && !before.diverged;
  const size_t n = after.squares.size();
  if (n != before.squares.size() || double(n) < criteria::least_windows) return false;
  std::vector<double> difference, ratio;
  double whole = 0, change = 0, square = 0;
  for (size_t i = 0; i < n; ++i) {
    const double was = before.squares[i], is = after.squares[i];
    whole += was, change += is - was, square += was * was;
    difference.push_back(is - was);
    ratio.push_back(std::log(std::max(is, 1e-300) / std::max(was, 1e-300)));
  }
  if (change <= criteria::least_worsening * whole) return false;
  const double of_difference = deviations_from_zero(difference), of_ratio = deviations_from_zero(ratio);
  // If it were no worse, its windows would scatter as those before: twice their variance for the difference.
  const double scatter = std::sqrt(2 * std::max(0.0, square - whole * whole / double(n)));
  const bool in_several = of_difference > std::sqrt(criteria::least_windows);
  return std::max(of_difference, of_ratio) > criteria::worse_deviations ||
         (in_several && change > criteria::worse_deviations * scatter);
}

}  // namespace loopwright::diagnosis
