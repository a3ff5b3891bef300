/// Adds the effects that were found to the user's diagram.
#pragma once
#include "tools/diagnose/improvement.h"
#include "tools/diagnose/search/catalogue.h"
#include "tools/diagnose/search/maximum_likelihood.h"

namespace loopwright::diagnosis {

/// Tries each effect on the user's diagram, in memory.
WhyNot attachable(const std::string& diagram, const std::string& experiment, const LoadOptions& load,
                  const MachineUnits& units, const RecordSizes& sizes);

/// The named members, in the direction of the signal.
Additions additions(const Catalogue& catalogue, const Estimate& estimate, const MachineUnits& units,
                    const RecordSizes& sizes);

/// Writes the improved diagram to `target`, completely or not at all. Returns the ports that the experiments
/// must name differently with it. Throws InputError.
std::vector<MovedPort> write_improved(const std::string& diagram, const std::vector<std::string>& experiments,
                                      const LoadOptions& load, const Additions& additions,
                                      const std::string& target);

}  // namespace loopwright::diagnosis
