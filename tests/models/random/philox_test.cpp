#include "models/random/philox.h"
#include <gtest/gtest.h>

namespace loopwright::philox_test {

// The known answers supplied with the authors' Random123 library.
TEST(Philox, GivesTheKnownAnswers) {
  using Words = std::array<uint32_t, 4>;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Philox, UniformNumbersLieInsideTheOpenInterval) {
  double least = 1, greatest = 0;
  for (uint64_t i = 0; i < 100000; ++i) {
    const UniformPair pair = uniform_pair(1, 2, i);
    for (double x : {pair.first, pair.second}) least = std::min(least, x), greatest = std::max(greatest, x);
  }
  EXPECT_GT(least, 0);
  EXPECT_LT(greatest, 1);
  EXPECT_LT(least, 1e-4);
  EXPECT_GT(greatest, 1 - 1e-4);
}

}  // namespace loopwright::philox_test
