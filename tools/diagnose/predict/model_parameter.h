/// The tunable numbers of a diagram, as the user names them.
#pragma once
#include <memory>
#include <optional>
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
  std::string unit;               ///< SI
  double nominal = 0;             ///< SI; never zero: what is absent from a diagram is a missing term
  double own = 0;                 ///< SI; what this diagram states, where `nominal` is that of another record
  std::optional<Unit> stated_in;  ///< unit of the file; empty: none
  bool is_of_diagram = false;     ///< otherwise a setting of a block
  /// A number of a block that is proportional to a power of the parameter.
  struct Number {
    std::string path;
    double* at;
    double nominal, power;
  };
  std::vector<Number> numbers;

  /// The factor refers to this value: of a setting that differs between records, what it lacks is the same in
  /// all of them.
  void refer_to(double other) { nominal = other; }
  double value_at(double factor) const { return factor == 1 ? own : own + (factor - 1) * nominal; }
};

/// Numbers of blocks that are no products of powers, as "=rotor + mass*length^2" and "=1 - split" are: for
/// other values of the parameters the diagram is read again.
class StatedNumbers {
 public:
  StatedNumbers() = default;
  StatedNumbers(std::string diagram, LoadOptions options)
      : diagram_(std::move(diagram)), options_(std::move(options)) {}

  void add(std::string path, double* at);
  /// The same numbers of another run of the diagram.
  void act_on(Run<double>& run);
  /// As many not-a-numbers if it is no diagram with these values.
  void set(std::span<const ModelParameter> parameters, std::span<const double> factors);

 private:
  struct Number {
    std::string path;
    double* at;
    double nominal;
  };
  struct Known {
    std::vector<double> factors, values;
  };
  std::vector<double> read(std::span<const ModelParameter> parameters, std::span<const double> factors) const;

  std::string diagram_;
  LoadOptions options_;
  std::vector<Number> numbers_;
  std::vector<Known> known_;  // the last one at the end: a fit returns to the same values
};

struct ModelParameters {
  std::vector<ModelParameter> list;
  StatedNumbers stated;

  /// Gives all numbers the values that follow from these factors. Several parameters may determine one
  /// number, as "=bulk_modulus/volume" does.
  void set(std::span<const double> factors);
  /// From here on the numbers of another run of the diagram.
  void act_on(Run<double>& run);
};

/// Of all blocks with an output; parameters of the outermost diagram are followed into the expressions that
/// read them, by loading the diagram with other values.
ModelParameters find_parameters(const std::string& diagram, const LoadOptions& options, const Diagram& loaded,
                                const Plan& plan, Run<double>& run);

}  // namespace loopwright::diagnosis
