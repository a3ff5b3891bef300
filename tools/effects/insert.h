/// "Add it": an effect's blocks and wires in the user's own diagram file.
#pragma once
#include "engine/diagram/diagram.h"
#include "tools/effects/effect.h"

namespace loopwright {

/// Role → port of the diagram, as an experiment says it: "force" → "axis.net_force".
using RolePorts = std::vector<std::pair<std::string, std::string>>;

struct InsertionSite {
  RolePorts roles;  ///< force must be there; position and input where the effect needs them
  std::map<std::string, std::string> variants;  ///< block path → variant in which the machine is
  MachineUnits units;
};

struct Insertion {
  std::string text;                 ///< the diagram with the effect
  std::vector<std::string> blocks;  ///< the blocks that were added, by path: "axis.coulomb_friction"
  /// Every parameter of the effect that can be set in the new diagram: name → path for `--set`, such as
  /// "level" → "axis.coulomb_friction.level". What is worked out from several stands nowhere by itself.
  std::vector<std::pair<std::string, std::string>> settings;
  /// Ports whose meaning went over to another: with an error of the sensor in a flat diagram the measured
  /// position is no longer "mass.position". Experiments must name the new one.
  std::vector<std::pair<std::string, std::string>> moved_ports;
  /// The role "input" with which a further effect of the input acts behind this one; empty: as it was.
  std::string input_behind;
};

/// The diagram of `file` with the effect added where its roles say; `fitted` are the effect's fitted
/// parameters in SI, in their order. A subdiagram that is changed is written out in the place where it was
/// named: its own file, which others may use, stays. Nothing after a problem: no Sum at the role "force", no
/// block with the parameter that the effect changes, a position that cannot be read there.
std::optional<Insertion> insert_effect(std::shared_ptr<const SourceFile> file, const InsertionSite& site,
                                       const Effect& effect, const std::vector<double>& fitted,
                                       const RecordSizes& sizes, Problems& problems);

}  // namespace loopwright
