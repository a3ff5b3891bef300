/// The conditions on the matrices of a state space, shared by its three blocks.
#pragma once
#include "engine/block.h"
#include "models/signal/matrix_rows.h"

namespace loopwright::blocks {

inline void check_matrix(const Checker& checker, const char* name, const MatrixRows<double>& m, size_t rows,
                         size_t columns, const char* expected) {
  if (has_shape(m, rows, columns)) return;
  auto& p = checker.error(name, "the matrix does not fit the others");
  p.expected = std::to_string(rows) + " rows of " + std::to_string(columns) + " numbers: " + expected;
  p.found = std::to_string(m.size()) + " rows";
  for (size_t i = 0; i < m.size(); ++i)
    if (m[i].size() != columns) {
      p.found += ", row " + std::to_string(i) + " of " + std::to_string(m[i].size());
      break;
    }
}

/// dx/dt = A x + B u, y = C x (+ D u), all given in the file.
inline void check_state_space(const Checker& checker, const MatrixRows<double>& A,
                              const MatrixRows<double>& B, const MatrixRows<double>& C,
                              const MatrixRows<double>* D, const std::vector<double>& initial) {
  const size_t states = A.size(), inputs = size_t(columns_of(B)), outputs = C.size();
  if (states == 0) checker.error("A", "a state space needs a state").hint = "without states use a Gain";
  if (inputs == 0)
    checker.error("B", "a state space needs an input").expected =
        "a row of numbers for each state, one an input";
  if (outputs == 0)
    checker.error("C", "a state space needs an output").expected = "a row of numbers for each output";
  if (states == 0 || inputs == 0 || outputs == 0) return;
  check_matrix(checker, "A", A, states, states, "as many as states");
  check_matrix(checker, "B", B, states, inputs, "states by inputs");
  check_matrix(checker, "C", C, outputs, states, "outputs by states");
  if (D) check_matrix(checker, "D", *D, outputs, inputs, "outputs by inputs");
  if (initial.empty() || initial.size() == states) return;
  auto& p = checker.error("initial", "the initial states do not fit the matrix A");
  p.expected = "one number for each state, " + std::to_string(states);
  p.found = std::to_string(initial.size());
}

}  // namespace loopwright::blocks
