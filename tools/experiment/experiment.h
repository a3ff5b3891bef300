/// An experiment file relates recorded columns to a diagram: which columns drive it, and which are compared
/// with it.
#pragma once
#include <memory>
#include <optional>
#include "engine/diagram/diagram.h"
#include "engine/record/recording.h"
#include "engine/record/time_axis.h"
#include "models/signal/between_rows.h"
#include "tools/experiment/slower_rows.h"

namespace loopwright {

/// A recorded column with its unit, in SI units once read.
struct RecordedSignal {
  std::string port;  ///< of the diagram, "axis.position"
  std::string column;
  std::string unit;       ///< as written in the experiment; numbers below are in SI
  double resolution = 0;  ///< SI; 0: not stated
  BetweenRows between_rows = BetweenRows::hold;
  SlowerRows rows;  ///< of a compared signal: those with a reading; the numbers of all others are NaN
  Place place;
  std::string pointer;
};

/// Where an effect may read and act; used by the diagnosis.
struct Roles {
  std::vector<std::pair<std::string, std::string>> ports;  ///< "position" → "axis.position"
  std::vector<Place> places;
};

struct Experiment {
  std::string title, path;
  Place place;            ///< of the file's object
  std::string data_path;  ///< the file that was found
  std::string time_column;
  Recording data;  ///< driving and compared columns in SI, "time" first
  TimeAxis time;
  std::vector<RecordedSignal> drives, compared;
  Roles roles;
  /// Values of the diagram that this record is known to have: path as for `--set` → value.
  std::vector<Value::Member> set;
  std::vector<Wire> sites;  ///< ports to which a diagnosis without roles is limited; empty: all
  double hold_out_fraction =
      0;  ///< fraction of the rows, at the end, held out of any fit; 1: the whole record
  /// Every row is a position at which the axis stood in balance, a map of holding forces: see
  /// gather_balances.
  bool is_map = false;
  Place map_place;
};

/// Reads the experiment and its data. Data files are searched beside the experiment, then below
/// $LOOPWRIGHT_DATA. Null when there are errors.
std::shared_ptr<const Experiment> load_experiment(const std::string& path, Problems& problems);
/// The same of several, in their order.
std::vector<std::shared_ptr<const Experiment>> load_experiments(const std::vector<std::string>& paths,
                                                                Problems& problems);
/// With errors the result contains what could be read, ports without columns; null if nothing could be read.
std::shared_ptr<const Experiment> read_experiment(const std::string& path, Problems& problems);


/// Load options with the values that this record is known to have; what `--set` states of the same does not
/// count.
LoadOptions with_own_values(const Experiment& experiment, LoadOptions options);

/// Load options that make a diagram follow the experiment: its own values, its
/// drives, and the run's stop and rows.
LoadOptions follow(const Experiment& experiment, LoadOptions options);

}  // namespace loopwright
