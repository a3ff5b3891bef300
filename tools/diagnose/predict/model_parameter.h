/// The tunable numbers of a diagram, as the user names them.
#pragma once
#include <memory>
#include <span>
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
  /// A number of a block: proportional to a power of the parameter, or a sum of which this is its share.
  struct Number {
    double* at;
    double nominal, power;
    bool is_share = false;
  };
  std::vector<Number> numbers;

  /// The factor refers to this value: of a setting that differs between records, what it lacks is the same in
  /// all of them.
  void refer_to(double nominal);
};

/// Gives all numbers the values that follow from these factors. Several parameters may determine one number,
/// as "=bulk_modulus/volume" does.
void set_parameters(std::span<const ModelParameter> parameters, std::span<const double> factors);

/// Of all blocks with an output; parameters of the outermost diagram are followed into the expressions that
/// read them, by loading the diagram with a slightly different value.
std::vector<ModelParameter> find_parameters(const std::string& diagram, const LoadOptions& options,
                                            const Diagram& loaded, const Plan& plan, Run<double>& run);

}  // namespace loopwright::diagnosis
