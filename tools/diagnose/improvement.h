/// A diagram with effects that a diagnosis found.
#pragma once
#include "tools/diagnose/diagnosis.h"
#include "tools/experiment/experiment.h"

namespace loopwright {

struct Improvement {
  std::string text;                 ///< of the diagram
  std::vector<std::string> blocks;  ///< the added ones, by path
  std::vector<MovedPort> ports;     ///< that the experiments must name differently with it
  std::string input;                ///< the role "input" for effects that are added later
};

/// The diagram of `file` with the effects in the order of their stages; the roles are those of the first
/// experiment, and the input is `input` unless that is empty. Throws InputError.
Improvement improve(std::shared_ptr<const SourceFile> file,
                    const std::vector<std::shared_ptr<const Experiment>>& experiments,
                    const std::map<std::string, std::string>& variants, const Additions& additions,
                    const std::string& input = "");

}  // namespace loopwright
