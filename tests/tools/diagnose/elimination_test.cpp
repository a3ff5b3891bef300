// Columns added to a solved set, against the whole set solved at once.
#include "tools/diagnose/search/elimination.h"
#include <gtest/gtest.h>

namespace loopwright::diagnosis::elimination_test {
namespace {

/// Random columns of very different sizes, of which the last two are nearly alike.
struct Problem {
  Eigen::MatrixXd X;
  Eigen::VectorXd e;
  Products G;
  Eigen::VectorXd b;
  double squares;

  Problem() {
    std::srand(1);  // of Eigen's random numbers
    X = Eigen::MatrixXd::Random(200, 9), e = Eigen::VectorXd::Random(200);
    for (Eigen::Index c = 0; c < X.cols(); ++c) X.col(c) *= std::pow(10.0, double(c) - 4);
    X.col(8) = 100 * X.col(7) + 1e-3 * X.col(8);
    e += X.col(1) * 3e3 + X.col(5) * 0.2 - X.col(7) * 1e-3;
    G = X.transpose() * X, b = X.transpose() * e, squares = e.squaredNorm();
  }
  /// By orthogonal decomposition of the columns themselves.
  Eigen::VectorXd theta(const std::vector<int>& columns) const {
    return Eigen::MatrixXd(X(Eigen::all, columns)).colPivHouseholderQr().solve(e);
  }
  double left(const std::vector<int>& columns) const {
    return (e - X(Eigen::all, columns) * theta(columns)).squaredNorm();
  }
};

TEST(Elimination, AddedColumnsChangeThoseBeforeAsIfAllWereSolvedTogether) {
  const Problem p;
  const Solved members = solve(p.G, {0, 1, 4}, p.b, p.squares);
  EXPECT_NEAR(members.squares, p.left({0, 1, 4}), 1e-6 * p.squares);
  const Added added = add(p.G, {5, 7}, members, p.b);
  const Eigen::VectorXd expected = p.theta({0, 1, 4, 5, 7});
  EXPECT_NEAR(added.squares, p.left({0, 1, 4, 5, 7}), 1e-6 * p.squares);
  for (Eigen::Index i = 0; i < 3; ++i)
    EXPECT_NEAR(added.before[i], expected[i], 1e-5 * std::abs(expected[i])) << i;
  for (Eigen::Index i = 0; i < 2; ++i)
    EXPECT_NEAR(added.theta[i], expected[3 + i], 1e-5 * std::abs(expected[3 + i])) << i;
}

TEST(Elimination, ColumnsAddedToNothingAreSolvedAlone) {
  const Problem p;
  const Added added = add(p.G, {1, 5}, solve(p.G, {}, p.b, p.squares), p.b);
  EXPECT_NEAR(added.squares, p.left({1, 5}), 1e-6 * p.squares);
  EXPECT_EQ(added.before.size(), 0);
}

TEST(Elimination, AColumnThatIsAlreadyThereSavesNothing) {
  const Problem p;
  const Solved members = solve(p.G, {0, 7}, p.b, p.squares);
  EXPECT_NEAR(add(p.G, {7}, members, p.b).squares, members.squares, 1e-6 * p.squares);
  EXPECT_TRUE(add(p.G, {8}, members, p.b).theta.allFinite());
}

}  // namespace
}  // namespace loopwright::diagnosis::elimination_test
