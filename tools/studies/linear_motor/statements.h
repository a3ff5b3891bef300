/// The paper's statements on its Figs. 10-17, compared with the simulated signals one by one.
#pragma once
#include <string>
#include <vector>
#include "engine/record/recording.h"
#include "tools/studies/linear_motor/training.h"

namespace loopwright::paper {

/// The paper's motion under its three controllers, and with a payload under the two learning controllers.
struct FigureRuns {
  Recording conventional, ds, ps, ds_loaded, ps_loaded;
};

struct Statement {
  std::string key;       ///< "ds_constant_outside", for tests and files
  std::string figure;    ///< "Fig. 11"
  std::string claim;     ///< the paper's statement, abridged
  std::string measured;  ///< the figures that decide
  bool holds = false;
};

/// `trained`: position ranges of the training data of the models.
std::vector<Statement> check_statements(const FigureRuns& runs, const std::vector<Stretch>& trained);

}  // namespace loopwright::paper
