#include "tools/studies/linear_motor/statements.h"
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include "tools/studies/linear_motor/runs.h"

namespace loopwright::paper {
namespace {

constexpr const char *error = "error.sum", *learned_estimate = "compensation.estimate",
                     *observed = "controller.disturbance", *command = "controller.command";
constexpr std::array<const char*, 5> section_names{"0-0.2 s", "0.2-1.2 s", "1.2-1.4 s", "1.4-2.4 s",
                                                   "2.4-2.6 s"};
constexpr std::array<size_t, 3> blends{0, 2, 4};
constexpr std::array<size_t, 2> plateaus{1, 3};

/// Rows of the motion, selected by position and by velocity; the runs share their times and motion.
class Rows {
 public:
  Rows(const Recording& run, const std::vector<Stretch>& trained)
      : time_(column(run, "time")),
        position_(column(run, "reference.position")),
        velocity_(column(run, "reference.velocity")),
        trained_(trained) {}
  bool in_motion(size_t i) const { return time_[i] >= motion_start_s && time_[i] <= motion_end_s; }
  /// At least `margin` [m] away from every trained position (or within, for a negative margin).
  bool outside(size_t i, double margin) const {
    return std::ranges::none_of(trained_, [&](const Stretch& s) {
      return position_[i] >= s.from - margin && position_[i] <= s.to + margin;
    });
  }
  bool at_constant_velocity(size_t i) const {
    return std::abs(velocity_[i] - 0.15) < 1e-9 || std::abs(velocity_[i] - 0.35) < 1e-9;
  }
  size_t size() const { return time_.size(); }
  double position(size_t i) const { return position_[i]; }
  double velocity(size_t i) const { return velocity_[i]; }

 private:
  std::span<const double> time_, position_, velocity_;
  const std::vector<Stretch>& trained_;
};

template <class Chosen>
double rms_where(const Rows& rows, const Recording& run, const char* name, Chosen chosen) {
  const auto values = column(run, name);
  double sum = 0, count = 0;
  for (size_t i = 0; i < rows.size(); ++i)
    if (rows.in_motion(i) && chosen(i)) sum += values[i] * values[i], ++count;
  return count > 0 ? std::sqrt(sum / count) : 0;
}

double rms_in_section(const Recording& run, const char* name, size_t section) {
  return rms_between(run, name, section_borders_s[section], section_borders_s[section + 1]);
}

/// Greatest |a - b| of a column within a section; b null: greatest |a|.
double peak_in_section(const Recording& a, const Recording* b, const char* name, size_t section) {
  const auto time = column(a, "time"), values = column(a, name);
  const auto others = b ? column(*b, name) : std::span<const double>{};
  double peak = 0;
  for (size_t i = 0; i < time.size(); ++i) {
    const double since = time[i] - motion_start_s;
    if (since < section_borders_s[section] || since > section_borders_s[section + 1]) continue;
    peak = std::max(peak, std::abs(values[i] - (b ? others[i] : 0)));
  }
  return peak;
}

struct Mean {
  double sum = 0, square = 0, count = 0;
  void add(double x) { sum += x, square += x * x, ++count; }
  double deviation() const {
    return count > 0 ? std::sqrt(std::max(0.0, square / count - sum * sum / (count * count))) : 0;
  }
};

/// Standard deviation of the learned estimate about its mean at each of the two velocities.
template <class Chosen> double ripple(const Rows& rows, const Recording& run, Chosen chosen) {
  const auto values = column(run, learned_estimate);
  std::array<Mean, 2> at;
  for (size_t i = 0; i < rows.size(); ++i)
    if (rows.in_motion(i) && rows.at_constant_velocity(i) && chosen(i))
      at[rows.velocity(i) > 0.2].add(values[i]);
  const double count = at[0].count + at[1].count;
  return count > 0 ? std::sqrt((at[0].count * std::pow(at[0].deviation(), 2) +
                                at[1].count * std::pow(at[1].deviation(), 2)) /
                               count)
                   : 0;
}

/// Greatest difference between the estimate and that one pole pitch before, outside at constant velocity.
double change_over_a_pitch(const Rows& rows, const Recording& run) {
  constexpr double pitch = 0.0225;
  const auto values = column(run, learned_estimate), position = column(run, "stage.position");
  double worst = 0;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (!rows.in_motion(i) || !rows.at_constant_velocity(i) || !rows.outside(i, 0)) continue;
    const auto after =
        std::lower_bound(position.begin(), position.begin() + ptrdiff_t(i), position[i] - pitch);
    const size_t j = size_t(after - position.begin());
    if (j == 0 || rows.velocity(j - 1) != rows.velocity(i)) continue;
    const double share = (position[i] - pitch - position[j - 1]) / (position[j] - position[j - 1]);
    worst = std::max(worst, std::abs(values[i] - ((1 - share) * values[j - 1] + share * values[j])));
  }
  return worst;
}

std::string um(double value) { return fmt::format("{:.1f} µm", 1e6 * value); }

class Checks {
 public:
  Checks(const FigureRuns& runs, const std::vector<Stretch>& trained)
      : r(runs), rows(runs.conventional, trained) {}
  std::vector<Statement> all() {
    tracking(), estimates(), observer(), effort(), payload_error(), payload_signals();
    return std::move(list);
  }

