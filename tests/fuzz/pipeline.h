/// The way of an input through the program, as far as it gets, and whether what came of it is what was
/// promised: a list of problems that a person can mend, or a run that finished or says why not.
#pragma once
#include <string>
#include "engine/run/simulation.h"

namespace loopwright::fuzz {

enum class Outcome { refused, finished, failed, cut_short };

/// Loads, compiles and runs a diagram for at most some hundred steps. `what` tells of the mutant in messages
/// of the test.
Outcome run_diagram(const std::string& path, const std::string& what);

/// Every problem speaks, and points into a file of text.
void expect_helpful(const Problems& problems, const std::string& what);

/// Holds a diagram against an experiment.
Outcome compare_experiment(const std::string& diagram, const std::string& experiment,
                           const std::string& what);

}  // namespace loopwright::fuzz
