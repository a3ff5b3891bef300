#include "engine/record/mat_layout.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>

namespace loopwright::mat {
namespace {

uint32_t read_word(std::string_view bytes, size_t offset, bool swapped) {
  uint32_t word;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return swapped ? __builtin_bswap32(word) : word;
}

Layout outline_of_version_5(std::string_view bytes, bool swapped) {
  constexpr size_t file_header = 128, element_header = 8;
  constexpr uint32_t matrix = 14, compressed = 15;
  Layout layout;
  size_t count = 0, at = file_header;
  for (; at < bytes.size(); ++count) {
    const auto damaged = [&](std::string what) {
      layout.damage = std::move(what);
      layout.damage_offset = at;
      return layout;
    };
    if (bytes.size() - at < element_header) return damaged("the file is cut off");
    const uint32_t type = read_word(bytes, at, swapped), size = read_word(bytes, at + 4, swapped);
    if (type != matrix && type != compressed)
      return damaged(fmt::format("no variable can be of type {}", type));
    if (size > bytes.size() - at - element_header)
      return damaged(fmt::format("variable {} is announced with {} bytes, but {} are left", count + 1, size,
                                 bytes.size() - at - element_header));
    at += element_header + size;
  }
  layout.variables = count;
  return layout;
}

/// A variable of version 4: header of five words (type, rows, columns, imaginary, length of name), name,
/// numbers. The digits of the type, MOPT, are byte order, zero, precision and kind.
struct OldVariable {
  uint32_t type, rows, columns, imaginary, name;
  bool plausible() const {
    const uint32_t order = type / 1000, zero = type / 100 % 10, precision = type / 10 % 10, kind = type % 10;
    return order <= 1 && zero == 0 && precision <= 5 && kind <= 2 && imaginary <= 1 && name >= 1 &&
           name <= 256;
  }
  /// [bytes] of name and numbers; a double, as a damaged header can give more than 64 bits can hold
  double size() const {
    constexpr std::array<int, 6> bytes_of_precision = {8, 4, 4, 2, 2, 1};
    return name + double(rows) * columns * bytes_of_precision[type / 10 % 10] * (1 + imaginary);
  }
};

std::optional<Layout> outline_of_version_4(std::string_view bytes, bool swapped) {
  constexpr size_t header = 20;
  Layout layout;
  layout.version = Layout::Version::four;
  size_t count = 0, at = 0;
  for (; at < bytes.size(); ++count) {
    const size_t left = bytes.size() - at;
    OldVariable variable{};
    if (left >= header) {
      const auto word = [&](size_t i) { return read_word(bytes, at + 4 * i, swapped); };
      variable = {word(0), word(1), word(2), word(3), word(4)};
    }
    if (left < header || !variable.plausible() || variable.size() > double(left - header)) {
      if (count == 0)
        return std::nullopt;  // no signature exists: only a valid first variable identifies a MAT file
      layout.damage = "the file is cut off or damaged";
      layout.damage_offset = at;
      return layout;
    }
    at += header + static_cast<size_t>(variable.size());
  }
  layout.variables = count;
  return layout;
}

}  // namespace

std::optional<Layout> outline(std::string_view bytes) {
  constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";
  if (bytes.starts_with(hdf5_signature) || (bytes.size() > 520 && bytes.substr(512, 8) == hdf5_signature))
    return Layout{Layout::Version::seven_three, {}, {}, 0};
  if (bytes.size() >= 128) {
    // Two bytes of version, then "MI" as a 16-bit number in the byte order of the writer.
    const std::string_view version_and_order = bytes.substr(124, 4);
    if (version_and_order == std::string_view("\x00\x01IM", 4)) return outline_of_version_5(bytes, false);
    if (version_and_order == std::string_view("\x01\x00MI", 4)) return outline_of_version_5(bytes, true);
  }
  if (bytes.empty()) return std::nullopt;
  if (const auto layout = outline_of_version_4(bytes, false)) return layout;
  return outline_of_version_4(bytes, true);
}

}  // namespace loopwright::mat
