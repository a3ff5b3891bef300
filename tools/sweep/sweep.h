/// A sweep file: which runs of a diagram to make, what to measure in each, what to keep.
///
/// The file (docs/sweeps.md) is JSON and has the error messages of diagrams. Axes with values form a grid;
/// axes with a distribution are sampled; every point of the grid gets all samples. Run numbers count the
/// samples fastest, then the grid in the order of the file, last axis fastest, except that axes which change
/// the plan come first.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"

namespace loopwright {

/// A difference between runs: a parameter by its `--set` path, or the variant of a block.
struct Axis {
  enum class Kind { values, variants, uniform, logarithmic, normal };
  std::string name;  ///< "stage.payload"; for variants the path of the block
  Kind kind = Kind::values;
  std::string unit;                   ///< of the numbers below; empty: as `--set` reads a bare number
  std::vector<double> values;         ///< of kind values
  std::vector<std::string> variants;  ///< of kind variants
  double low = 0, high = 0;           ///< of a distribution; normal: mean and standard deviation
  int pair = -1;                      ///< steps together with this earlier axis; -1: independent
  Place place;
  std::string pointer;

  bool is_sampled() const { return kind >= Kind::uniform; }
  size_t count() const { return kind == Kind::variants ? variants.size() : values.size(); }
};

enum class Sampling {
  random,
  latin_hypercube,
  sobol,    ///< low discrepancy, shifted at random
  saltelli  ///< two such designs and their mixtures, for Sobol indices: count · (sampled axes + 2) samples
};

/// Distribution of the samples of all sampled axes in the unit cube.
struct Samples {
  Sampling method = Sampling::sobol;
  int64_t count = 1;  ///< 1 without sampled axes
};

/// One number that evaluates a run, computed while it runs.
struct Metric {
  enum class Kind {
    rms,
    mean,
    maximum,
    minimum,
    peak,             ///< greatest magnitude
    final,            ///< the last value
    settling_time,    ///< [s] from `from` to the last time outside target ± band
    overshoot,        ///< overshoot beyond the target, as seen from the first value
    percentile,       ///< of the values at the rows, by nearest rank
    first_violation,  ///< [s] when the magnitude first exceeds `threshold`; NaN: never
  };
  std::string name;
  Kind kind = Kind::rms;
  std::string signal;                          ///< a port; or with '=' an expression over ports
  std::string unit;                            ///< unit of the metric; empty: SI of the port
  double from = 0;                             ///< s
  double to = infinity;                        ///< s
  double target = 0, band = 0, threshold = 0;  ///< SI
  double percent = 95;
  double least = -infinity, most = infinity;  ///< limits, in `unit`
  Place place;
  std::string pointer;

  /// A number above that was written with a unit, which must fit once the signals are known.
  struct Stated {
    std::string key;  ///< "target"
    Unit unit;
    bool is_of_signal;  ///< otherwise of the result
    Place place;
  };
  std::vector<Stated> stated;

  static constexpr double infinity = std::numeric_limits<double>::infinity();
  bool is_time() const { return kind == Kind::settling_time || kind == Kind::first_violation; }
};

/// The runs whose full traces are written after all runs are done.
struct Keep {
  enum class Kind { none, all, failed, worst, selected };
  Kind kind = Kind::none;
  int count = 0;              ///< of worst
  std::string metric;         ///< for worst: largest first
  std::vector<int64_t> runs;  ///< selected
  Place place;
  std::string pointer;
};

struct Sweep {
  std::string title, path;
  std::string diagram;  ///< path of the diagram
  LoadOptions options;  ///< "set" and "variants" of the file, for all runs
  std::vector<Axis> axes;
  Samples samples;
  std::vector<Metric> metrics;
  Keep keep;
  uint64_t seed = 1;
  std::string text;  ///< of the file
};

/// Null when there are errors. SweepPlan checks whether axes and signals exist in the diagram.
std::shared_ptr<const Sweep> load_sweep(const std::string& path, Problems& problems);

std::string_view to_name(Metric::Kind kind);

}  // namespace loopwright
