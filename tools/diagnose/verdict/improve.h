/// Adds the effects that were found to the user's diagram.
#pragma once
#include "tools/diagnose/search/catalogue.h"
#include "tools/diagnose/search/maximum_likelihood.h"
#include "tools/effects/insert.h"
#include "tools/experiment/experiment.h"

namespace loopwright::diagnosis {

/// Tries each effect on the user's diagram, in memory.
WhyNot attachable(const std::string& diagram, const std::string& experiment, const LoadOptions& load,
                  const MachineUnits& units, const RecordSizes& sizes);

/// The user's diagram with effects, in memory.
struct ImprovedDiagram {
  std::shared_ptr<const SourceFile> file;  ///< its paths are those of the user's diagram
  std::vector<MovedPort> moved;            ///< ports that experiments must name differently with it
  std::vector<std::string> taken_out_by;   ///< of each effect the parameter that takes it out when 0
  std::vector<std::string> notes;          ///< what a lookup does beyond its range, and what has no block
};

class Improver {
 public:
  /// The roles are those of the first experiment.
  Improver(const std::string& diagram, const std::vector<std::string>& experiments, const LoadOptions& load,
           const Catalogue& catalogue, const MachineUnits& units, const RecordSizes& sizes);

  const std::vector<std::shared_ptr<const Experiment>>& experiments() const { return experiments_; }
  /// With every member's blocks. Throws InputError.
  ImprovedDiagram with(const std::vector<Member>& members) const;

 private:
  std::shared_ptr<const SourceFile> file_;
  std::vector<std::shared_ptr<const Experiment>> experiments_;
  InsertionSite site_;
  const Catalogue& catalogue_;
  const RecordSizes& sizes_;
};

/// The experiment with the ports that an improved diagram moved.
Experiment with_moved_ports(const Experiment& experiment, const std::vector<MovedPort>& moved);

/// Writes the diagram to `target`, completely or not at all, and beside it every experiment that names a
/// moved port, with the new names: "improved.json" and "improved.open_loop.experiment.json". Returns the
/// paths of the experiments. Throws InputError.
std::vector<std::string> write(const ImprovedDiagram& improved, const std::vector<std::string>& experiments,
                               const std::string& target);

}  // namespace loopwright::diagnosis
