/// The step of a linearized diagram on rows instead of numbers.
///
/// What a run does with numbers (docs/architecture.md, The step) is done here with rows: each number of the
/// diagram is a linear form of some coordinates, states and added signals. Following a diagram through one
/// period of its rates from unit rows gives its matrices, for any rates, offsets and delays.
#pragma once
#include <Eigen/Core>
#include "tools/linearize/linear_diagram.h"
#include "tools/linearize/ports.h"

namespace loopwright {

/// Where signals are added and wires are cut.
class Taps {
 public:
  /// Throws InputError with every port that does not exist.
  Taps(const Plan& plan, const Access& access);
  const std::vector<PortNumber>& from() const { return from_; }
  const std::vector<PortNumber>& to() const { return to_; }
  /// The row that input `k` of block `b` reads, number `n` of the plan: its row unless cut, plus added
  /// signals.
  struct Reading {
    bool is_cut = false;
    std::vector<int> added;  ///< indices into from()
  };
  const Reading& at(int b, int k) const { return readings_[size_t(b)][size_t(k)]; }

 private:
  void visit(const PortNumber& port, const auto& change);
  const Plan& plan_;
  std::vector<PortNumber> from_, to_;
  std::vector<std::vector<Reading>> readings_;
};

/// Rows over `width` coordinates.
class LinearStep {
 public:
  LinearStep(const LinearDiagram& diagram, const Taps& taps, Eigen::Index width);

  Eigen::MatrixXd numbers;              ///< one row for each number of the plan
  Eigen::MatrixXd added;                ///< one row for each added signal
  Eigen::MatrixXd delayed;              ///< one row for each transport delay: its output
  std::vector<Eigen::MatrixXd> memory;  ///< for each block, one row for each of its states

  /// Computes everything for which `is_due(rate)`, in order; constants and continuous parts always.
  template <class Due> void evaluate(Due&& is_due) {
    show_states();
    for (const Plan::Entry& entry : diagram_.plan->order)
      if (entry.rate.kind != Rate::Kind::sampled || is_due(entry.rate)) evaluate_entry(entry);
  }
  /// A x + B u of a block: its rates, or its next memory.
  Eigen::MatrixXd next(int block) const;
  /// The row that input `k` of a block reads.
  Eigen::RowVectorXd read(int block, int k) const;
  /// Blocks that are transport delays, in the order of the rows of `delayed`.
  const std::vector<int>& delays() const { return delays_; }

 private:
  void show_states();
  void evaluate_entry(const Plan::Entry& entry);
  void solve_algebraic_loop(const Plan::AlgebraicLoop& loop);
  Eigen::MatrixXd inputs_of(int block) const;

  const LinearDiagram& diagram_;
  const Taps& taps_;
  std::vector<int> delays_, delay_of_block_;
};

}  // namespace loopwright
