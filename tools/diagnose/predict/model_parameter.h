/// The tunable numbers of a diagram, as the user names them.
#pragma once
#include <memory>
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"
#include "engine/plan/plan.h"

namespace loopwright {
template <class Real> class Run;
}

namespace loopwright::diagnosis {

/// A parameter of the diagram, or a setting of a block that no parameter of the diagram determines.
struct ModelParameter {
  std::string name;
  std::string unit;    ///< SI
  double nominal = 0;  ///< SI; never zero: what is absent from a diagram is a missing term
  /// A number of a block: its value is proportional to a power of the parameter.
  struct Number {
    double* at;
    double nominal, power;
  };
  std::vector<Number> numbers;

  void set(double factor) const;
};

/// Of all blocks with an output; parameters of the outermost diagram are followed into the expressions that
/// read them, by loading the diagram with a slightly different value.
std::vector<ModelParameter> find_parameters(const std::string& diagram, const LoadOptions& options,
                                            const Diagram& loaded, const Plan& plan, Run<double>& run);

}  // namespace loopwright::diagnosis