 private:
  const FigureRuns& r;
  const Rows rows;
  std::vector<Statement> list;

  void add(std::string key, std::string figure, std::string claim, std::string measured, bool holds) {
    list.push_back({std::move(key), std::move(figure), std::move(claim), std::move(measured), holds});
  }
  auto inside() const {
    return [this](size_t i) { return !rows.outside(i, 0); };
  }
  auto outside() const {
    return [this](size_t i) { return rows.outside(i, 0); };
  }

  void tracking() {
    std::string where;
    bool largest = true;
    for (size_t s = 0; s < section_names.size(); ++s) {
      const double conventional = rms_in_section(r.conventional, error, s),
                   ds = rms_in_section(r.ds, error, s), ps = rms_in_section(r.ps, error, s);
      where += fmt::format("{}{}: {:.1f} / {:.1f} / {:.1f}", s ? "; " : "", section_names[s],
                           1e6 * conventional, 1e6 * ds, 1e6 * ps);
      largest &= conventional > ds && conventional > ps;
    }
    add("conventional_largest", "Fig. 10",
        "The conventional controller shows the largest error in all sections",
        "RMS conv / DS / PS in µm, " + where, largest);
    const auto rms = [&](const Recording& run, auto where_) { return rms_where(rows, run, error, where_); };
    const double out_conventional = rms(r.conventional, outside()), out_ds = rms(r.ds, outside()),
                 out_ps = rms(r.ps, outside());
    const double in_conventional = rms(r.conventional, inside()), in_ds = rms(r.ds, inside()),
                 in_ps = rms(r.ps, inside());
    add("ds_as_conventional_outside", "Fig. 10", "Outside the trained range DS is close to conventional",
        fmt::format("{} against {}", um(out_ds), um(out_conventional)),
        std::abs(out_ds / out_conventional - 1) < 0.15);
    add("ds_better_inside", "Fig. 10", "Inside, DS has a smaller error than conventional",
        fmt::format("{} against {}", um(in_ds), um(in_conventional)), in_ds < in_conventional);
    add("ps_better_outside", "Fig. 10", "PS has a smaller error than conventional even outside",
        fmt::format("{} against {}", um(out_ps), um(out_conventional)), out_ps < out_conventional);
    add("ps_better_than_ds_inside", "Fig. 10", "Inside, PS keeps a smaller error than DS",
        fmt::format("{} against {}", um(in_ps), um(in_ds)), in_ps < in_ds);
  }

  void estimates() {
    const auto far = [this](size_t i) { return rows.outside(i, 0.02); };
    const double ds_far = ripple(rows, r.ds, far), ds_in = ripple(rows, r.ds, inside());
    add("ds_constant_outside", "Fig. 11",
        "The DS estimate settles at a fixed value outside the trained range",
        fmt::format("ripple {:.1f} mV from 20 mm outside on, {:.0f} mV inside", 1e3 * ds_far, 1e3 * ds_in),
        ds_far < 0.05 * ds_in);
    const double ps_out = ripple(rows, r.ps, outside()), ps_in = ripple(rows, r.ps, inside()),
                 change = change_over_a_pitch(rows, r.ps);
    add("ps_periodic_outside", "Fig. 11", "The PS estimate goes on periodically outside",
        fmt::format(
            "ripple {:.0f} mV outside, {:.0f} mV inside; at most {:.0f} mV from one pitch to the next",
            1e3 * ps_out, 1e3 * ps_in, 1e3 * change),
        ps_out > 0.8 * ps_in && change < 0.1 * ps_out);
  }

  void observer() {
    const auto everywhere = [](size_t) { return true; };
    const auto rms = [&](const Recording& run, auto where) { return rms_where(rows, run, observed, where); };
    add("observer_falls", "Fig. 12", "The DOB output is largest in the conventional case",
        fmt::format("RMS {:.3f} V, DS {:.3f}, PS {:.3f}", rms(r.conventional, everywhere),
                    rms(r.ds, everywhere), rms(r.ps, everywhere)),
        rms(r.conventional, everywhere) > rms(r.ds, everywhere) &&
            rms(r.conventional, everywhere) > rms(r.ps, everywhere));
    add("observer_ds_outside", "Fig. 12", "Outside, the DOB output under DS is close to the conventional one",
        fmt::format("{:.3f} V against {:.3f}", rms(r.ds, outside()), rms(r.conventional, outside())),
        std::abs(rms(r.ds, outside()) / rms(r.conventional, outside()) - 1) < 0.15);
    add("observer_ds_inside", "Fig. 12", "Inside, it decreases under DS",
        fmt::format("{:.3f} V against {:.3f}", rms(r.ds, inside()), rms(r.conventional, inside())),
        rms(r.ds, inside()) < rms(r.conventional, inside()));
    std::string where;
    bool lower = true;
    for (size_t s = 0; s < section_names.size(); ++s) {
      const double conventional = rms_in_section(r.conventional, observed, s),
                   ps = rms_in_section(r.ps, observed, s);
      where += fmt::format("{}{}: {:.3f} / {:.3f}", s ? "; " : "", section_names[s], conventional, ps);
      lower &= ps < conventional;
    }
    add("observer_ps_everywhere", "Fig. 12", "Under PS it stays lower throughout",
        "RMS conv / PS in V, " + where, lower);
  }

