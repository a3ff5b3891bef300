/// A fingerprint of parameters, plans and files that is the same on every machine and in every version.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace loopwright {

/// FNV-1a, 64 bits: h ← (h ⊕ byte) · 0x100000001b3, from h = 0xcbf29ce484222325, over all bytes in order.
/// It tells contents apart; it does not protect against someone who wants two contents to look alike.
/// Source: Fowler, Noll, Vo, draft-eastlake-fnv.
class ContentHash {
 public:
  /// Bytes added in parts hash as if they had been one: put a separator where parts could run into each
  /// other.
  ContentHash& add(std::string_view bytes);
  uint64_t value() const { return value_; }
  std::string text() const;  ///< 16 hexadecimal digits, lower case

 private:
  uint64_t value_ = 0xcbf29ce484222325u;
};

/// The hash of all these bytes as 16 hexadecimal digits.
std::string content_hash(std::string_view bytes);

}  // namespace loopwright
