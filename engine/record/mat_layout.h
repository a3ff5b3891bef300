/// The structure of a MAT file, read from its headers only: enough to detect a damaged file.
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace loopwright::mat {

struct Layout {
  enum class Version { four, five, seven_three };
  Version version = Version::five;
  std::optional<size_t> variables;  ///< expected number; not known for version 7.3 (HDF5)
  std::string damage;               ///< the contradiction found; empty: none
  size_t damage_offset = 0;         ///< [bytes]
};

/// Nothing if the bytes are not a MAT file at all. Source: MathWorks, "MAT-File Format", R2019a (levels 4 and
/// 5); HDF5 file format specification (signature).
std::optional<Layout> outline(std::string_view bytes);

}  // namespace loopwright::mat
