/// Passes an input through the program as far as possible, and checks the result: a list of problems that a
/// user can correct, or a run that finished or reports its failure.
#pragma once
#include <string>
#include "engine/run/simulation.h"

namespace loopwright::fuzz {

enum class Outcome { refused, finished, failed, cut_short };

/// Loads, compiles and runs a diagram for at most some hundred steps. `what` describes the mutant in messages
/// of the test.
Outcome run_diagram(const std::string& path, const std::string& what);

/// Every problem has a text and points into a text file.
void expect_helpful(const Problems& problems, const std::string& what);

/// Compares a diagram with an experiment.
Outcome compare_experiment(const std::string& diagram, const std::string& experiment,
                           const std::string& what);

}  // namespace loopwright::fuzz
