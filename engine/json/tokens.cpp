#include "engine/json/tokens.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include "engine/json/syntax_error.h"

namespace loopwright {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr size_t largest_memory = 512u << 20;  // bytes, of the values in one text
constexpr size_t deepest_nesting = 64;
constexpr int most_duplicates = 100;  // reported; each needs a pass over the text

/// Receives the events of nlohmann's parser. The parser gives no positions, so a cursor follows it through
/// the text: at each event the token starts at the next character that is not white space, comma or colon.
class Tokenizer {
 public:
  using number_integer_t = nlohmann::json::number_integer_t;
  using number_unsigned_t = nlohmann::json::number_unsigned_t;
  using number_float_t = nlohmann::json::number_float_t;
  using string_t = nlohmann::json::string_t;
  using binary_t = nlohmann::json::binary_t;

  Tokenizer(JsonTokens& tokens, Problems& problems)
      : file_(tokens.file), text_(file_->text), problems_(problems), tokens_(tokens), list_(tokens.list) {
    if (text_.starts_with(byte_order_mark)) cursor_ = byte_order_mark.size();
  }

  bool null() { return begin(Value::Kind::null), end_leaf(); }
  bool boolean(bool boolean) {
    begin(Value::Kind::boolean).boolean = boolean;
    return end_leaf();
  }
  bool number_integer(number_integer_t number) { return number_float(static_cast<double>(number), {}); }
  bool number_unsigned(number_unsigned_t number) { return number_float(static_cast<double>(number), {}); }
  bool number_float(number_float_t number, const string_t&) {
    JsonToken& token = begin(Value::Kind::number);
    const std::string_view text = text_.substr(token.offset, end_of_token() - token.offset);
    token.whole = text.find_first_of(".eE") == text.npos;
    token.number = number == 0 && text.starts_with('-') ? -0.0 : number;
    return end_leaf();
  }
  bool string(string_t& text) {
    JsonToken& token = begin(Value::Kind::text);
    token.text = piece_of(text);
    return end_leaf();
  }
  bool binary(binary_t&) { return false; }  // occurs only in formats other than JSON

  bool start_object(size_t) { return open(Value::Kind::object, Awaited::first_name); }
  bool start_array(size_t) { return open(Value::Kind::list, Awaited::first_item); }
  bool key(string_t& name) {
    find_token();
    name_offset_ = static_cast<uint32_t>(cursor_);
    name_ = piece_of(name);
    cursor_ = end_of_token();
    awaited_ = Awaited::colon;
    return true;
  }
  bool end_object() {
    reject_duplicates(open_.back());
    return close();
  }
  bool end_array() { return close(); }

  bool parse_error(size_t, const std::string&, const nlohmann::json::exception&) {
    SyntaxErrorSite site{awaited_, cursor_, std::string::npos, pointer_in_hand()};
    if (!open_.empty()) site.innermost_bracket = list_[open_.back()].offset;
    problems_.add(explain_syntax_error(file_, site));
    return false;
  }

 private:
  void find_token() {
    while (cursor_ < text_.size() &&
           std::string_view(" \t\r\n,:").find(text_[cursor_]) != std::string_view::npos)
      ++cursor_;
  }
  size_t end_of_token() const {
    const char c = cursor_ < text_.size() ? text_[cursor_] : '\0';
    if (c == '"') return std::min(end_of_quoted(text_, cursor_), text_.size());
    if (c == 't' || c == 'n') return cursor_ + 4;  // true, null
    if (c == 'f') return cursor_ + 5;              // false
    return end_of_number(text_, cursor_);
  }
  /// The content of the quoted token at the cursor: a piece of the file, unless it is written with escapes.
  JsonToken::Piece piece_of(std::string_view content) {
    const auto size = static_cast<uint32_t>(content.size());
    if (end_of_token() - cursor_ == content.size() + 2) return {static_cast<uint32_t>(cursor_ + 1), size};
    const auto at = static_cast<uint32_t>(text_.size() + tokens_.unescaped.size());
    tokens_.unescaped += content;
    return {at, size};
  }

  Place place_of(const JsonToken& token) const { return {file_, token.offset}; }

