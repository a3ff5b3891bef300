/// A tokenized JSON text with all its contents, in a sixth of the memory of its values. For a large text,
/// values are created one by one where they are read.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include "engine/json/problem.h"
#include "engine/json/value.h"

namespace loopwright {

/// One value; the values inside a list or an object follow it.
struct JsonToken {
  /// Characters of the file; offsets beyond its end refer to JsonTokens::unescaped.
  struct Piece {
    uint32_t at, size;
  };
  struct Inside {
    uint32_t values;  ///< number of direct children
    uint32_t end;     ///< index of the token after them
  };
  Value::Kind kind = Value::Kind::null;
  bool boolean = false, whole = false;
  uint32_t offset = 0;       ///< in the file
  uint32_t name_offset = 0;  ///< for a member of an object
  Piece name{};
  union {
    double number = 0;
    Piece text;
    Inside inside;  ///< for a list or an object
  };
};

struct JsonTokens {
  std::shared_ptr<const SourceFile> file;
  std::deque<JsonToken> list;  ///< the outermost value is the first
  std::string unescaped;       ///< texts written with escapes

  Value value(size_t token) const;
  Value::Member member(size_t token) const;
  /// The outermost value; its member with this name, an object, lacks all of its members.
  Value value_without_members(std::string_view left_out) const;
  /// The value with this name in the outermost object.
  std::optional<size_t> find(std::string_view name) const;
  /// The next value on the same level, for a value inside a list or an object.
  size_t after(size_t token) const { return has_inside(list[token]) ? list[token].inside.end : token + 1; }
  static bool has_inside(const JsonToken& token) {
    return token.kind == Value::Kind::list || token.kind == Value::Kind::object;
  }
  std::string_view text(const JsonToken::Piece& piece) const;

 private:
  void make(size_t at, Value& value, std::string_view left_out) const;
  void make(size_t at, Value::Member& member) const;
};

/// Nothing after a problem; see parse_json.
std::optional<JsonTokens> read_tokens(std::shared_ptr<const SourceFile> file, Problems& problems);

/// Bytes.
constexpr size_t largest_json_file = 64u << 20;

}  // namespace loopwright
