#include <gtest/gtest.h>
#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::matrix_gain_test {

TEST(MatrixGain, MultipliesRowsByTheVector) {
  BlockUnderTest gain("MatrixGain", R"({"matrix": [[1, 2, 3], [0, -1, 0.5]]})");
  ASSERT_EQ(gain.inputs("u").size(), 3u);
  gain.inputs("u") = {2, 4, 6};
  gain.evaluate();
  EXPECT_THAT(gain.outputs("y"), testing::ElementsAre(28, -1));
}

TEST(MatrixGain, EveryNumberIsTunable) {
  BlockUnderTest gain("MatrixGain", R"({"matrix": [[1, 0], [0, 1]]})");
  gain.tune("matrix.1.0", 5);
  gain.inputs("u") = {2, 4};
  gain.evaluate();
  EXPECT_THAT(gain.outputs("y"), testing::ElementsAre(2, 14));
}

TEST(MatrixGain, RefusesEmptyAndRaggedMatrices) {
  EXPECT_NE(BlockUnderTest("MatrixGain", R"({"matrix": []})").problems().text().find("the matrix is empty"),
            std::string::npos);
  EXPECT_NE(BlockUnderTest("MatrixGain", R"({"matrix": [[]]})").problems().text().find("the matrix is empty"),
            std::string::npos);
  BlockUnderTest ragged("MatrixGain", R"({"matrix": [[1, 2], [3]]})");
  EXPECT_NE(ragged.problems().text().find("1 in row 2"), std::string::npos) << ragged.problems().text();
}

}  // namespace loopwright::matrix_gain_test