  std::string pointer_in_hand() const {
    std::string pointer;
    for (size_t i = 0; i < open_.size(); ++i) {
      const bool is_last = i + 1 == open_.size();
      if (list_[open_[i]].kind == Value::Kind::list)
        pointer += fmt::format("/{}", list_[open_[i]].inside.values);
      else if (!is_last)
        pointer += pointer_token(tokens_.text(list_[open_[i + 1]].name));
      else if (awaited_ == Awaited::colon)
        pointer += pointer_token(tokens_.text(name_));
    }
    return pointer;
  }

  JsonToken& begin(Value::Kind kind) {
    find_token();
    JsonToken& token = list_.emplace_back();
    token.kind = kind;
    token.offset = static_cast<uint32_t>(cursor_);
    token.name = name_, token.name_offset = name_offset_;
    memory_ += sizeof(Value::Member);
    return token;
  }
  bool end_leaf() {
    cursor_ = end_of_token();
    return end(list_.back());
  }

  bool open(Value::Kind kind, Awaited awaited) {
    JsonToken& token = begin(kind);
    token.inside = {};
    const Place place = place_of(token);
    ++cursor_;
    awaited_ = awaited;
    if (open_.size() == deepest_nesting) {
      problems_.error(place, place.pointer(), {},
                      fmt::format("the values nest deeper than {} levels", deepest_nesting));
      return false;
    }
    open_.push_back(list_.size() - 1);
    return true;
  }
  bool close() {
    find_token();
    ++cursor_;
    JsonToken& closed = list_[open_.back()];
    open_.pop_back();
    closed.inside.end = static_cast<uint32_t>(list_.size());
    return end(closed);
  }

  bool end(JsonToken& token) {
    if (memory_ > largest_memory) {
      problems_.error(place_of(token), place_of(token).pointer(), {},
                      "the file holds too many values to fit into 512 MB of memory");
      return false;
    }
    if (open_.empty()) {
      awaited_ = Awaited::end_of_text;
      return true;
    }
    JsonToken& around = list_[open_.back()];
    ++around.inside.values;
    awaited_ = around.kind == Value::Kind::list ? Awaited::comma_in_list : Awaited::comma_in_object;
    return true;
  }

  bool has_duplicates(size_t object) const {
    for (size_t i = object + 1; i < list_.size(); i = tokens_.after(i))
      for (size_t j = object + 1; j < i; j = tokens_.after(j))
        if (tokens_.text(list_[j].name) == tokens_.text(list_[i].name)) return true;
    return false;
  }
  /// True if no two names share a hash; then no name occurs twice. For consecutive numbers sorting is faster
  /// than a hash table.
  bool have_own_hashes(size_t object) const {
    std::vector<size_t> hashes;
    hashes.reserve(list_[object].inside.values);
    for (size_t i = object + 1; i < list_.size(); i = tokens_.after(i))
      hashes.push_back(std::hash<std::string_view>()(tokens_.text(list_[i].name)));
    std::ranges::sort(hashes);
    return std::ranges::adjacent_find(hashes) == hashes.end();
  }

  /// Called at the end of the object, whose values are the last in the list.
  void reject_duplicates(size_t object) {
    constexpr size_t few = 8;  // faster to compare pairwise
    const size_t values = list_[object].inside.values;
    if (values <= few ? !has_duplicates(object) : have_own_hashes(object)) return;
    std::unordered_map<std::string_view, const JsonToken*> first;
    first.reserve(values);
    for (size_t i = object + 1; i < list_.size(); i = tokens_.after(i)) {
      const std::string_view name = tokens_.text(list_[i].name);
      const auto [found, is_new] = first.try_emplace(name, &list_[i]);
      if (is_new || ++duplicates_ > most_duplicates) continue;
      const LineColumn place = line_column({file_, found->second->name_offset});
      const Place again{file_, list_[i].name_offset};
      Problem& problem =
          problems_.error(again, again.pointer(), {}, fmt::format("\"{}\" is there twice", name));
      problem.hint = fmt::format("the first one is in line {}, column {}", place.line, place.column);
    }
  }

