#include "engine/plan/times.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include "engine/solve/solver.h"
#include "models/real/double_functions.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

class Times {
 public:
  Times(const Diagram& diagram, const FlatDiagram& flat, Plan& plan, Problems& problems)
      : diagram_(diagram), flat_(flat), plan_(plan), problems_(problems) {}

  void run(const std::vector<int>& flat_of_block) {
    read_solver();
    read_sample_times();
    choose_defaults();
    if (!find_base()) return;
    assign(flat_of_block);
  }

 private:
  std::optional<Fraction> fraction(double value, const Place& place, const std::string& block,
                                   std::string_view name, bool may_be_zero) {
    const auto time = to_fraction(value);
    if (time && (may_be_zero || time->numerator > 0)) return time;
    auto& p = problems_.error(place, place.pointer(), block,
                              fmt::format("{} cannot be kept exactly as a whole number of ticks", name));
    p.expected = fmt::format("a {} time of at most 2e12 s that is a fraction with a denominator below 2e9",
                             may_be_zero ? "non-negative" : "positive");
    p.found = fmt::format("{}", value);
    return {};
  }
  std::optional<Fraction> solver_time(const Setting<double>& setting, std::string_view name,
                                      bool may_be_zero = false) {
    if (!setting.is_given) return {};
    return fraction(setting.value, setting.place, "", name, may_be_zero);
  }

  void check_tolerance(const Setting<double>& tolerance, std::string_view name, double least, double below) {
    if (!tolerance.is_given || (tolerance.value >= least && tolerance.value < below)) return;
    auto& p = problems_.error(tolerance.place, tolerance.place.pointer(), "",
                              fmt::format("\"{}\" is out of range", name));
    p.expected = fmt::format("a number of at least {}{}", least,
                             below < infinity ? fmt::format(" and below {}", below) : "");
    p.found = fmt::format("{}", tolerance.value);
  }

  void read_solver() {
    const SolverSettings& solver = diagram_.solver;
    if (const auto method = method_from_name(solver.method.value))
      plan_.method = *method;
    else {
      std::vector<std::string> names;
      for (const MethodFacts& f : all_methods) names.emplace_back(f.name);
      auto& p = problems_.error(solver.method.place, solver.method.place.pointer(), "",
                                "there is no such solver method");
      p.expected = fmt::format("one of {}", fmt::join(names, ", "));
      p.found = "\"" + solver.method.value + "\"";
      if (const std::string near = nearest_name(solver.method.value, names); !near.empty())
        p.hint = fmt::format("did you mean \"{}\"?", near);
    }
    const auto refuse = [&](const auto& setting, std::string_view name, std::string_view why) {
      if (setting.is_given)
        problems_
            .error(setting.place, setting.place.pointer(), "",
                   fmt::format("\"{}\" has no meaning for the method \"{}\"", name, solver.method.value))
            .hint = why;
    };
    if (is_fixed_step(plan_.method)) {
      refuse(solver.relative_tolerance, "relative_tolerance",
             "a fixed-step method has no error control: choose \"step\", or a variable-step method such as "
             "\"dopri5\"");
      refuse(solver.absolute_tolerance, "absolute_tolerance",
             "a fixed-step method has no error control: choose \"step\", or a variable-step method such as "
             "\"dopri5\"");
      refuse(solver.maximum_step, "maximum_step", "a fixed-step method takes \"step\"");
    } else {
      refuse(solver.step, "step",
             "a variable-step method chooses its steps: \"relative_tolerance\", \"absolute_tolerance\" and "
             "\"maximum_step\" guide it");
    }
    if (!is_fixed_step(plan_.method)) {
      check_tolerance(solver.relative_tolerance, "relative_tolerance", smallest_relative_tolerance, 1);
      check_tolerance(solver.absolute_tolerance, "absolute_tolerance", 1e-100,
                      infinity);  // solvers square its reciprocal
    }
    plan_.relative_tolerance = solver.relative_tolerance.value;
    plan_.absolute_tolerance = solver.absolute_tolerance.value;
    plan_.maximum_step = solver.maximum_step.value;
    plan_.seed = solver.seed.value;
    start_ = solver_time(solver.start, "start", true).value_or(Fraction{0, 1});
    stop_ = solver_time(solver.stop, "stop", true);
    step_ = solver_time(solver.step, "step");
    record_ = solver_time(solver.record_step, "record_step");
    if (!solver.stop.is_given) {
      auto& p =
          problems_.error(solver.place, solver.place.pointer(), "", "the solver does not say when to stop");
      p.expected = "\"solver\": {\"stop\": seconds}";
    } else if (stop_ && stop_->value() < start_.value()) {
      problems_
          .error(solver.stop.place, solver.stop.place.pointer(), "", "the stop time lies before the start")
          .found = fmt::format("{}", stop_->value());
    }
  }

