#include "engine/file/hash.h"

#include <fmt/format.h>

#include <array>

namespace loopwright {
namespace {

/// The remainder for every byte.
constexpr std::array<uint32_t, 256> crc32c_table = [] {
  std::array<uint32_t, 256> table{};
  for (uint32_t byte = 0; byte < 256; ++byte) {
    uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) remainder = (remainder >> 1) ^ (remainder & 1 ? 0x82f63b78u : 0);
    table[byte] = remainder;
  }
  return table;
}();

}  // namespace

ContentHash& ContentHash::add(std::string_view bytes) {
  for (const char byte : bytes) value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return *this;
}

std::string ContentHash::text() const { return fmt::format("{:016x}", value_); }

std::string content_hash(std::string_view bytes) { return ContentHash().add(bytes).text(); }

uint32_t crc32c(std::string_view bytes, uint32_t before) {
  uint32_t remainder = ~before;
  for (const char byte : bytes)
    remainder = crc32c_table[(remainder ^ static_cast<unsigned char>(byte)) & 0xff] ^ (remainder >> 8);
  return ~remainder;
}

}  // namespace loopwright
