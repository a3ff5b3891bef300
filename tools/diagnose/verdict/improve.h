/// Adds the effects that were found to the user's diagram.
#pragma once
#include "tools/diagnose/improvement.h"
#include "tools/diagnose/search/catalogue.h"
#include "tools/diagnose/search/maximum_likelihood.h"

namespace loopwright::diagnosis {

/// Tries each effect on the user's diagram, in memory. An effect that changes a setting which a record states
/// for itself cannot be added: what a record states is known.
WhyNot attachable(const std::string& diagram, const std::vector<std::string>& experiments,
                  const LoadOptions& load, const MachineUnits& units, const RecordSizes& sizes);

class Improver {
 public:
  /// The roles are those of the first experiment.
  Improver(const std::string& diagram, const std::vector<std::string>& experiments, const LoadOptions& load,
           const Catalogue& catalogue, const MachineUnits& units, const RecordSizes& sizes);

  const std::shared_ptr<const SourceFile>& file() const { return file_; }
  const std::vector<std::shared_ptr<const Experiment>>& experiments() const { return experiments_; }
  /// In the direction of the signal.
  Additions additions(std::vector<Member> members) const;
  /// With every member's blocks. Throws InputError.
  Improvement with(const std::vector<Member>& members) const;

 private:
  std::shared_ptr<const SourceFile> file_;
  std::vector<std::shared_ptr<const Experiment>> experiments_;
  const LoadOptions& load_;
  const Catalogue& catalogue_;
  const MachineUnits& units_;
  const RecordSizes& sizes_;
};

/// Writes the diagram to `target`, completely or not at all, and beside it every experiment that names a
/// moved port, with the new names: "improved.json" and "improved.open_loop.experiment.json". Returns the
/// paths of the experiments. Throws InputError.
std::vector<std::string> write(const Improvement& improved, const std::vector<std::string>& experiments,
                               const std::string& target);

}  // namespace loopwright::diagnosis
