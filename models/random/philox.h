/// Counter-based random numbers: each number is a function of its index, so that runs, lanes and restarts
/// need no state.
#pragma once
#include <array>
#include <cstdint>

namespace loopwright {

/// Philox4x32 with 10 rounds (J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC 2011): a
/// keyed bijection of 128-bit counters. It passes all tests of BigCrush. Streams of different keys are
/// independent in practice. Words are in the order of the publication, least significant first.
constexpr std::array<uint32_t, 4> philox(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const uint64_t a = uint64_t{0xD2511F53} * counter[0], b = uint64_t{0xCD9E8D57} * counter[2];
    counter = {uint32_t(b >> 32) ^ counter[1] ^ key[0], uint32_t(b), uint32_t(a >> 32) ^ counter[3] ^ key[1],
               uint32_t(a)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return counter;
}

/// Two independent numbers, uniform in (0, 1): odd multiples of 2⁻⁵³, neither 0 nor 1.
struct UniformPair {
  double first, second;
};

/// The `index`-th pair of stream `stream` under `key`.
constexpr UniformPair uniform_pair(uint64_t key, uint64_t stream, uint64_t index) {
  const auto word = philox({uint32_t(index), uint32_t(index >> 32), uint32_t(stream), uint32_t(stream >> 32)},
                           {uint32_t(key), uint32_t(key >> 32)});
  const auto uniform = [](uint32_t high, uint32_t low) {
    const uint64_t bits = uint64_t{high} << 32 | low;
    return double((bits >> 12) << 1 | 1) * 0x1p-53;
  };
  return {uniform(word[0], word[1]), uniform(word[2], word[3])};
}

}  // namespace loopwright
