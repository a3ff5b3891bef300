/// Changes of a text that leave the rest of it untouched, and their inverses.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace loopwright::studio {

/// Replaces the bytes [from, to) of a text.
struct TextChange {
  size_t from = 0, to = 0;
  std::string text;
  bool operator==(const TextChange&) const = default;
};

/// Ascending and disjoint; all offsets are those of the text before.
using TextChanges = std::vector<TextChange>;

std::string applied(std::string_view before, const TextChanges& changes);

/// The changes that lead back, with offsets of the text after.
TextChanges inverse(std::string_view before, const TextChanges& changes);

/// `first` and then `second` as changes of the text before `first`, which has `size` bytes.
TextChanges composed(size_t size, const TextChanges& first, const TextChanges& second);

/// Changes of whole lines that lead from one text to the other.
TextChanges difference(std::string_view before, std::string_view after);

/// `changes`, made to a text, as changes of the text after `others`. Nothing if both touch the same place.
std::optional<TextChanges> rebased(const TextChanges& changes, const TextChanges& others);

/// Offsets in bytes of a UTF-8 text, and in the UTF-16 units that a browser counts. An offset beyond the end
/// is the end.
class Utf16 {
 public:
  explicit Utf16(std::string_view text);
  size_t units(size_t bytes) const;
  size_t bytes(size_t units) const;

 private:
  struct Point {
    size_t bytes, units;
  };
  std::string_view text_;
  std::vector<Point> after_;  ///< behind every character beyond ASCII
  size_t total_units_ = 0;
};

}  // namespace loopwright::studio
