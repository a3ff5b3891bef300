#include "tools/gp/samples.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include "engine/json/reader.h"
#include "engine/unit/unit.h"
#include "engine/file/hash.h"
#include "engine/record/column_units.h"
#include "engine/record/recording_file.h"
#include "engine/record/time_axis.h"
#include "models/signal/zero_phase.h"
#include "tools/experiment/data_file.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

/// The samples of one recording, row by row.
struct Rows {
  std::vector<double> time, position, velocity, label;
  size_t begin = 0, end = 0;  ///< rows with a reliable label
  double sample_time = 0;
};

class Collector {
 public:
  Collector(const Training& training, Problems& problems) : training_(training), problems_(problems) {}

  std::shared_ptr<const TrainingSamples> run() {
    std::vector<Rows> all;
    for (const std::string& name : training_.recordings) all.push_back(read(name));
    if (problems_.has_errors()) return nullptr;
    for (size_t i = 0; i < all.size(); ++i) add_rows(training_.recordings[i], all[i]);
    warn_of_missing_velocities();
    if (result_->samples.labels.empty()) {
      auto& p = problem("no sample of the recordings is in the windows and at the velocities wanted");
      p.found = fmt::format("velocities from {:.4g} to {:.4g} m/s", least_velocity_, greatest_velocity_);
      p.hint = "look at velocities, velocity_tolerance, window_length and window_centers";
      return nullptr;
    }
    thin();
    const auto bytes = [](const auto& values) {
      return std::string_view(reinterpret_cast<const char*>(values.data()),
                              values.size() * sizeof(values[0]));
    };
    result_->hash =
        ContentHash().add(bytes(result_->samples.inputs)).add(bytes(result_->samples.labels)).text();
    return result_;
  }

 private:
  Problem& problem(std::string message) {
    return problems_.error({training_.source, 0}, "", "", std::move(message));
  }

  /// A column in SI units; null after a problem.
  std::vector<double> column(const Recording& recording, const std::string& file, const std::string& name,
                             const std::string& unit_text, std::string* si_unit = nullptr) {
    const ColumnError error = error_in(file);
    const Column* found = find_column(recording, name, error);
    const auto unit = found ? unit_of(*found, unit_text, error) : std::nullopt;
    if (!unit) return {};
    Column values = in_si(*found, *unit);
    if (si_unit) *si_unit = values.unit;
    return std::move(values.values);
  }
  ColumnError error_in(const std::string& file) {
    return [this, file](std::string message) -> Problem& { return problem(file + ": " + message); };
  }

  Rows read(const std::string& name) {
    Rows rows;
    const std::string path = find_data_file(
        training_.path, name, [this](std::string message) -> Problem& { return problem(std::move(message)); });
    if (path.empty()) return rows;
    const Recording recording = read_recording(path, problems_, {.allow_holes = true});
    if (problems_.has_errors()) return rows;
    result_->files.push_back(name);
    const auto time = time_in_seconds(recording, training_.time, error_in(name));
    if (!time) return rows;
    rows.time = time->values;
    TimeOptions options;
    options.must_be_regular = true;
    rows.sample_time = check_time(*time, problems_, options, {training_.source, 0}).sample_time;
    rows.position =
        column(recording, name, training_.position.column, training_.position.unit, &position_unit_);
    if (problems_.has_errors() || rows.position.empty()) return rows;
    if (rows.time.size() < 10) {
      problem(fmt::format("{} has only {} rows", name, rows.time.size()));
      return rows;
    }
    if (training_.velocity.column.empty())
      rows.velocity = central_difference(
          zero_phase_low_pass(rows.position, velocity_cutoff, rows.sample_time), rows.sample_time);
    else
      rows.velocity = column(recording, name, training_.velocity.column, training_.velocity.unit);
    check_velocity(recording, name);
    rows.begin = 0, rows.end = rows.time.size();
    if (training_.label.command.empty())
      observed_label(recording, name, rows);
    else
      label_from_command(recording, name, rows);
    return rows;
  }
  static constexpr double velocity_cutoff = 60;  // rad/s: below cogging, above slow changes of the motion

