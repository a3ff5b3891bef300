/// A JSON text taken apart: everything that is in it, in a fifth of the memory that its values would fill. Of
/// a large text values are made one by one, where they are read.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "engine/diagram/problem.h"
#include "engine/diagram/value.h"

namespace loopwright {

/// One value; those inside a list or an object follow it.
struct JsonToken {
  /// Letters of the file, or beyond its end of JsonTokens::unescaped.
  struct Piece {
    uint32_t at = 0, size = 0;
  };
  Value::Kind kind = Value::Kind::null;
  bool boolean = false, whole = false;
  uint32_t offset = 0;       ///< in the file
  uint32_t name_offset = 0;  ///< of a member of an object
  Piece name;
  Piece text;           ///< of a text
  uint32_t values = 0;  ///< directly in a list or an object
  uint32_t next = 0;    ///< the token after it and all that is inside
  double number = 0;
};

struct JsonTokens {
  std::shared_ptr<const SourceFile> file;
  std::vector<JsonToken> list;  ///< the outermost value is the first
  std::string unescaped;        ///< texts that are written with escapes

  Value value(size_t token) const;
  Value::Member member(size_t token) const;
  /// The outermost value; of the object of this name in it all members are missing.
  Value value_without_members(std::string_view left_out) const;
  /// The value of this name in the outermost object.
  std::optional<size_t> find(std::string_view name) const;
  /// The first value inside a list or an object.
  size_t first_in(const JsonToken& token) const { return size_t(&token - list.data()) + 1; }
  std::string_view text(const JsonToken::Piece& piece) const;

 private:
  void make(const JsonToken& token, Value& value, std::string_view left_out) const;
  void make(const JsonToken& token, Value::Member& member) const;
};

/// Nothing after a problem; see parse_json.
std::optional<JsonTokens> read_tokens(std::shared_ptr<const SourceFile> file, Problems& problems);

/// Bytes.
constexpr size_t largest_json_file = 64u << 20;

}  // namespace loopwright
