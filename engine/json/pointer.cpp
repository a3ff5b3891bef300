#include <algorithm>
#include <fmt/format.h>
#include <vector>
#include "engine/json/problem.h"
#include "engine/json/syntax_error.h"

namespace loopwright {
namespace {

constexpr uint32_t nothing = UINT32_MAX;

void append_utf8(uint32_t code, std::string& to) {
  const auto add = [&to](uint32_t byte) { to += static_cast<char>(byte); };
  if (code < 0x80) return add(code);
  if (code < 0x800) return add(0xC0 | code >> 6), add(0x80 | (code & 0x3F));
  if (code < 0x10000)
    return add(0xE0 | code >> 12), add(0x80 | (code >> 6 & 0x3F)), add(0x80 | (code & 0x3F));
  add(0xF0 | code >> 18), add(0x80 | (code >> 12 & 0x3F)), add(0x80 | (code >> 6 & 0x3F)),
      add(0x80 | (code & 0x3F));
}

uint32_t hexadecimal(std::string_view digits) {
  uint32_t code = 0;
  for (const char c : digits)
    code = code << 4 | static_cast<uint32_t>(c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10);
  return code;
}

/// The content of a valid JSON text token, without the quotes.
std::string unquoted(std::string_view token) {
  std::string text;
  for (size_t i = 1; i + 1 < token.size(); ++i) {
    if (token[i] != '\\') {
      text += token[i];
      continue;
    }
    constexpr std::string_view letters = "bfnrt", meanings = "\b\f\n\r\t";
    const char c = token[++i];
    if (const size_t letter = letters.find(c); letter != letters.npos) {
      text += meanings[letter];
    } else if (c == 'u') {
      uint32_t code = hexadecimal(token.substr(i + 1, 4));
      i += 4;
      if (code >= 0xD800 && code < 0xDC00) {  // the second half of a surrogate pair follows
        code = 0x10000 + ((code - 0xD800) << 10) + (hexadecimal(token.substr(i + 3, 4)) - 0xDC00);
        i += 6;
      }
      append_utf8(code, text);
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

/// The values of a JSON text, in their order.
class PointerTable {
 public:
  explicit PointerTable(std::string_view text) : text_(text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    size_t at = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
    uint32_t name = nothing;
    while ((at = first(at, [](char c) { return !is_between(c); })) < text_.size()) {
      const char c = text_[at];
      if (c == '}' || c == ']') {
        if (open_.empty()) return;
        open_.pop_back();
        ++at;
        continue;
      }
      if (c == '"' && name == nothing && !open_.empty() && text_[values_[open_.back()].offset] == '{') {
        name = static_cast<uint32_t>(at);
      } else {
        add(static_cast<uint32_t>(at), name);
        name = nothing;
      }
      const size_t end = end_of(at);
      if (end == text_.npos || end <= at) break;  // the text is invalid from here on
      at = end;
    }
  }

  std::string at(uint32_t offset) const {
    auto value = std::ranges::upper_bound(values_, offset, {}, &Entry::begin);
    if (value == values_.begin()) return {};
    std::vector<const Entry*> path;
    for (const Entry* entry = &*--value; entry->parent != nothing; entry = &values_[entry->parent])
      path.push_back(entry);
    std::string pointer;
    for (size_t i = path.size(); i-- > 0;)
      pointer += path[i]->name == nothing
                     ? fmt::format("/{}", path[i]->index)
                     : pointer_token(unquoted(
                           text_.substr(path[i]->name, end_of_quoted(text_, path[i]->name) - path[i]->name)));
    return pointer;
  }

 private:
  struct Entry {
    uint32_t begin;   // of its name, if it has one
    uint32_t offset;  // of the value
    uint32_t parent, name, index;
    uint32_t items = 0;  // so far
  };

  void add(uint32_t offset, uint32_t name) {
    const uint32_t parent = open_.empty() ? nothing : open_.back();
    const uint32_t index = parent == nothing ? 0 : values_[parent].items++;
    values_.push_back({name == nothing ? offset : name, offset, parent, name, index});
    if (offset < text_.size() && (text_[offset] == '{' || text_[offset] == '['))
      open_.push_back(static_cast<uint32_t>(values_.size() - 1));
  }

  /// What stands between values: find_first_of() would search this set for every character.
  static bool is_between(char c) {
    return c == ' ' || c == ',' || c == ':' || c == '\n' || c == '\r' || c == '\t';
  }
  template <class Wanted> size_t first(size_t at, Wanted wanted) const {
    while (at < text_.size() && !wanted(text_[at])) ++at;
    return at;
  }
  size_t end_of(size_t at) const {
    switch (text_[at]) {
      case '{':
      case '[':
        return at + 1;
      case '"':
        return end_of_quoted(text_, at);
      default:
        return first(at, [](char c) { return is_between(c) || c == ']' || c == '}'; });
    }
  }

  std::string_view text_;
  std::vector<Entry> values_;
  std::vector<uint32_t> open_;
};

std::string pointer_token(std::string_view name) {
  std::string token = "/";
  for (const char c : name) {
    if (c == '~')
      token += "~0";
    else if (c == '/')
      token += "~1";
    else
      token += c;
  }
  return token;
}

std::string Place::pointer() const {
  if (!file) return {};
  std::shared_ptr<const PointerTable> table = std::atomic_load(&file->pointers);
  if (!table) {
    table = std::make_shared<const PointerTable>(file->text);
    std::atomic_store(&file->pointers, table);
  }
  return table->at(offset);
}

}  // namespace loopwright
