#include "tools/studio/session/text_change.h"
#include <algorithm>
#include <cstdint>

namespace loopwright::studio {
namespace {

/// A part of a text under change: bytes of the text before, or new ones.
struct Piece {
  bool is_new = false;
  size_t from = 0, to = 0;  // of the text before, or of `text`
  std::string text;
  size_t size() const { return to - from; }
};
using Pieces = std::vector<Piece>;

Piece cut(const Piece& piece, size_t from, size_t to) {
  Piece part = piece;
  part.from = piece.from + from, part.to = piece.from + to;
  return part;
}

Pieces changed(const Pieces& pieces, const TextChanges& changes) {
  Pieces result;
  size_t index = 0, inside = 0, at = 0;  // of the text that the pieces make
  const auto advance = [&](size_t target, bool keep) {
    while (at < target && index < pieces.size()) {
      const size_t step = std::min(target - at, pieces[index].size() - inside);
      if (keep && step > 0) result.push_back(cut(pieces[index], inside, inside + step));
      inside += step, at += step;
      if (inside == pieces[index].size()) ++index, inside = 0;
    }
  };
  for (const TextChange& change : changes) {
    advance(change.from, true);
    if (!change.text.empty()) result.push_back({true, 0, change.text.size(), change.text});
    advance(change.to, false);
  }
  advance(SIZE_MAX, true);
  return result;
}

/// What happened between the pieces of the text before that are left.
TextChanges read_off(const Pieces& pieces, size_t size) {
  TextChanges changes;
  size_t at = 0;
  std::string inserted;
  const auto close = [&](size_t next) {
    if (next > at || !inserted.empty()) changes.push_back({at, next, std::move(inserted)});
    inserted.clear();
  };
  for (const Piece& piece : pieces) {
    if (piece.is_new) {
      inserted.append(piece.text, piece.from, piece.size());
      continue;
    }
    close(piece.from);
    at = piece.to;
  }
  close(size);
  return changes;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
    lines.push_back(text.substr(at, end - at));
    at = end;
  }
  return lines;
}

/// Beyond this, two stretches of lines are replaced as a whole: the table of their common lines has the
/// product of their lengths.
constexpr size_t most_line_pairs = 4'000'000;

/// lengths[i][j]: of the longest common sequence of the lines from i and from j on.
class CommonLines {
 public:
  CommonLines(const std::vector<std::string_view>& a, const std::vector<std::string_view>& b)
      : width_(b.size() + 1), lengths_((a.size() + 1) * width_) {
    for (size_t i = a.size(); i-- > 0;)
      for (size_t j = b.size(); j-- > 0;)
        at(i, j) = a[i] == b[j] ? at(i + 1, j + 1) + 1 : std::max(at(i + 1, j), at(i, j + 1));
  }
  uint32_t& at(size_t i, size_t j) { return lengths_[i * width_ + j]; }

 private:
  size_t width_;
  std::vector<uint32_t> lengths_;
};

void add(TextChanges& changes, TextChange change) {
  if (!changes.empty() && changes.back().to == change.from) {
    changes.back().to = change.to;
    changes.back().text += change.text;
  } else {
    changes.push_back(std::move(change));
  }
}

}  // namespace

std::string applied(std::string_view before, const TextChanges& changes) {
  std::string result;
  size_t at = 0;
  for (const TextChange& change : changes) {
    result += before.substr(at, change.from - at);
    result += change.text;
    at = change.to;
  }
  return result += before.substr(at);
}

TextChanges inverse(std::string_view before, const TextChanges& changes) {
  TextChanges back;
  size_t longer = 0, shorter = 0;  // bytes inserted and removed so far
  for (const TextChange& change : changes) {
    const size_t from = change.from + longer - shorter;
    back.push_back(
        {from, from + change.text.size(), std::string(before.substr(change.from, change.to - change.from))});
    longer += change.text.size(), shorter += change.to - change.from;
  }
  return back;
}

TextChanges composed(size_t size, const TextChanges& first, const TextChanges& second) {
  return read_off(changed(changed({{false, 0, size, {}}}, first), second), size);
}

TextChanges difference(std::string_view before, std::string_view after) {
  std::vector<std::string_view> a = lines_of(before), b = lines_of(after);
  size_t head = 0, tail = 0, at = 0;
  while (head < std::min(a.size(), b.size()) && a[head] == b[head]) at += a[head++].size();
  while (tail < std::min(a.size(), b.size()) - head && a[a.size() - 1 - tail] == b[b.size() - 1 - tail])
    ++tail;
  a = {a.begin() + ptrdiff_t(head), a.end() - ptrdiff_t(tail)};
  b = {b.begin() + ptrdiff_t(head), b.end() - ptrdiff_t(tail)};
  TextChanges changes;
  if (a.size() * b.size() > most_line_pairs) {
    TextChange whole{at, at, {}};
    for (std::string_view line : a) whole.to += line.size();
    for (std::string_view line : b) whole.text += line;
    return {whole};
  }
  CommonLines common(a, b);
  for (size_t i = 0, j = 0; i < a.size() || j < b.size();) {
    if (i < a.size() && j < b.size() && a[i] == b[j]) {
      at += a[i].size(), ++i, ++j;
    } else if (j == b.size() || (i < a.size() && common.at(i + 1, j) >= common.at(i, j + 1))) {
      add(changes, {at, at + a[i].size(), {}});
      at += a[i++].size();
    } else {
      add(changes, {at, at, std::string(b[j++])});
    }
  }
  return changes;
}

std::optional<TextChanges> rebased(const TextChanges& changes, const TextChanges& others) {
  TextChanges result;
  for (const TextChange& change : changes) {
    size_t longer = 0, shorter = 0;
    for (const TextChange& other : others) {
      if (other.from > change.to) break;
      if (other.to >= change.from) return {};
      longer += other.text.size(), shorter += other.to - other.from;
    }
    result.push_back({change.from + longer - shorter, change.to + longer - shorter, change.text});
  }
  return result;
}

Utf16::Utf16(std::string_view text) : text_(text) {
  size_t units = 0;
  for (size_t at = 0; at < text.size();) {
    const auto lead = static_cast<unsigned char>(text[at]);
    const size_t length = lead < 0xc0 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    units += length == 4 ? 2 : 1;
    at = std::min(at + length, text.size());
    if (length > 1) after_.push_back({at, units});
  }
  total_units_ = units;
}

size_t Utf16::units(size_t bytes) const {
  bytes = std::min(bytes, text_.size());
  const auto next = std::ranges::upper_bound(after_, bytes, {}, &Point::bytes);
  if (next == after_.begin()) return bytes;
  const Point& last = *(next - 1);
  return std::min(last.units + (bytes - last.bytes), total_units_);
}

size_t Utf16::bytes(size_t units) const {
  units = std::min(units, total_units_);
  const auto next = std::ranges::upper_bound(after_, units, {}, &Point::units);
  if (next == after_.begin()) return units;
  const Point& last = *(next - 1);
  return std::min(last.bytes + (units - last.units), text_.size());
}

}  // namespace loopwright::studio
