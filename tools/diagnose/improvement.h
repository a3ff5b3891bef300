/// The user's diagram with effects that a diagnosis found, in memory.
#pragma once
#include "tools/diagnose/diagnosis.h"
#include "tools/experiment/experiment.h"

namespace loopwright {

struct Improvement {
  std::shared_ptr<const SourceFile> file;  ///< its paths are those of the user's diagram
  std::vector<std::string> blocks;         ///< the added ones, by path
  std::vector<MovedPort> moved;            ///< ports that the experiments must name differently with it
  std::vector<std::string> taken_out_by;   ///< of each effect the parameter that takes it out when 0
  std::vector<std::string> left_out;       ///< what cannot be written, without roles: sentences
};

/// The ports of the quantities themselves, where the experiment names sensors. Throws InputError.
RolePorts roles_of(const std::shared_ptr<const SourceFile>& diagram, const Experiment& experiment,
                   const LoadOptions& load);

/// The diagram with the effects; the roles are those of the first experiment. Throws InputError.
Improvement improve(const std::shared_ptr<const SourceFile>& diagram,
                    const std::vector<std::shared_ptr<const Experiment>>& experiments,
                    const LoadOptions& load, const Additions& additions);

/// How functions without a name are written, and what distinguishes the file from the whole answer.
std::vector<std::string> notes_of(const Additions& written, const Additions& all);

/// The experiment with the ports that an improved diagram moved.
Experiment with_moved_ports(const Experiment& experiment, const std::vector<MovedPort>& moved);

/// The port of the improved diagram.
const std::string& moved_port(const std::string& port, const std::vector<MovedPort>& moved);

}  // namespace loopwright
