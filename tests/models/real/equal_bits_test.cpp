#include <gtest/gtest.h>
#include "tests/models/real/arguments.h"

namespace loopwright::test::equal_bits_test {
namespace {

// Builds of this program with -mavx2 and -mavx512f test the same statements for those instruction sets.
struct InstructionSet : testing::Environment {
  void SetUp() override {
#if defined __AVX512F__
    if (!__builtin_cpu_supports("avx512f")) GTEST_SKIP() << "this machine has no AVX-512";
#elif defined __AVX2__
    if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this machine has no AVX2";
#endif
  }
};
[[maybe_unused]] const auto* const instruction_set = testing::AddGlobalTestEnvironment(new InstructionSet);

template <class Real> struct EqualBits : testing::Test {};
#ifdef __SANITIZE_ADDRESS__  // the same statements; compiling 32 instrumented lanes would take minutes
using Widths = testing::Types<Lanes<4>, Lanes<4, 2>>;
#else
using Widths = testing::Types<Lanes<4>, Lanes<8>, Lanes<8, 4>>;
#endif
TYPED_TEST_SUITE(EqualBits, Widths);

TYPED_TEST(EqualBits, LanesGiveWhatDoubleGivesForOneArgument) {
  const auto x = arguments(60000, 1);
  for_each_unary([&](const char* name, const auto& f) {
    const auto one = results<double>(f, x), many = results<TypeParam>(f, x);
    for (std::size_t i = 0; i < x.size(); ++i) {
      ASSERT_TRUE(same_bits(one[i], many[i]))
          << name << " of " << in_hexadecimal(x[i]) << ": " << in_hexadecimal(one[i]) << " in double, "
          << in_hexadecimal(many[i]) << " in lanes";
    }
  });
}

TYPED_TEST(EqualBits, LanesGiveWhatDoubleGivesForTwoArguments) {
  const auto special = special_arguments();
  auto x = arguments(60000, 2), y = arguments(60000, 3);
  for (const double a : special) {
    for (const double b : special) {
      x.push_back(a);
      y.push_back(b);
    }
  }
  while (x.size() % 64 != 0) {
    x.push_back(0.0);
    y.push_back(0.0);
  }
  for_each_binary([&](const char* name, const auto& f) {
    const auto one = results<double>(f, x, y), many = results<TypeParam>(f, x, y);
    for (std::size_t i = 0; i < x.size(); ++i) {
      ASSERT_TRUE(same_bits(one[i], many[i]))
          << name << " of " << in_hexadecimal(x[i]) << " and " << in_hexadecimal(y[i]) << ": "
          << in_hexadecimal(one[i]) << " in double, " << in_hexadecimal(many[i]) << " in lanes";
    }
  });
}

TYPED_TEST(EqualBits, PowersOfTwoAndExponentsAreExact) {
  std::vector<double> n;
  for (int i = -1022; i <= 1023; ++i) n.push_back(i);
  while (n.size() % 64 != 0) n.push_back(0);
  const auto y = results<TypeParam>([](const auto& x) { return power_of_two(x); }, n);
  const auto back = results<TypeParam>([](const auto& x) { return exponent(power_of_two(x) * 1.25); }, n);
  const auto above = results<TypeParam>([](const auto& x) { return exponent(power_of_two(x) * 1.5); }, n);
  for (std::size_t i = 0; i < n.size(); ++i) {
    EXPECT_EQ(y[i], std::ldexp(1.0, int(n[i])));
    EXPECT_EQ(back[i], n[i]);
    EXPECT_EQ(above[i], n[i] + 1);  // 1.5 > √2
  }
}

TYPED_TEST(EqualBits, AFarArgumentInOneLaneLeavesTheOthersAlone) {
  const int count = lanes_of<TypeParam>;
  for (int far = 0; far < count; ++far) {
    TypeParam x;
    for (int l = 0; l < count; ++l) set_lane(x, l, l == far ? -3e9 : 0.1 * l - 1.0);
    const auto both = sine_cosine(x);
    for (int l = 0; l < count; ++l) {
      EXPECT_EQ(lane(both.sine, l), sine(lane(x, l)));
      EXPECT_EQ(lane(both.cosine, l), cosine(lane(x, l)));
    }
  }
}

/// A number that depends on every bit of every result (Fowler, Noll, Vo).
std::uint64_t fingerprint(const std::vector<double>& values) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const double y : values) {
    hash = (hash ^ (std::isnan(y) ? 0x7ff8000000000000 : std::bit_cast<std::uint64_t>(y))) * 0x100000001b3;
  }
  return hash;
}

// Recorded values. They change only with the polynomials, never with compiler, flags or instruction set, so
// that a stored run can be repeated to the bit.
TEST(EqualBitsAnywhere, ResultsAreThoseRecorded) {
  auto x = arguments(60000, 4);
  for (double& value : x) {
    if (std::fabs(value) > 1e6) value = std::fmod(value, 1e6);
  }
  const auto of = [&](const auto& f) { return fingerprint(results<Lanes<8>>(f, x)); };
  EXPECT_EQ(of([](const auto& v) { return sine(v); }), 0xed6a971da1b254a2u);
  EXPECT_EQ(of([](const auto& v) { return cosine(v); }), 0xc1b37ef19f07723du);
  EXPECT_EQ(of([](const auto& v) { return hyperbolic_tangent(v); }), 0xf4b6cae96b301e98u);
  EXPECT_EQ(of([](const auto& v) { return exponential(v); }), 0x97495ff24557cbffu);
  EXPECT_EQ(of([](const auto& v) { return natural_logarithm(v); }), 0xbffbd0ed902a9c06u);
  EXPECT_EQ(of([](const auto& v) { return power(v, 1.7 - v); }), 0x1f91e2c5535454b0u);
  EXPECT_EQ(of([](const auto& v) { return arc_tangent2(v, 1.0 - v); }), 0xd16e8fe068b8e699u);
}

}  // namespace
}  // namespace loopwright::test::equal_bits_test