  void read_sample_times() {
    sample_times_.resize(flat_.blocks.size());
    for (size_t b = 0; b < flat_.blocks.size(); ++b) {
      const FlatBlock& block = flat_.blocks[b];
      const BlockInfo& info = block.type->info;
      const BlockEntry& entry = *block.entry;
      if (!entry.sample_time) {
        if (info.is_sampled) {
          auto& p = problems_.error(entry.place, entry.place.pointer(), block.path,
                                    fmt::format("{} remembers samples: it needs a sample time", info.type));
          p.expected = "\"sample_time\": seconds";
        }
        if (entry.sample_offset)
          problems_.error(entry.sample_offset->place, entry.sample_offset->place.pointer(), block.path,
                          "a sample offset without a sample time");
        continue;
      }
      if (info.is_continuous) {
        auto& p = problems_.error(entry.sample_time->place, entry.sample_time->place.pointer(), block.path,
                                  fmt::format("{} is continuous: it takes no sample time", info.type));
        p.hint = "leave it out; to sample its output, wire it to a ZeroOrderHold or a sampled block";
        continue;
      }
      const auto period =
          fraction(entry.sample_time->number, entry.sample_time->place, block.path, "the sample time", false);
      if (!period) continue;
      Fraction offset{0, 1};
      if (entry.sample_offset) {
        const auto given = fraction(entry.sample_offset->number, entry.sample_offset->place, block.path,
                                    "the sample offset", true);
        if (!given) continue;
        if (given->value() >= period->value()) {
          auto& p = problems_.error(entry.sample_offset->place, entry.sample_offset->place.pointer(),
                                    block.path, "the sample offset is not shorter than the sample time");
          p.expected = fmt::format("less than {} s", period->value()),
          p.found = fmt::format("{}", given->value());
        }
        offset = *given;
      }
      sample_times_[b] = {*period, offset};
      warn_of_few_samples(*period, block);
      if (!fastest_ || period->value() < fastest_->value()) fastest_ = *period;
    }
  }
  /// A sample time given in milliseconds instead of seconds, or vice versa.
  void warn_of_few_samples(const Fraction& period, const FlatBlock& block) {
    constexpr double few = 10;
    const double duration = stop_ ? stop_->value() - start_.value() : 0;
    if (duration <= 0 || period.value() * few <= duration * (1 + 1e-12)) return;
    if (std::ranges::find(told_, period) != told_.end()) return;
    told_.push_back(period);
    const Place& place = block.entry->sample_time->place;
    auto& p = problems_.warning(
        place, place.pointer(), block.path,
        fmt::format("a sample time of {:g} s in a run of {:g} s: it is sampled fewer than {:g} times",
                    period.value(), duration, few));
    p.hint = "is the sample time, or \"stop\", in another unit than seconds?";
  }

  /// The largest 1, 2 or 5 times a power of ten that is not above x.
  static Fraction round_time(double x) {
    const double power = any_power(10, std::floor(decimal_logarithm(x)));
    const double digit = x / power >= 5 ? 5 : x / power >= 2 ? 2 : 1;
    return to_fraction(digit * power).value_or(Fraction{1, 1000});
  }
  void choose_defaults() {
    const double duration = stop_ ? stop_->value() - start_.value() : 0;
    const Fraction usual = fastest_ ? *fastest_ : round_time(duration > 0 ? duration / 1000 : 1e-3);
    if (!step_ && is_fixed_step(plan_.method)) step_ = usual;
    if (!record_) record_ = !fastest_ && step_ ? *step_ : usual;
    plan_.typical_step = std::min(step_ ? step_->value() : usual.value(), plan_.maximum_step);
  }