  void effort() {
    const auto everywhere = [](size_t) { return true; };
    const auto rms = [&](const Recording& run) { return rms_where(rows, run, command, everywhere); };
    const double ds = rms(r.ds) / rms(r.conventional), ps = rms(r.ps) / rms(r.conventional);
    add("effort_comparable", "Fig. 13", "The control effort is comparable in all cases",
        fmt::format("RMS of u: DS {:.3f}, PS {:.3f} of conventional", ds, ps),
        std::abs(ds - 1) < 0.05 && std::abs(ps - 1) < 0.05);
  }

  void payload_error() {
    for (const size_t s : blends) {
      const double ds = peak_in_section(r.ds_loaded, nullptr, error, s) /
                        peak_in_section(r.ds, nullptr, error, s),
                   ps = peak_in_section(r.ps_loaded, nullptr, error, s) /
                        peak_in_section(r.ps, nullptr, error, s);
      add(fmt::format("payload_error_{}", s), "Fig. 14",
          fmt::format("With payload the peak error grows in {}", section_names[s]),
          fmt::format("DS × {:.2f}, PS × {:.2f}", ds, ps), ds > 1 && ps > 1);
    }
    std::string where;
    bool similar = true;
    for (const size_t s : plateaus) {
      const double ds = rms_in_section(r.ds_loaded, error, s) / rms_in_section(r.ds, error, s),
                   ps = rms_in_section(r.ps_loaded, error, s) / rms_in_section(r.ps, error, s);
      where +=
          fmt::format("{}{}: DS × {:.2f}, PS × {:.2f}", where.empty() ? "" : "; ", section_names[s], ds, ps);
      similar &= std::max(ds, ps) < 1.5;
    }
    add("payload_trend", "Fig. 14", "The overall trend remains similar at constant velocity", where, similar);
    double peak = 0, without = 0;
    for (size_t s = 0; s < section_names.size(); ++s) {
      peak = std::max({peak, peak_in_section(r.ds_loaded, nullptr, error, s),
                       peak_in_section(r.ps_loaded, nullptr, error, s)});
      without = std::max(
          {without, peak_in_section(r.ds, nullptr, error, s), peak_in_section(r.ps, nullptr, error, s)});
    }
    add("payload_stable", "Fig. 14", "The loop stays stable with payload",
        fmt::format("greatest error {}, without payload {}", um(peak), um(without)), peak < 3 * without);
  }

  void payload_signals() {
    double estimate = 0, blend = 0, plateau = 0, command_blend = 1e9;
    for (const auto& [loaded, plain] : {std::pair{&r.ds_loaded, &r.ds}, std::pair{&r.ps_loaded, &r.ps}}) {
      for (size_t s = 0; s < section_names.size(); ++s)
        estimate = std::max(estimate, peak_in_section(*loaded, plain, learned_estimate, s));
      for (const size_t s : plateaus)
        plateau = std::max(plateau, peak_in_section(*loaded, plain, observed, s));
      for (const size_t s : blends)
        command_blend = std::min(command_blend, peak_in_section(*loaded, nullptr, command, s) /
                                                    peak_in_section(*plain, nullptr, command, s));
    }
    std::string where;
    bool grows = true;
    for (const size_t s : blends) {
      blend = std::min(peak_in_section(r.ds_loaded, &r.ds, observed, s),
                       peak_in_section(r.ps_loaded, &r.ps, observed, s));
      where += fmt::format("{}{:.2f} V in {}", where.empty() ? "" : ", ", blend, section_names[s]);
      grows &= blend > plateau;
    }
    add("payload_estimate_unchanged", "Fig. 15", "The estimate of the GPR remains almost unchanged",
        fmt::format("by at most {:.0f} mV", 1e3 * estimate), estimate < 0.05);
    add("payload_observer_grows", "Fig. 16", "The DOB output grows while the stage accelerates or brakes",
        fmt::format("change at least {}; at constant velocity at most {:.2f} V", where, plateau), grows);
    add("payload_effort_grows", "Fig. 17", "The control input grows while the stage accelerates or brakes",
        fmt::format("peak × {:.2f} at least", command_blend), command_blend > 1);
  }
};

}  // namespace

std::vector<Statement> check_statements(const FigureRuns& runs, const std::vector<Stretch>& trained) {
  return Checks(runs, trained).all();
}

}  // namespace loopwright::paper
