/// A training file: which recordings, which part of them, which signal is the disturbance, and which kernel
/// learns it.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "engine/json/problem.h"
#include "engine/unit/unit.h"
#include "models/gp/hyperparameters.h"

namespace loopwright {

/// A column of the recordings; `unit` if the recording does not state it.
struct ColumnChoice {
  std::string column, unit;
};

/// Source of the disturbance. Either columns that are summed (an observer's estimate, plus the part already
/// canceled by a compensation), delayed by `lag` because of a filter; or, with `command`, the nominal plant's
/// equation d = mass·a + damping·v - u followed by a zero-phase low-pass filter, which has no lag.
struct LabelChoice {
  std::vector<std::string> columns;
  std::string unit, command;
  double lag = 0;                                 ///< s
  double mass = 0, damping = 0;                   ///< nominal; label unit per m/s², per m/s
  double cutoff = 0;                              ///< rad/s
  double delay = 0;                               ///< s from command to force
  std::optional<Unit> mass_unit, damping_unit{};  ///< if they were written with one
};

/// The velocity paired with a position: the constant one of the section (few distinct values), or the
/// measured one.
enum class VelocityPairing { plateau, measured };
constexpr auto names_of(VelocityPairing) { return std::array<std::string_view, 2>{"plateau", "measured"}; }

/// PE(x) + SE(v), SE(x) + SE(v), PE(x)·SE(v) + SE(v), or any terms.
enum class KernelChoice { ps, ds, product, terms };
constexpr auto names_of(KernelChoice) {
  return std::array<std::string_view, 4>{"ps", "ds", "product", "terms"};
}

struct PriorChoice {
  std::string parameter;
  double median = 0, log_deviation = 0, low = 0, high = 0;  ///< 0: as in the default prior
};

/// Numbers in SI units.
struct Training {
  std::string path, title;
  std::vector<std::string> recordings;
  std::string time;
  ColumnChoice position, velocity;
  LabelChoice label;
  std::vector<double> velocities;      ///< of the constant-velocity sections; empty: every moving sample
  double velocity_tolerance = 0.05;    ///< share of the velocity
  double settling = 0;                 ///< s left out at both ends of a section
  double window_length = 0;            ///< m, around the middle of each section; 0: the whole section
  std::vector<double> window_centers;  ///< m, one per velocity, instead of the middles
  double slowest = 0.01;               ///< m/s; without velocities, slower samples are left out
  VelocityPairing pairing = VelocityPairing::plateau;
  KernelChoice kernel = KernelChoice::ps;
  std::vector<gp::Term> terms;  ///< for KernelChoice::terms: shapes only
  double period = 0;            ///< m
  bool fits_period = false;
  double period_search = 0.05;  ///< share of the period on either side
  double homing_offset = 0;     ///< m
  int most_samples = 0;         ///< 0: all
  std::vector<PriorChoice> priors;
  std::shared_ptr<const SourceFile> source;
};

/// Reads a training file with changes ("kernel", "ds"). Null when there are errors.
std::shared_ptr<const Training> load_training(const std::string& path,
                                              const std::vector<std::pair<std::string, std::string>>& set,
                                              Problems& problems);

/// The shapes of the chosen kernel; the fit determines their sizes.
gp::Kernel kernel_of(const Training& training);

}  // namespace loopwright
