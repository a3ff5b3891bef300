/// Identities of paths that are derived from others.
#pragma once
#include <cstdint>

namespace loopwright::diagnosis {

/// Of a path that is determined by another one and by a number; 0 if that one may change. There are as many
/// of them as sets of values, so they are not counted: a digest tells them apart, all but once in 10^18
/// times. The highest bit tells them from counted ones.
inline uint64_t derived_identity(uint64_t identity, uint64_t number) {
  if (identity == 0) return 0;
  constexpr uint64_t spread = 0x9e3779b97f4a7c15u, not_counted = uint64_t(1) << 63;
  uint64_t mixed = (identity ^ number) * spread;
  mixed = (mixed ^ mixed >> 32) * spread;
  return (mixed ^ mixed >> 29) | not_counted;
}

}  // namespace loopwright::diagnosis
