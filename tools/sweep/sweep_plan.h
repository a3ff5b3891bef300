/// A sweep ready to run: its diagram compiled once for every point of the axes that change the plan, and for
/// every run the tunable numbers set by its axes.
#pragma once
#include <map>
#include <mutex>
#include "tools/sweep/design.h"
#include "tools/sweep/metrics.h"

namespace loopwright {

/// The runs that share one plan.
struct World {
  std::shared_ptr<const Plan> plan;
  Observed observed;
  std::string
      lanes_forbidden;  ///< why each run is made alone, with its own plan; empty: they share this plan
  std::vector<std::string> tuned;  ///< paths of the numbers that differ from run to run
  /// How a number depends on the axes: `scale` times one of them, or through the loader (axis -1).
  struct Source {
    int axis = -1;
    double scale = 1;
  };
  std::vector<Source> sources;
  bool needs_loader = false;  ///< the diagram is loaded for each run: an expression depends on axes, or the
                              ///< numbers of a block must fit each other
};

class SweepPlan {
 public:
  /// Throws InputError with every problem of sweep and diagram. Values are checked by the diagram's own rules
  /// at both ends of every axis. A combination of values that the diagram refuses is a failure of its run
  /// only.
  explicit SweepPlan(std::shared_ptr<const Sweep> sweep);

  const Sweep& sweep() const { return *sweep_; }
  const SweepDesign& design() const { return *design_; }
  int64_t runs() const { return design_->runs(); }
  /// Whether the values of an axis need separate plans: variants, structural settings.
  bool changes_plan(size_t axis) const { return changes_plan_[axis]; }
  const World& world(int64_t index) const { return worlds_[size_t(index)]; }
  const World& world_of(int64_t run) const { return world(run / design_->runs_in_world()); }

  /// The options with which `loopwright run` repeats this run; its number determines the noise.
  LoadOptions options(int64_t run) const { return options_at(design_->point(run)); }
  LoadOptions options_at(const std::vector<double>& point) const;
  std::string command(const LoadOptions& options, int64_t run) const;
  /// "loopwright run 'loop.json' --set 'stage.payload=0.5 kg' --run 17"
  std::string command(int64_t run) const { return command(options(run), run); }
  /// The plan of a single run, as that command makes it; one call at a time. Throws InputError.
  std::shared_ptr<const Plan> plan_of(int64_t run) const { return load(options(run)); }
  std::shared_ptr<const Plan> load(const LoadOptions& options) const;
  /// The numbers at World::tuned for a run. Throws InputError if the diagram rejects its parameters.
  std::vector<double> tuned(int64_t run) const;

  /// Hash of the sweep file and every plan: results belong together if it is equal.
  const Identity& identity() const { return identity_; }
  const std::string& hash() const { return hash_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  /// A point that the diagram accepts. No plan: none was found.
  struct Accepted {
    std::shared_ptr<const Plan> plan;
    std::vector<double> point;
  };
  /// The plans before and after a step along one axis from a point. No plans: no such step was found.
  struct Step {
    std::shared_ptr<const Plan> before, after;
    double from = 0;
  };
  /// Consecutive runs of a design.
  struct Runs {
    const SweepDesign& design;
    int64_t first, count;
    std::vector<double> example(int i) const { return design.point(first + (count - 1) * i / examples); }
    static constexpr int examples = 16;
  };

  std::shared_ptr<const Plan> load_or_report(const std::vector<double>& point, Problems& problems) const;
  Accepted find_accepted(const Runs& runs, Problems& problems) const;
  Step find_step(const Runs& runs, const Accepted& start, size_t axis, double end, Problems& problems) const;
  std::vector<bool> find_axes_that_change_the_plan(Problems& problems) const;
  Runs runs_of(int64_t world) const;
  void make_worlds(Problems& problems);
  World make_world(int64_t index, Problems& problems, Problems& refused) const;
  void bind(World& world, const Runs& runs, const Accepted& start, Problems& problems) const;
  bool add_computed(World& world, const Accepted& start, std::map<std::string, World::Source>& found) const;
  bool predicts(const World& world, int64_t run) const;

  std::shared_ptr<const Sweep> sweep_;
  std::vector<bool> changes_plan_;  // one per axis
  std::unique_ptr<SweepDesign> design_;
  std::vector<World> worlds_;
  Identity identity_;
  std::string hash_;  // of the identity
  std::vector<std::string> warnings_;
  mutable std::mutex loading_;  // units and expressions are read by libraries that are not thread-safe
};

}  // namespace loopwright
