/// Shared by writing and reading of journals; see journal.h.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "engine/file/hash.h"

namespace loopwright::journal {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

inline constexpr std::string_view magic = "LWJRNL1\n";
enum Kind : uint32_t { heading = 1, rows = 2, end = 3 };
/// [bytes] upper limit of a payload; a larger value means damage.
inline constexpr uint64_t largest_payload = 64u << 20;

struct ChunkHead {
  uint32_t marker = 0x4b4e4843;  // "CHNK"
  uint32_t kind = 0;
  uint64_t size = 0, rows_before = 0, dropped = 0;
  uint32_t checksum = 0, unused = 0;
};
static_assert(sizeof(ChunkHead) == 40);

inline uint32_t checksum_of(const ChunkHead& head, std::string_view payload) {
  constexpr size_t covered = offsetof(ChunkHead, checksum);
  return crc32c(payload, crc32c({reinterpret_cast<const char*>(&head), covered}));
}

}  // namespace loopwright::journal