  const std::shared_ptr<const SourceFile>& file_;
  std::string_view text_;
  Problems& problems_;
  JsonTokens& tokens_;
  std::deque<JsonToken>& list_;
  size_t cursor_ = 0;
  Awaited awaited_ = Awaited::value;
  std::vector<size_t> open_;  // outermost first
  JsonToken::Piece name_{};   // of the member whose value follows
  uint32_t name_offset_ = 0;
  size_t memory_ = 0;
  int duplicates_ = 0;
};

/// Texts that can be rejected without nlohmann's parser. True after a problem.
bool reject_text(const std::shared_ptr<const SourceFile>& file, Problems& problems) {
  const std::string_view text = file->text;
  const auto reject = [&](size_t at, std::string message) -> Problem& {
    return problems.error({file, static_cast<uint32_t>(at)}, {}, {}, std::move(message));
  };
  if (text.size() > largest_json_file) return reject(0, "the file is larger than 64 MB"), true;
  if (const size_t at = find_bad_byte(text); at != text.npos) {
    Problem& problem = reject(at, "this byte belongs to no character");
    problem.expected = "text in UTF-8";
    problem.found = fmt::format("the byte 0x{:02X}", static_cast<unsigned char>(text[at]));
    return true;
  }
  const size_t begin = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  if (skip_space(text, begin) == text.size()) {
    reject(0, "the file is empty").expected = "a JSON object: { … }";
    return true;
  }
  return false;
}

}  // namespace

Value JsonTokens::value(size_t token) const {
  Value value;
  make(token, value, {});
  return value;
}

Value JsonTokens::value_without_members(std::string_view left_out) const {
  Value value;
  make(0, value, left_out);
  return value;
}

Value::Member JsonTokens::member(size_t token) const {
  Value::Member member;
  make(token, member);
  return member;
}

std::optional<size_t> JsonTokens::find(std::string_view name) const {
  if (list[0].kind == Value::Kind::object)
    for (size_t i = 1; i < list.size(); i = after(i))
      if (text(list[i].name) == name) return i;
  return {};
}

std::string_view JsonTokens::text(const JsonToken::Piece& piece) const {
  const size_t in_file = file->text.size();
  return piece.at < in_file ? std::string_view(file->text).substr(piece.at, piece.size)
                            : std::string_view(unescaped).substr(piece.at - in_file, piece.size);
}

void JsonTokens::make(size_t at, Value::Member& member) const {
  member.name = text(list[at].name);
  member.place = {file, list[at].name_offset};
  make(at, member.value, {});
}

void JsonTokens::make(size_t at, Value& value, std::string_view left_out) const {
  const JsonToken& token = list[at];
  value.kind = token.kind;
  value.place = {file, token.offset};
  switch (token.kind) {
    case Value::Kind::null:
      break;
    case Value::Kind::boolean:
      value.boolean = token.boolean;
      break;
    case Value::Kind::number:
      value.number = token.number, value.whole = token.whole;
      break;
    case Value::Kind::text:
      value.text = text(token.text);
      break;
    case Value::Kind::list:
      value.items.reserve(token.inside.values);
      for (size_t i = at + 1; i < token.inside.end; i = after(i)) make(i, value.items.emplace_back(), {});
      break;
    case Value::Kind::object:
      value.members.reserve(token.inside.values);
      for (size_t i = at + 1; i < token.inside.end; i = after(i)) {
        Value::Member& member = value.members.emplace_back();
        if (list[i].kind == Value::Kind::object && !left_out.empty() && text(list[i].name) == left_out) {
          member.name = left_out;
          member.place = {file, list[i].name_offset};
          member.value.kind = Value::Kind::object;
          member.value.place = {file, list[i].offset};
        } else {
          make(i, member);
        }
      }
      break;
  }
}

std::optional<JsonTokens> read_tokens(std::shared_ptr<const SourceFile> file, Problems& problems) {
  if (reject_text(file, problems)) return {};
  JsonTokens tokens{std::move(file), {}, {}};
  Problems found;
  Tokenizer tokenizer(tokens, found);
  // The only exceptions possible here come from the standard library when memory is exhausted; errors arrive
  // as events.
  const bool is_complete = nlohmann::json::sax_parse(tokens.file->text, &tokenizer);
  const bool is_good = is_complete && !found.has_errors();
  for (const Problem& problem : found.list()) problems.add(problem);
  if (!is_good) return {};
  return tokens;
}

}  // namespace loopwright
