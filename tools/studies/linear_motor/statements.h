/// What the paper says about its Figs. 10-17, held against the simulated signals one by one.
#pragma once
#include <string>
#include <vector>
#include "engine/record/recording.h"
#include "tools/studies/linear_motor/training.h"

namespace loopwright::paper {

/// The paper's motion under its three controllers, and with a payload under the two that learn.
struct FigureRuns {
  Recording conventional, ds, ps, ds_loaded, ps_loaded;
};

struct Statement {
  std::string key;       ///< "ds_constant_outside", for tests and files
  std::string figure;    ///< "Fig. 11"
  std::string claim;     ///< the paper's, in short
  std::string measured;  ///< the figures that decide
  bool holds = false;
};

/// `trained`: where the models that ran have seen data.
std::vector<Statement> check_statements(const FigureRuns& runs, const std::vector<Stretch>& trained);

}  // namespace loopwright::paper
