/// Typical damage to files: flipped bits, missing ends, foreign bytes, duplicated or missing parts.
#pragma once
#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "engine/json/problem.h"
#include "engine/record/recording.h"

namespace loopwright {

/// Damages `bytes` at one to four positions. The same random numbers give the same damage.
inline std::string mutate(std::string bytes, std::mt19937_64& random) {
  for (uint64_t count = 1 + random() % 4; count > 0; --count) {
    const size_t at = bytes.empty() ? 0 : random() % bytes.size();
    const size_t length = 1 + random() % 16;
    switch (random() % 7) {
      case 0:
        if (!bytes.empty()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
        break;
      case 1:
        bytes.resize(at);
        break;
      case 2:
        bytes.insert(at, 1, static_cast<char>(random()));
        break;
      case 3:
        bytes.insert(at, 1, ",;\t\n\r\"# []-+.e0"[random() % 15]);
        break;
      case 4:
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 5:
        bytes.erase(at, length);
        break;
      case 6:
        if (!bytes.empty()) bytes[at] = "\xFF\x00\x7F\x80\x01"[random() % 5];
        break;
    }
  }
  return bytes;
}

/// Flips bits behind the header and changes no length: such damage passes every check of the structure.
inline std::string flip_bits(std::string bytes, size_t header, std::mt19937_64& random) {
  for (uint64_t count = 1 + random() % 3; count > 0 && bytes.size() > header; --count) {
    const size_t at = header + random() % (bytes.size() - header);
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
  }
  return bytes;
}

inline bool is_refused_or_well_formed(const Recording& recording, const Problems& problems,
                                      const ReadOptions& options) {
  if (problems.has_errors()) return recording.columns.empty();
  check_recording(recording);  // throws
  if (recording.rows() == 0) return false;
  return options.allow_not_finite || std::ranges::all_of(recording.columns, [](const Column& column) {
           return std::ranges::all_of(column.values, [](double value) { return std::isfinite(value); });
         });
}

}  // namespace loopwright
