/// Hashes of parameters, plans and files, the same on every machine and in every version.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace loopwright {

/// FNV-1a, 64 bits: h ← (h ⊕ byte) · 0x100000001b3, from h = 0xcbf29ce484222325, over all bytes in order. It
/// distinguishes contents, but does not protect against collisions made on purpose. Source: Fowler, Noll, Vo,
/// draft-eastlake-fnv.
class ContentHash {
 public:
  /// Bytes added in parts give the hash of their concatenation: add a separator where different parts could
  /// give the same concatenation.
  ContentHash& add(std::string_view bytes);
  uint64_t value() const { return value_; }
  std::string text() const;  ///< 16 hexadecimal digits, lower case

 private:
  uint64_t value_ = 0xcbf29ce484222325u;
};

/// The hash of all these bytes as 16 hexadecimal digits.
std::string content_hash(std::string_view bytes);

/// CRC-32C, which detects every error burst of up to 32 bits: the remainder by the Castagnoli polynomial,
/// reflected 0x82f63b78, as in RFC 3720 ("123456789" → 0xe3069283). `before`: the result for the preceding
/// bytes.
uint32_t crc32c(std::string_view bytes, uint32_t before = 0);

}  // namespace loopwright