  /// Columns summed, and read at the time at which they show the present value: later by their lag.
  void observed_label(const Recording& recording, const std::string& name, Rows& rows) {
    std::vector<double> sum(rows.time.size(), 0.0);
    for (const std::string& each : training_.label.columns) {
      const std::vector<double> values =
          column(recording, name, each, training_.label.unit, &result_->label_unit);
      if (values.empty()) return;
      for (size_t i = 0; i < sum.size(); ++i) sum[i] += values[i];
    }
    const double shift = training_.label.lag / rows.sample_time;
    rows.label.assign(sum.size(), 0.0);
    for (size_t i = 0; i < sum.size(); ++i) {
      const double at = double(i) + shift;
      if (!(at >= 0 && at <= double(sum.size() - 1))) {
        (shift > 0 ? rows.end : rows.begin) = shift > 0 ? std::min(rows.end, i) : i + 1;
        continue;
      }
      const size_t k = std::min(size_t(at), sum.size() - 2);
      const double s = at - double(k);
      rows.label[i] = (1 - s) * sum[k] + s * sum[k + 1];
    }
  }

  /// The velocity must be the position per time. Rates such as 1/min are no rad/s.
  void check_velocity(const Recording& recording, const std::string& file) {
    const auto unit_of_choice = [&](const ColumnChoice& choice) {
      const Column* found = recording.find(choice.column);
      const std::string& text = found && !found->unit.empty() ? found->unit : choice.unit;
      return text.empty() ? std::nullopt : parse_unit(text);
    };
    const auto position = unit_of_choice(training_.position), velocity = unit_of_choice(training_.velocity);
    if (!position || !velocity) return;
    const Unit wanted = position->in_si() * *parse_unit("1/s");
    if (conversion(*velocity, wanted).kind == Conversion::Kind::none) return;
    auto& p = problem(fmt::format("{}: the velocity does not fit the position", file));
    p.expected = fmt::format("a velocity in {}", to_string(wanted));
    p.found = to_string(*velocity);
    if (velocity->same_dimension(wanted)) p.hint = "revolutions per minute are rpm";
  }

  /// The number times acceleration or velocity must have the unit of the command: kilograms do not match
  /// amperes.
  void check_law(const std::string& file, const char* number, const std::optional<Unit>& unit,
                 const char* per_time) {
    const auto command = parse_unit(result_->label_unit), position = parse_unit(position_unit_);
    if (!unit || !command || !position) return;
    const Unit made = *unit * *position * *parse_unit(per_time);
    if (made.same_dimension(*command)) return;
    auto& p = problem(fmt::format("{}: the nominal {} does not fit the command", file, number));
    p.expected = fmt::format("what makes {} of the motion", result_->label_unit);
    p.found = fmt::format("what makes {}", to_string(made.in_si()));
    p.hint = "divide it by what the command makes of force, such as a force constant";
  }

  /// d = mass·a + damping·v - u. A command held over samples moves a mass so that the second difference of
  /// its position over T² is the acceleration caused by the mean of the last two commands: exact, and in
  /// phase.
  void label_from_command(const Recording& recording, const std::string& name, Rows& rows) {
    const LabelChoice& label = training_.label;
    const std::vector<double> command =
        column(recording, name, label.command, label.unit, &result_->label_unit);
    if (command.empty()) return;
    check_law(name, "mass", label.mass_unit, "s^-2");
    check_law(name, "damping", label.damping_unit, "s^-1");
    const double t = rows.sample_time;
    const auto& x = rows.position;
    const size_t n = x.size(), late = whole_count(std::round(label.delay / t));
    std::vector<double> d(n, 0.0);
    for (size_t i = late + 1; i + 1 < n; ++i) {
      const double acceleration = (x[i + 1] - 2 * x[i] + x[i - 1]) / (t * t);
      const double velocity = (x[i + 1] - x[i - 1]) / (2 * t);
      const double applied = 0.5 * (command[i - late] + command[i - late - 1]);
      d[i] = label.mass * acceleration + label.damping * velocity - applied;
    }
    if (n < late + 4) return;
    std::fill(d.begin(), d.begin() + std::ptrdiff_t(late + 1), d[late + 1]);
    d[n - 1] = d[n - 2];
    rows.label = zero_phase_low_pass(std::move(d), label.cutoff, t);
    const auto margin = whole_count(std::ceil(4 / (label.cutoff * t)));
    rows.begin = late + 1 + margin;
    rows.end = n > margin + 1 ? n - 1 - margin : 0;
  }

