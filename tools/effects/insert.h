/// Inserts an effect's blocks and wires into the user's own diagram file.
#pragma once
#include "engine/diagram/diagram.h"
#include "tools/effects/effect.h"

namespace loopwright {

/// Role → port of the diagram, as in an experiment: "force" → "axis.net_force".
using RolePorts = std::vector<std::pair<std::string, std::string>>;

struct InsertionSite {
  RolePorts roles;  ///< force is required; position and input if the effect needs them
  std::map<std::string, std::string> variants;  ///< block path → variant that contains the machine
  MachineUnits units;
  bool can_be_taken_out = false;  ///< a parameter of the new diagram, "with_cogging", takes it out when 0
};

/// A port of an experiment whose signal is at other ports of the new diagram.
struct MovedPort {
  std::string from;
  std::vector<std::string> to;
};

struct Insertion {
  std::string text;                 ///< the diagram with the effect
  std::vector<std::string> blocks;  ///< the added blocks, by path: "axis.coulomb_friction"
  /// Every parameter of the effect that can be set in the new diagram: name → path for `--set`, such as
  /// "level" → "axis.coulomb_friction.level". A value computed from several parameters has no path.
  std::vector<std::pair<std::string, std::string>> settings;
  /// With a sensor error in a flat diagram the measured position is no longer "mass.position". Experiments
  /// must name the new port.
  std::vector<MovedPort> measured_at;
  /// Ports that read the input until now, and the ports of the effect that read it instead: "amp.u" →
  /// "force_gain.u". An experiment that drives the former bypasses the effect.
  std::vector<MovedPort> input_at;
  /// The role "input" with which a further effect of the input acts after this one; empty: unchanged.
  std::string input_behind;
  std::vector<std::string> changed;  ///< settings of the user's blocks to which something is added
  std::string taken_out_by;  ///< the parameter that takes it out when 0: "axis.with_cogging"; empty: none
};

/// The diagram of `file` with the effect added at the ports of its roles; `fitted` are the effect's fitted
/// parameters in SI, in their order. A changed subdiagram is written inline where it was named; its own file,
/// which other diagrams may use, stays unchanged. Empty after a problem: no Sum at the role "force", no block
/// with the parameter that the effect changes, a position that cannot be read there.
std::optional<Insertion> insert_effect(std::shared_ptr<const SourceFile> file, const InsertionSite& site,
                                       const Effect& effect, const std::vector<double>& fitted,
                                       const RecordSizes& sizes, Problems& problems);

}  // namespace loopwright
