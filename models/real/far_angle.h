/// Argument reduction by integers for angles too large for the three parts of π in functions.h (M. Payne, R.
/// Hanek, Radian reduction for trigonometric functions, ACM SIGNUM Newsletter 18, 1983).
#pragma once
#include "models/real/real.h"

namespace loopwright::detail {

/// Bits of 2/π after the binary point, preceded by 64 zeros.
inline constexpr std::uint64_t two_over_pi[] = {0,
                                                0xa2f9836e4e441529,
                                                0xfc2757d1f534ddc0,
                                                0xdb6295993c439041,
                                                0xfe5163abdebbc561,
                                                0xb7246e3a424dd2e0,
                                                0x06492eea09d1921c,
                                                0xfe1deb1cb129a73e,
                                                0xe88235f52ebb4484,
                                                0xe99c7026b45f7e41,
                                                0x3991d639835339f4,
                                                0x9c845f8bbdf9283b,
                                                0x1ff897ffde05980f,
                                                0xef2f118b5a0a6d1f,
                                                0x6d367ecf27cb09b7,
                                                0x4f463f669e5fea2d,
                                                0x7527bac7ebe5f17b,
                                                0x3d0739f78a5292ea,
                                                0x6bfb5fb11f8d5d08,
                                                0x56033046fc7b6bab,
                                                0xf0cfbc209af4361d};

/// The 64 bits of 2/π from this bit of the list on.
LW_INLINE std::uint64_t bits_of_two_over_pi(int from) {
  const int word = from / 64, shift = from % 64;
  return shift == 0 ? two_over_pi[word] : two_over_pi[word] << shift | two_over_pi[word + 1] >> (64 - shift);
}

/// x = (quarters + 4 k) π/2 + rest with |rest| ≤ π/4.
struct FarAngle {
  int quarters;
  double rest;
};
/// For 1 ≤ x < infinity; the error of the rest is at most 1.5 ulp.
LW_INLINE FarAngle far_angle(double x) {
  using Wide = unsigned __int128;
  const auto bits = __builtin_bit_cast(std::uint64_t, x);
  const std::uint64_t one = std::uint64_t(1) << 52, mantissa = (bits & (one - 1)) | one;
  const int exponent = int(bits >> 52) - 1075;  // x = mantissa · 2^exponent
  // Bits of 2/π above 2^(1 - exponent) add whole turns to x·2/π and are omitted. The remaining bits are a
  // fraction whose product with the mantissa is the number of turns, modulo 1. 192 bits of it suffice.
  const int from = 64 + exponent - 2;
  const Wide low = Wide(mantissa) * bits_of_two_over_pi(from + 128);
  const Wide middle = Wide(mantissa) * bits_of_two_over_pi(from + 64) + std::uint64_t(low >> 64);
  const std::uint64_t high = mantissa * bits_of_two_over_pi(from) + std::uint64_t(middle >> 64);
  const std::uint64_t quarters = (high + (std::uint64_t(1) << 61)) >> 62;  // rounded to nearest
  const Wide rest = Wide(high - (quarters << 62)) << 64 | std::uint64_t(middle);
  const double part = rest >> 127 ? -double(-rest) : double(rest);  // in turns, times 2¹²⁸
  return {int(quarters & 3), part * (0x1.921fb54442d18p0 * 0x1p-126)};
}

}  // namespace loopwright::detail