  bool find_base() {
    Fraction base{0, 1};
    for (const auto& time : sample_times_)
      if (time)
        for (const Fraction& f : {time->first, time->second})
          if (!add(base, f)) return false;
    for (const auto& f : {step_, record_})
      if (f && !add(base, *f)) return false;
    start_ = beside_tick(start_, base);
    if (!add(base, start_)) return false;
    if (base.numerator == 0) base = {1, 1000};
    plan_.clock.base = shared_ = base;
    if (!stop_) return true;
    const auto are_counted = [&](const Fraction& tick) {
      return stop_->value() / tick.value() * double(tick.numerator) < 9e15 &&
             tick.denominator < int64_t(9e15);
    };
    // The stop time need not be a tick of the rates. A finer base costs nothing as long as ticks can be
    // counted.
    if (!whole_ratio(*stop_, base)) {
      const auto finer = common_divisor(base, *stop_);
      if (finer && are_counted(*finer)) plan_.clock.base = base = *finer;
    }
    const double ticks = stop_->value() / base.value();
    if (are_counted(base)) return true;
    const SolverSettings& solver = diagram_.solver;  // a stop time from elsewhere has no place of its own
    const Place& place = solver.stop.place.file ? solver.stop.place : solver.place;
    auto& p =
        problems_.error(place, place.pointer(), "",
                        fmt::format("the run has {:.3g} ticks of {:.3g} s, more than can be counted exactly",
                                    ticks, base.value()));
    p.hint = "sample times, step and record_step with a larger common divisor make longer ticks";
    return false;
  }
  /// A record begins at a multiple of its sample time. Of such a pair of decimals each is read as a fraction
  /// with an error of its own, and together they would ask for ticks that cannot be counted.
  Fraction beside_tick(const Fraction& time, const Fraction& base) const {
    constexpr double error = 1e-6;  // of the step, or of a row
    const double smallest =
        std::min(step_ ? step_->value() : infinity, record_ ? record_->value() : infinity);
    const double ticks = std::round(time.value() / base.value());
    if (base.numerator == 0 || !(ticks * double(base.numerator) < 9e15)) return time;
    const int64_t numerator = int64_t(ticks) * base.numerator, shared = std::gcd(numerator, base.denominator);
    const Fraction tick{numerator / shared, base.denominator / shared};
    return std::abs(tick.value() - time.value()) < error * smallest ? tick : time;
  }
  bool add(Fraction& base, const Fraction& time) {
    const auto both = common_divisor(base, time);
    if (both &&
        (base.numerator == 0 ||
         both->value() > 1e-9 * std::min(base.value(), time.numerator ? time.value() : base.value()))) {
      base = *both;
      return true;
    }
    auto& p = problems_.error(
        diagram_.solver.place, diagram_.solver.place.pointer(), "",
        fmt::format("sample times, step and record_step have no common base period: {:.12g} s and {:.12g} s",
                    base.value(), time.value()));
    p.hint = "choose times with a simple ratio, such as 0.001 and 0.0025";
    return false;
  }

  void assign(const std::vector<int>& flat_of_block) {
    const Fraction base = plan_.clock.base;
    plan_.start_tick = whole_ratio(start_, base).value_or(0);
    if (stop_)
      plan_.stop_tick = whole_ratio(*stop_, base)
                            .value_or(whole_between(std::ceil(stop_->value() / base.value() - 1e-9),
                                                    plan_.start_tick, INT64_MAX));
    plan_.step_ticks = step_ ? whole_ratio(*step_, base).value_or(1) : whole_ratio(shared_, base).value_or(1);
    plan_.record_ticks = whole_ratio(*record_, base).value_or(1);
    for (size_t b = 0; b < plan_.blocks.size(); ++b) {
      if (flat_of_block[b] < 0 || !sample_times_[size_t(flat_of_block[b])]) continue;
      const auto& [period, offset] = *sample_times_[size_t(flat_of_block[b])];
      plan_.blocks[b].period = whole_ratio(period, base).value_or(1);
      plan_.blocks[b].offset = whole_ratio(offset, base).value_or(0);
      plan_.blocks[b].sample_time = period.value();
    }
  }

  const Diagram& diagram_;
  const FlatDiagram& flat_;
  Plan& plan_;
  Problems& problems_;
  std::vector<std::optional<std::pair<Fraction, Fraction>>> sample_times_;
  Fraction start_{0, 1}, shared_{1, 1};  // shared_: the base period of all times except the stop time
  std::optional<Fraction> stop_, step_, record_, fastest_;
  std::vector<Fraction> told_;  // sample times already warned about
};

}  // namespace

void find_times(const Diagram& diagram, const FlatDiagram& flat, const std::vector<int>& flat_of_block,
                Plan& plan, Problems& problems) {
  Times(diagram, flat, plan, problems).run(flat_of_block);
}

}  // namespace loopwright
