#include "engine/file/hash.h"

#include <fmt/format.h>

namespace loopwright {

ContentHash& ContentHash::add(std::string_view bytes) {
  for (const char byte : bytes) value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return *this;
}

std::string ContentHash::text() const { return fmt::format("{:016x}", value_); }

std::string content_hash(std::string_view bytes) { return ContentHash().add(bytes).text(); }

}  // namespace loopwright
