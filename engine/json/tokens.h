/// A JSON text taken apart: everything that is in it, in a sixth of the memory that its values would fill. Of
/// a large text values are made one by one, where they are read.
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

/// One value; those inside a list or an object follow it.
struct JsonToken {
  /// Letters of the file, or beyond its end of JsonTokens::unescaped.
  struct Piece {
    uint32_t at, size;
  };
  struct Inside {
    uint32_t values;  ///< directly in it
    uint32_t end;     ///< the token after them
  };
  Value::Kind kind = Value::Kind::null;
  bool boolean = false, whole = false;
  uint32_t offset = 0;       ///< in the file
  uint32_t name_offset = 0;  ///< of a member of an object
  Piece name{};
  union {
    double number = 0;
    Piece text;
    Inside inside;  ///< of a list or an object
  };
};

struct JsonTokens {
  std::shared_ptr<const SourceFile> file;
  std::deque<JsonToken> list;  ///< the outermost value is the first
  std::string unescaped;       ///< texts that are written with escapes

  Value value(size_t token) const;
  Value::Member member(size_t token) const;
  /// The outermost value; of the object of this name in it all members are missing.
  Value value_without_members(std::string_view left_out) const;
  /// The value of this name in the outermost object.
  std::optional<size_t> find(std::string_view name) const;
  /// Beside a value inside a list or an object the next one.
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
