#include "models/linear/structure.h"
#include <algorithm>
#include <cmath>
#include "models/linear/decompositions.h"

namespace loopwright {
namespace {

using Eigen::Index;

/// States that can be reached along A (from column to row) from the states in `marked`.
std::vector<bool> reached(const Eigen::MatrixXd& A, std::vector<bool> marked) {
  for (bool grows = true; grows;) {
    grows = false;
    for (Index j = 0; j < A.cols(); ++j)
      for (Index i = 0; i < A.rows(); ++i)
        if (marked[size_t(j)] && !marked[size_t(i)] && A(i, j) != 0) marked[size_t(i)] = grows = true;
  }
  return marked;
}

std::vector<bool> rows_with_entries(const Eigen::MatrixXd& B) {
  std::vector<bool> marked;
  for (Index i = 0; i < B.rows(); ++i) marked.push_back(!B.row(i).isZero(0));
  return marked;
}

/// Whether some input reaches and some output shows each state.
std::vector<bool> is_connected(const StateSpace& system) {
  std::vector<bool> driven = reached(system.A, rows_with_entries(system.B));
  const std::vector<bool> seen = reached(system.A.transpose(), rows_with_entries(system.C.transpose()));
  for (size_t i = 0; i < driven.size(); ++i) driven[i] = driven[i] && seen[i];
  return driven;
}

std::vector<Index> places_of(bool wanted, const std::vector<bool>& marked) {
  std::vector<Index> places;
  for (size_t i = 0; i < marked.size(); ++i)
    if (marked[i] == wanted) places.push_back(Index(i));
  return places;
}

StateSpace with_states(const StateSpace& system, const std::vector<Index>& kept) {
  StateSpace result = system;
  result.A = system.A(kept, kept);
  result.B = system.B(kept, Eigen::all);
  result.C = system.C(Eigen::all, kept);
  return result;
}

/// Whether [A - s, B] or [A - s; C] loses its rank at a mode (the test of Popov, Belevitch and Hautus): the
/// inputs do not excite it, or the outputs do not show it.
bool is_hidden(const StateSpace& system, std::complex<double> mode) {
  constexpr double rounding = 1e-10;
  const StateSpace s = balanced(system);
  const auto loses_rank = [&](const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
    Eigen::MatrixXcd both(A.rows(), A.cols() + B.cols());
    both << A.cast<std::complex<double>>(), B.cast<std::complex<double>>();
    both.diagonal().array() -= mode;
    const Eigen::VectorXd sizes = left_singular(both).values;
    return sizes[A.rows() - 1] <= rounding * sizes[0];
  };
  return loses_rank(s.A, s.B) || loses_rank(s.A.transpose(), s.C.transpose());
}

/// A mode of some of `states` states, as one of all of them.
Pole among_all(Pole pole, const std::vector<Index>& places, Index states) {
  std::vector<double> all(size_t(states), 0.0);
  for (size_t i = 0; i < places.size(); ++i) all[size_t(places[i])] = pole.participation[i];
  pole.participation = std::move(all);
  return pole;
}

}  // namespace

StateSpace connected_part(const StateSpace& system) {
  return with_states(system, places_of(true, is_connected(system)));
}

Modes modes_between(const StateSpace& given) {
  const StateSpace system = with_approximate_delays(given, 6);
  const std::vector<bool> connected = is_connected(system);
  const std::vector<Index> inside = places_of(true, connected), others = places_of(false, connected);
  const StateSpace part = with_states(system, inside);
  const std::vector<Pole> inner = poles(part), outer = poles(with_states(system, others));
  const double T = system.sample_time, fastest = std::max(fastest_of(inner), fastest_of(outer));
  Modes modes;
  if (T == 0) modes.outermost = -std::numeric_limits<double>::infinity();
  for (const Pole& pole : inner) {
    const Stability stability = stability_of(pole, T, fastest);
    if (stability == Stability::boundary && is_hidden(part, pole.value)) {
      modes.outside.push_back({among_all(pole, inside, system.states()), stability});
      continue;
    }
    modes.stability = std::max(modes.stability, stability);
    modes.outermost = std::max(modes.outermost, T > 0 ? std::abs(pole.value) : pole.value.real());
  }
  for (const Pole& pole : outer)
    if (const Stability stability = stability_of(pole, T, fastest); stability != Stability::stable)
      modes.outside.push_back({among_all(pole, others, system.states()), stability});
  return modes;
}

}  // namespace loopwright