  void add_rows(const std::string& file, const Rows& rows) {
    for (double v : rows.velocity) {
      least_velocity_ = std::min(least_velocity_, v);
      greatest_velocity_ = std::max(greatest_velocity_, v);
    }
    if (training_.velocities.empty()) {
      TrainingSamples::Section section{file, 0, rows.time.front(), rows.time.back(), 0, 0, 0};
      for (size_t i = rows.begin; i < rows.end; ++i)
        if (std::abs(rows.velocity[i]) >= training_.slowest) add(rows, i, rows.velocity[i], section);
      if (section.count) result_->sections.push_back(section);
      return;
    }
    seen_.resize(training_.velocities.size(), false);
    for (size_t which = 0; which < training_.velocities.size(); ++which) add_sections(file, rows, which);
  }

  /// Every section of rows at one of the velocities.
  void add_sections(const std::string& file, const Rows& rows, size_t which) {
    const double wanted = training_.velocities[which];
    const auto keeps = [&](size_t i) {
      return std::abs(rows.velocity[i] - wanted) <= training_.velocity_tolerance * std::abs(wanted) + 1e-9;
    };
    const auto settled = whole_count(std::ceil(training_.settling / rows.sample_time));
    for (size_t i = 0; i < rows.time.size();) {
      size_t next = i + 1;
      if (keeps(i)) {
        while (next < rows.time.size() && keeps(next)) ++next;
        const size_t first = std::max(i + settled, rows.begin), last = std::min(next, rows.end);
        // Shorter sections are ramps that pass through the velocity.
        if (last > first + settled + 20) add_window(file, rows, which, first, last - settled);
      }
      i = next;
    }
  }
  void add_window(const std::string& file, const Rows& rows, size_t which, size_t first, size_t last) {
    const double center = training_.window_centers.empty()
                              ? 0.5 * (rows.position[first] + rows.position[last - 1])
                              : training_.window_centers[which];
    const double half = 0.5 * training_.window_length;
    const double velocity = training_.velocities[which];
    TrainingSamples::Section section{file, velocity, 0, 0, 0, 0, 0};
    for (size_t i = first; i < last; ++i)
      if (half == 0 || std::abs(rows.position[i] - center) <= half)
        add(rows, i, training_.pairing == VelocityPairing::plateau ? velocity : rows.velocity[i], section);
    if (section.count == 0) return;
    seen_[which] = true;
    result_->sections.push_back(section);
  }
  void add(const Rows& rows, size_t i, double velocity, TrainingSamples::Section& section) {
    const double x = rows.position[i];
    if (section.count++ == 0) section.from = rows.time[i], section.low = section.high = x;
    section.to = rows.time[i];
    section.low = std::min(section.low, x), section.high = std::max(section.high, x);
    result_->samples.inputs.push_back({x - training_.homing_offset, velocity});
    result_->samples.labels.push_back(rows.label[i]);
  }

  void warn_of_missing_velocities() {
    for (size_t i = 0; i < seen_.size(); ++i)
      if (!seen_[i])
        result_->warnings.push_back(fmt::format(
            "no section of the recordings keeps {:.4g} m/s in its window: nothing was learned there",
            training_.velocities[i]));
  }

  void thin() {
    gp::Samples& all = result_->samples;
    const size_t n = result_->before_thinning = all.labels.size(), most = size_t(training_.most_samples);
    if (most == 0 || n <= most) return;
    gp::Samples kept;
    for (size_t i = 0; i < most; ++i) {
      const size_t k = i * n / most;
      kept.inputs.push_back(all.inputs[k]);
      kept.labels.push_back(all.labels[k]);
    }
    all = std::move(kept);
  }

  const Training& training_;
  Problems& problems_;
  std::shared_ptr<TrainingSamples> result_ = std::make_shared<TrainingSamples>();
  std::string position_unit_;
  std::vector<bool> seen_;
  double least_velocity_ = 1e300, greatest_velocity_ = -1e300;
};

}  // namespace

std::shared_ptr<const TrainingSamples> collect_samples(const Training& training, Problems& problems) {
  return Collector(training, problems).run();
}

}  // namespace loopwright
