/// Evidence of the prediction errors for additional effects: columns of every candidate on a coarse grid of
/// shapes, and their sums of squares, so that a set of effects costs only one small solve.
#pragma once
#include "tools/diagnose/search/elimination.h"
#include "tools/diagnose/search/maximum_likelihood.h"

namespace loopwright::diagnosis {

/// A candidate at one point of its grid, with its columns along each record.
struct Shape {
  const Candidate* candidate = nullptr;
  std::vector<double> nonlinear;
  std::vector<Columns> columns;  ///< one per record
  /// Rows of each record that contain no information about it; empty if all count: see add_without_doubt().
  std::vector<std::vector<char>> doubtful;
};

/// A candidate at several points together.
void add_shapes(const Candidate& candidate, const std::vector<std::vector<double>>& points,
                const Motion& motion, std::vector<Shape>& shapes);
/// Every candidate at every point of its grid, except those whose pitch or instant the errors tell.
std::vector<Shape> shapes_of(const std::vector<Candidate>& candidates, const Motion& motion);

/// A set of effects that explains the errors, according to the linearization.
struct Proposal {
  std::vector<size_t> removed;  ///< members removed
  std::vector<Member> added;
  std::vector<double> step;  ///< of the free parameters of the members that stay, to go with `added`
  double gain = 0;           ///< saving in the extended information criterion
};

size_t parameters_of(const Candidate& candidate);
/// n ln(mean square) + ln|S| + the price of the parameters (extended Bayesian); smaller is better.
double criterion(const Trials& trials, const Estimate& estimate, size_t catalogue);

/// Whether shapes differ by more than the neighbours of a grid.
bool is_far(const std::vector<double>& shape, const std::vector<double>& other);

/// Squares that a solution leaves, beyond rounding.
double left_by(double squares, double of);

/// The members with the proposal applied.
std::vector<Member> applied(const Proposal& proposal, std::vector<Member> members);

/// Sums of squares of the errors, of the members' sensitivities, and of every shape.
class Evidence {
 public:
  /// At most this many rows are used, evenly spaced.
  Evidence(const Trials& trials, const Estimate& estimate, const std::vector<const Shape*>& shapes,
           size_t catalogue, size_t most_rows = 9000);

  /// The best shape of every candidate that is not yet a member, best first; without those that save nothing.
  std::vector<Proposal> extensions() const { return extensions(n_); }
  /// The same with the savings of a record of `n` fitted numbers: the evidence may hold a part of them.
  std::vector<Proposal> extensions(double n) const;
  /// The best two shapes together, from the best shapes of every candidate: both with a name, or one without
  /// if that is requested. Empty: no two of them save anything.
  std::optional<Proposal> best_pair(bool one_without_name = false);
  /// A member, or two, replaced by one shape: the best for each candidate, best first.
  std::vector<Proposal> exchanges() const;
  /// Some members replaced by one shape: every shape whose amplitudes are within their ranges, best first.
  std::vector<Proposal> each_shape(const std::vector<size_t>& removed) const;
  /// A member, or two, replaced by two shapes, both of them needed: the best for each pair of candidates,
  /// best first.
  std::vector<Proposal> exchanges_for_pairs();
  /// Some members replaced by up to `most` shapes of different candidates: the best for each set of
  /// candidates that does not contain all of theirs, or has theirs with other shapes, best first, as long as
  /// it loses less than `most_loss`, both of a record of `n` fitted numbers. Shapes of one candidate follow
  /// each other along its grid: what lies between two points is nearly a sum of both.
  std::vector<Proposal> sets(const std::vector<size_t>& removed, size_t most, double n, double most_loss);
  /// The members without one, with the saving (mostly negative) of a record of `n` fitted numbers.
  std::vector<double> gains_of_removal(double n) const;
  double rows() const { return n_; }

 private:
  /// The errors with some members removed.
  struct Errors {
    std::vector<size_t> removed;
    Eigen::VectorXd b;  ///< products with all columns
    double squares = 0;
    Solved members, amplitudes;  ///< the members that stay; only their linear parameters
  };
  std::vector<int> member_columns(const std::vector<size_t>& without = {}, bool only_linear = false) const;
  /// Every member, and every pair.
  std::vector<std::vector<size_t>> removals() const;
  Errors errors_without(const std::vector<size_t>& removed) const;
  void multiply(size_t shape, size_t other);
  size_t without_doubt(size_t shape) const;
  /// Zero where the shape is doubtful, in a record's rows of X_, which begin at `top`.
  void clear_doubtful(size_t shape, const std::vector<char>& doubtful, const std::vector<size_t>& rows,
                      Eigen::Index top, size_t ports);
  int width_of(size_t shape) const { return int(shapes_[shape]->columns[0].size()); }
  std::vector<int> columns_of(const std::vector<size_t>& shapes) const;
  std::optional<double> gain_of(const std::vector<size_t>& shapes, const Errors& errors, double n) const;
  Proposal with_step(const std::vector<size_t>& shapes, const Errors& errors, double gain) const;
  std::vector<double> step_of(const std::vector<size_t>& removed, const Eigen::VectorXd& amplitudes) const;
  bool may_be_added(const Shape& shape, const std::vector<size_t>& removed) const;
  /// A shape, and what it saves.
  struct Promise {
    size_t shape;
    double gain;
  };
  std::vector<Promise> best_shapes(const Errors& errors, double n) const;

  struct Piece;
  struct Set;
  void multiply_all();
  std::vector<Piece> pieces() const;
  std::optional<Member> member_of(const Piece& piece, const double* theta) const;
  std::optional<Proposal> proposal_of(const std::vector<const Piece*>& set, const Errors& errors,
                                      double n) const;
  std::vector<double> step_within_ranges(const std::vector<size_t>& removed,
                                         const Eigen::VectorXd& amplitudes) const;
  bool is_another(const std::vector<Member>& added, const std::vector<size_t>& removed) const;
  std::vector<Set> extended(const std::vector<Set>& sets, const std::vector<Piece>& all, const Errors& errors,
                            double n) const;

  const std::vector<Member> members_;
  const std::vector<const Shape*> shapes_;
  const size_t catalogue_;
  std::vector<FreeParameter> free_;
  std::vector<int> first_column_;  // of each shape
  Eigen::MatrixXd X_;              // rows used × columns: members', shapes', errors
  Products G_;  // Xᵀ X, as far as needed: for two shapes only if they were tried together
  Eigen::VectorXd b_;
  double squares_ = 0, n_ = 0, explained_ = 0;  // explained_: remaining squares after the members
};

}  // namespace loopwright::diagnosis
