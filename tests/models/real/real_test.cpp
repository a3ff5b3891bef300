#include <gtest/gtest.h>
#include "tests/models/real/arguments.h"

namespace loopwright::test::real_test {
namespace {

template <class Condition>
concept CanBranch = requires(Condition condition) {
  condition ? 1 : 2;
};
template <class Condition>
concept HasLogic = requires(Condition a, Condition b) {
  (a && b) || a;
};
template <class Number>
concept CanBeAMask = std::convertible_to<Number, Mask<4, 1>>;

static_assert(CanBranch<MaskOf<double>>);
static_assert(!CanBranch<MaskOf<Lanes<4>>> && !std::convertible_to<Mask<8, 4>, bool>);
static_assert(HasLogic<bool> && !HasLogic<Mask<4, 1>>);
static_assert(CanBeAMask<bool> && !CanBeAMask<int> && !CanBeAMask<double>);
static_assert(std::same_as<MaskOf<double>, bool> && std::same_as<MaskOf<Lanes<8, 4>>, Mask<8, 4>>);
static_assert(lanes_of<double> == 1 && lanes_of<Lanes<4>> == 4 && lanes_of<Lanes<8, 4>> == 32 &&
              lanes_of<int> == 0);
static_assert(Scalar<double> && Scalar<Lanes<2>> && !Scalar<float> && !Scalar<Mask<4, 1>>);
static_assert(std::is_trivially_destructible_v<Lanes<8, 4>> &&
              std::is_trivially_default_constructible_v<Lanes<4>>);
static_assert(sizeof(Lanes<8, 4>) == 32 * sizeof(double));

template <class Real> struct RealTest : testing::Test {};
using Scalars = testing::Types<double, Lanes<2>, Lanes<4>, Lanes<8>, Lanes<8, 4>>;
TYPED_TEST_SUITE(RealTest, Scalars);

template <class Real> Real counting() {
  Real x;
  for (int l = 0; l < lanes_of<Real>; ++l) set_lane(x, l, l - 1.0);
  return x;
}

TYPED_TEST(RealTest, FormulasMixRealsWithNumbers) {
  using Real = TypeParam;
  const Real x = counting<Real>();
  Real y = 2.0 * x + 1;
  y += 1;
  y *= x;
  y -= 0.5;
  y /= 4;
  const Real z = select((x > 0.0) & !(x == 1.0), y, select((1.0 <= x) | (x < -0.5), Real(7.0), +x));
  const Real w = select(x != 0.0, 1.0, -1.0), limited = minimum(maximum(x, 0.0), 2.0);
  for (int l = 0; l < lanes_of<Real>; ++l) {
    const double a = l - 1.0;
    EXPECT_EQ(lane(y, l), ((2 * a + 2) * a - 0.5) / 4);
    EXPECT_EQ(lane(z, l), a > 1 ? lane(y, l) : a == 0 ? 0.0 : 7.0);
    EXPECT_EQ(lane(w, l), a == 0 ? -1.0 : 1.0);
    EXPECT_EQ(lane(limited, l), std::min(std::max(a, 0.0), 2.0));
  }
}

TYPED_TEST(RealTest, OneConditionSelectsForAllLanes) {
  const TypeParam x = counting<TypeParam>();
  const bool later = lane(x, 0) < 0.0;
  EXPECT_EQ(lane(select(later, x, 3.0), 0), -1.0);
  EXPECT_EQ(lane(select(!later, x, 3.0), 0), 3.0);
}

TYPED_TEST(RealTest, AnyFindsTheOneLaneThatHolds) {
  using Real = TypeParam;
  EXPECT_FALSE(any(Real(0.0) > 0.0));
  EXPECT_TRUE(any(Real(0.0) >= 0.0));
  for (int l = 0; l < lanes_of<Real>; ++l) {
    Real x = 0.0;
    set_lane(x, l, 1.0);
    EXPECT_TRUE(any(x > 0.0));
    EXPECT_EQ(any(!(x > 0.0)), lanes_of<Real> > 1);
  }
}

TYPED_TEST(RealTest, MasksCollectFaultsLaneByLane) {
  using Real = TypeParam;
  MaskOf<Real> failed = false;
  EXPECT_FALSE(any(failed));
  for (int l = 0; l < lanes_of<Real>; l += 3) set_lane(failed, l, true);
  failed |= counting<Real>() == 0.0;
  for (int l = 0; l < lanes_of<Real>; ++l) EXPECT_EQ(lane(failed, l), l % 3 == 0 || l == 1);
  failed &= !failed;
  EXPECT_FALSE(any(failed));
}

TYPED_TEST(RealTest, NegativeZeroSurvivesBroadcastAndNegation) {
  using Real = TypeParam;
  EXPECT_TRUE(std::signbit(lane(Real(-0.0), 0)));
  EXPECT_TRUE(std::signbit(lane(-Real(0.0), lanes_of<Real> - 1)));
}

TYPED_TEST(RealTest, LimitsDoNotHideNaN) {
  const TypeParam nan = std::numeric_limits<double>::quiet_NaN(), one = 1.0;
  for (const TypeParam& y : {maximum(nan, one), maximum(one, nan), minimum(nan, one), minimum(one, nan)}) {
    for (int l = 0; l < lanes_of<TypeParam>; ++l) EXPECT_TRUE(std::isnan(lane(y, l)));
  }
}

TYPED_TEST(RealTest, RoundingAgreesWithLibmForEveryArgument) {
  const auto x = arguments(60000, 5);
  const auto round = results<TypeParam>([](const auto& v) { return round_even(v); }, x);
  const auto floor = results<TypeParam>([](const auto& v) { return floor_of(v); }, x);
  const auto root = results<TypeParam>([](const auto& v) { return square_root(v); }, x);
  const auto magnitude = results<TypeParam>([](const auto& v) { return absolute(v); }, x);
  const auto sign = results<TypeParam>([](const auto& v) { return sign_of(v); }, x);
  const auto finite =
      results<TypeParam>([](const auto& v) { return select(is_finite(v), 1.0, decltype(+v)(0.0)); }, x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_TRUE(same_bits(round[i], std::nearbyint(x[i]))) << in_hexadecimal(x[i]);
    EXPECT_TRUE(same_bits(floor[i], std::floor(x[i]))) << in_hexadecimal(x[i]);
    EXPECT_TRUE(same_bits(root[i], std::sqrt(x[i]))) << in_hexadecimal(x[i]);
    EXPECT_TRUE(same_bits(magnitude[i], std::fabs(x[i]))) << in_hexadecimal(x[i]);
    EXPECT_TRUE(same_bits(sign[i], x[i] > 0 ? 1.0 : x[i] < 0 ? -1.0 : x[i])) << in_hexadecimal(x[i]);
    EXPECT_EQ(finite[i], std::isfinite(x[i]) ? 1.0 : 0.0) << in_hexadecimal(x[i]);
  }
}

TYPED_TEST(RealTest, HalvesRoundToEven) {
  using Real = TypeParam;
  EXPECT_EQ(lane(round_even(Real(0.5)), 0), 0.0);
  EXPECT_EQ(lane(round_even(Real(1.5)), 0), 2.0);
  EXPECT_EQ(lane(round_even(Real(-2.5)), 0), -2.0);
  EXPECT_EQ(lane(round_even(Real(0x1p51 + 0.5)), 0), 0x1p51);
}

TYPED_TEST(RealTest, SignsFlipByBitAndByParity) {
  using Real = TypeParam;
  EXPECT_EQ(lane(flip_sign(Real(3.0), -0.0), 0), -3.0);
  EXPECT_EQ(lane(flip_sign(Real(-3.0), -1.0), 0), 3.0);
  for (const double n : {-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 1048577.0, 0x1p50}) {
    EXPECT_EQ(lane(negate_if_odd(Real(5.0), n), 0), std::fmod(n, 2.0) == 0.0 ? 5.0 : -5.0);
  }
}

}  // namespace
}  // namespace loopwright::test::real_test
