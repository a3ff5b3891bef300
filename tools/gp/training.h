/// A training file: which recordings, which part of them, what was disturbance, and which kernel shall learn
/// it.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "engine/json/problem.h"
#include "engine/unit/unit.h"
#include "models/gp/hyperparameters.h"

namespace loopwright {

/// A column of the recordings; `unit` where the recording does not say it.
struct ColumnChoice {
  std::string column, unit;
};

/// Where the disturbance comes from. Either columns that are added up (an observer's estimate, plus what a
/// compensation already cancelled), late by `lag` because a filter made them; or, with `command`, the
/// nominal plant's equation d = mass·a + damping·v - u behind a zero-phase low pass, which has no lag.
struct LabelChoice {
  std::vector<std::string> columns;
  std::string unit, command;
  double lag = 0;                                 ///< s
  double mass = 0, damping = 0;                   ///< nominal; label unit per m/s², per m/s
  double cutoff = 0;                              ///< rad/s
  double delay = 0;                               ///< s from command to force
  std::optional<Unit> mass_unit, damping_unit{};  ///< where they were written with one
};

/// Which velocity stands beside a position: the constant one of the section (few distinct values), or the one
/// measured.
enum class VelocityPairing { plateau, measured };
constexpr auto names_of(VelocityPairing) { return std::array<std::string_view, 2>{"plateau", "measured"}; }

/// PE(x) + SE(v), SE(x) + SE(v), PE(x)·SE(v) + SE(v), or any terms.
enum class KernelChoice { ps, ds, product, terms };
constexpr auto names_of(KernelChoice) {
  return std::array<std::string_view, 4>{"ps", "ds", "product", "terms"};
}

struct PriorChoice {
  std::string parameter;
  double median = 0, log_deviation = 0, low = 0, high = 0;  ///< 0: as the default prior has it
};

/// Numbers in SI units.
struct Training {
  std::string path, title;
  std::vector<std::string> recordings;
  std::string time;
  ColumnChoice position, velocity;
  LabelChoice label;
  std::vector<double> velocities;      ///< of the constant-velocity sections; empty: every sample that moves
  double velocity_tolerance = 0.05;    ///< share of the velocity
  double settling = 0;                 ///< s at both ends of a section that are left out
  double window_length = 0;            ///< m, about the middle of each section; 0: the whole section
  std::vector<double> window_centers;  ///< m, one a velocity, in place of the middles
  double slowest = 0.01;               ///< m/s; without velocities, slower samples are left out
  VelocityPairing pairing = VelocityPairing::plateau;
  KernelChoice kernel = KernelChoice::ps;
  std::vector<gp::Term> terms;  ///< for KernelChoice::terms: shapes only
  double period = 0;            ///< m
  bool fits_period = false;
  double period_search = 0.05;  ///< share of the period to either side
  double homing_offset = 0;     ///< m
  int most_samples = 0;         ///< 0: all
  std::vector<PriorChoice> priors;
  std::shared_ptr<const SourceFile> source;
};

/// Reads a training file with changes ("kernel", "ds"). Null when there are errors.
std::shared_ptr<const Training> load_training(const std::string& path,
                                              const std::vector<std::pair<std::string, std::string>>& set,
                                              Problems& problems);

/// The shapes of the chosen kernel; sizes are for a fit to find.
gp::Kernel kernel_of(const Training& training);

}  // namespace loopwright
