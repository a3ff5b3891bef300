#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::product_test {

TEST(Product, MultipliesAnyNumberOfFactors) {
  BlockUnderTest product("Product");
  product.inputs("factors") = {2, -3, 0.5, 4};
  product.evaluate();
  EXPECT_EQ(product.output("product"), -12);
}

TEST(Product, DividesWhereTheOperationSaysSo) {
  BlockUnderTest product("Product", R"({"operations": "/*/"})");
  product.inputs("factors") = {4, 3, 2};
  product.evaluate();
  EXPECT_EQ(product.output("product"), 0.375);
  EXPECT_EQ(product.fault(), "");
}

TEST(Product, StopsTheRunWhenItDividesByZero) {
  BlockUnderTest product("Product", R"({"operations": "*/"})");
  product.inputs("factors") = {4, 1e-300};
  product.evaluate();
  EXPECT_EQ(product.fault(), "");
  product.inputs("factors") = {4, 0};
  product.evaluate();
  EXPECT_EQ(product.fault(), "division by zero");
}

TEST(Product, RefusesOtherOperations) {
  BlockUnderTest product("Product", R"({"operations": "*+"})");
  EXPECT_NE(product.problems().text().find("operations may only hold * and /"), std::string::npos)
      << product.problems().text();
}

}  // namespace loopwright::product_test
