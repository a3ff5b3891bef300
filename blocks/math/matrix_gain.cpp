/// y = K u
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct MatrixGain {
  std::vector<std::vector<Real>> matrix;
  struct In {
    Vector<const Real> u;
  };
  struct Out {
    Vector<Real> y;
  };
  static constexpr auto describe() {
    return block(
        "Multiplies a vector by a matrix.",
        parameter(&MatrixGain::matrix, "matrix", "$y/$u", "Rows of the matrix, as in [[1, 0], [0, 1]]")
            .factor(),
        input(&In::u, "u", "$u", "Vector, as long as the matrix has columns").length(&MatrixGain::columns),
        output(&Out::y, "y", "$y", "Vector, as long as the matrix has rows").length(&MatrixGain::rows));
  }
  int rows() const { return int(matrix.size()); }
  int columns() const { return matrix.empty() ? 0 : int(matrix[0].size()); }
  void check(const Checker& checker) const {
    if (columns() == 0)
      checker.error("matrix", "the matrix is empty").expected = "rows of numbers, as in [[1, 0], [0, 1]]";
    for (size_t i = 1; i < matrix.size(); ++i) {
      if (matrix[i].size() == matrix[0].size()) continue;
      auto& p = checker.error("matrix", "the rows of the matrix differ in length");
      p.expected = std::to_string(matrix[0].size()) + " numbers, as in the first row";
      p.found = std::to_string(matrix[i].size()) + " in row " + std::to_string(i + 1);
    }
  }
  void outputs(const In& in, Out& out) const {
    for (size_t i = 0; i < matrix.size(); ++i) {
      Real sum = 0.0;
      for (size_t j = 0; j < in.u.size(); ++j) sum = sum + matrix[i][j] * in.u[j];
      out.y[i] = sum;
    }
  }
};
LOOPWRIGHT_BLOCK(MatrixGain)

}  // namespace loopwright::blocks
