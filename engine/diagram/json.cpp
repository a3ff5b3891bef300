#include "engine/diagram/json.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <span>
#include <unordered_map>
#include "engine/diagram/syntax_error.h"

namespace loopwright {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr size_t largest_file = 64u << 20;     // bytes
constexpr size_t largest_memory = 512u << 20;  // bytes, of the values in one text
constexpr size_t deepest_nesting = 64;
constexpr int most_duplicates = 100;  // reported; each costs a walk through the text

/// Receives the events of nlohmann's parser. It tells no positions, so a cursor walks through the text along
/// with it: at each event the token starts at the next character that is no white space, comma or colon.
class ValueBuilder {
 public:
  using number_integer_t = nlohmann::json::number_integer_t;
  using number_unsigned_t = nlohmann::json::number_unsigned_t;
  using number_float_t = nlohmann::json::number_float_t;
  using string_t = nlohmann::json::string_t;
  using binary_t = nlohmann::json::binary_t;

  ValueBuilder(std::shared_ptr<const SourceFile> file, Problems& problems)
      : file_(std::move(file)), text_(file_->text), problems_(problems) {
    if (text_.starts_with(byte_order_mark)) cursor_ = byte_order_mark.size();
  }

  Value take_result() { return std::move(result_); }

  bool null() { return leaf(begin_value(Value::Kind::null)); }
  bool boolean(bool boolean) {
    Value value = begin_value(Value::Kind::boolean);
    value.boolean = boolean;
    return leaf(std::move(value));
  }
  bool number_integer(number_integer_t number) { return number_float(static_cast<double>(number), {}); }
  bool number_unsigned(number_unsigned_t number) { return number_float(static_cast<double>(number), {}); }
  bool number_float(number_float_t number, const string_t&) {
    Value value = begin_value(Value::Kind::number);
    const std::string_view token = text_.substr(value.place.offset, end_of_token() - value.place.offset);
    value.whole = token.find_first_of(".eE") == token.npos;
    value.number = number == 0 && token.starts_with('-') ? -0.0 : number;
    return leaf(std::move(value));
  }
  bool string(string_t& text) {
    Value value = begin_value(Value::Kind::text);
    value.text = text;  // a copy of its own length: what the parser reads into is longer, and used again
    return leaf(std::move(value));
  }
  bool binary(binary_t&) { return false; }  // of other formats than JSON

  bool start_object(size_t) { return open(Value::Kind::object, Awaited::first_name); }
  bool start_array(size_t) { return open(Value::Kind::list, Awaited::first_item); }
  bool key(string_t& name) {
    find_token();
    name_ = name;
    name_place_ = {file_, static_cast<uint32_t>(cursor_)};
    cursor_ = end_of_token();
    awaited_ = Awaited::colon;
    return true;
  }
  bool end_object() {
    reject_duplicates(std::span(values_).subspan(open_.back().first));
    return close();
  }
  bool end_array() { return close(); }

  bool parse_error(size_t, const std::string&, const nlohmann::json::exception&) {
    SyntaxErrorSite site{awaited_, cursor_, std::string::npos, pointer_in_hand()};
    if (!open_.empty()) site.innermost_bracket = open_.back().member.value.place.offset;
    problems_.add(explain_syntax_error(file_, site));
    return false;
  }

 private:
  /// A value whose end was not met yet; what it holds so far stands in `values_`.
  struct Open {
    Value::Member member;
    size_t first;  // of its own
  };

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

  std::string pointer_in_hand() const {
    std::string pointer;
    for (size_t i = 0; i < open_.size(); ++i) {
      const bool is_last = i + 1 == open_.size();
      if (open_[i].member.value.kind == Value::Kind::list)
        pointer += fmt::format("/{}", (is_last ? values_.size() : open_[i + 1].first) - open_[i].first);
      else if (!is_last)
        pointer += pointer_token(open_[i + 1].member.name);
      else if (awaited_ == Awaited::colon)
        pointer += pointer_token(name_);
    }
    return pointer;
  }

  Value begin_value(Value::Kind kind) {
    find_token();
    Value value;
    value.kind = kind;
    value.place = {file_, static_cast<uint32_t>(cursor_)};
    memory_ += sizeof(Value::Member);
    return value;
  }

  bool leaf(Value value) {
    cursor_ = end_of_token();
    return add({std::move(name_), std::move(name_place_), std::move(value)});
  }

  bool open(Value::Kind kind, Awaited awaited) {
    Value value = begin_value(kind);
    ++cursor_;
    awaited_ = awaited;
    if (open_.size() == deepest_nesting) {
      problems_.error(value.place, value.place.pointer(), {},
                      fmt::format("the values nest deeper than {} levels", deepest_nesting));
      return false;
    }
    open_.push_back({{std::move(name_), std::move(name_place_), std::move(value)}, values_.size()});
    return true;
  }

  /// The values of the innermost bracket move into lists of just their length.
  bool close() {
    find_token();
    ++cursor_;
    Value::Member closed = std::move(open_.back().member);
    const auto first = values_.begin() + ptrdiff_t(open_.back().first);
    open_.pop_back();
    if (closed.value.kind == Value::Kind::object) {
      closed.value.members.assign(std::move_iterator(first), std::move_iterator(values_.end()));
    } else {
      closed.value.items.reserve(size_t(values_.end() - first));
      for (auto item = first; item != values_.end(); ++item)
        closed.value.items.push_back(std::move(item->value));
    }
    values_.erase(first, values_.end());
    return add(std::move(closed));
  }

  bool add(Value::Member member) {
    if (memory_ > largest_memory) {
      problems_.error(member.value.place, member.value.place.pointer(), {},
                      "the file holds too many values to fit into 512 MB of memory");
      return false;
    }
    if (open_.empty()) {
      result_ = std::move(member.value);
      awaited_ = Awaited::end_of_text;
      return true;
    }
    const bool in_list = open_.back().member.value.kind == Value::Kind::list;
    values_.push_back(std::move(member));
    awaited_ = in_list ? Awaited::comma_in_list : Awaited::comma_in_object;
    return true;
  }

  static bool has_duplicates(std::span<const Value::Member> members) {
    for (size_t i = 1; i < members.size(); ++i)
      for (size_t j = 0; j < i; ++j)
        if (members[j].name == members[i].name) return true;
    return false;
  }
  /// No two names share a hash: then none is there twice. Numbers in a row are sooner sorted than a table is
  /// filled.
  static bool have_own_hashes(std::span<const Value::Member> members) {
    std::vector<size_t> hashes;
    hashes.reserve(members.size());
    for (const Value::Member& member : members) hashes.push_back(std::hash<std::string_view>()(member.name));
    std::ranges::sort(hashes);
    return std::ranges::adjacent_find(hashes) == hashes.end();
  }

  void reject_duplicates(std::span<const Value::Member> members) {
    constexpr size_t few = 8;  // sooner compared each with each
    if (members.size() <= few ? !has_duplicates(members) : have_own_hashes(members)) return;
    std::unordered_map<std::string_view, const Value::Member*> first;
    first.reserve(members.size());
    for (const Value::Member& member : members) {
      const auto [found, is_new] = first.try_emplace(member.name, &member);
      if (is_new || ++duplicates_ > most_duplicates) continue;
      const LineColumn place = line_column(found->second->place);
      Problem& problem = problems_.error(member.place, member.place.pointer(), {},
                                         fmt::format("\"{}\" is there twice", member.name));
      problem.hint = fmt::format("the first one is in line {}, column {}", place.line, place.column);
    }
  }

  std::shared_ptr<const SourceFile> file_;
  std::string_view text_;
  Problems& problems_;
  size_t cursor_ = 0;
  Awaited awaited_ = Awaited::value;
  std::vector<Open> open_;
  std::vector<Value::Member> values_;  // of all open brackets, those of outer ones first; items lack a name
  std::string name_;                   // of the member whose value comes next
  Place name_place_;
  size_t memory_ = 0;
  int duplicates_ = 0;
  Value result_;
};

/// Texts that nlohmann's parser need not see. True after a problem.
bool reject_text(const std::shared_ptr<const SourceFile>& file, Problems& problems) {
  const std::string_view text = file->text;
  const auto reject = [&](size_t at, std::string message) -> Problem& {
    return problems.error({file, static_cast<uint32_t>(at)}, {}, {}, std::move(message));
  };
  if (text.size() > largest_file) return reject(0, "the file is larger than 64 MB"), true;
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

void write_text(std::string_view text, std::string& to) {
  to += '"';
  for (const char c : text) {
    switch (c) {
      case '"':
        to += "\\\"";
        break;
      case '\\':
        to += "\\\\";
        break;
      case '\n':
        to += "\\n";
        break;
      case '\t':
        to += "\\t";
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20)
          to += fmt::format("\\u{:04x}", c);
        else
          to += c;
    }
  }
  to += '"';
}

void write(const Value& value, std::string& to) {
  switch (value.kind) {
    case Value::Kind::null:
      to += "null";
      break;
    case Value::Kind::boolean:
      to += value.boolean ? "true" : "false";
      break;
    case Value::Kind::number:
      to += std::isfinite(value.number) ? fmt::format("{}", value.number) : "null";
      break;
    case Value::Kind::text:
      write_text(value.text, to);
      break;
    case Value::Kind::list:
      to += '[';
      for (size_t i = 0; i < value.items.size(); ++i) {
        if (i > 0) to += ',';
        write(value.items[i], to);
      }
      to += ']';
      break;
    case Value::Kind::object:
      to += '{';
      for (size_t i = 0; i < value.members.size(); ++i) {
        if (i > 0) to += ',';
        write_text(value.members[i].name, to);
        to += ':';
        write(value.members[i].value, to);
      }
      to += '}';
  }
}

}  // namespace

std::shared_ptr<const SourceFile> read_source(const std::string& path, const Place& reference,
                                              Problems& problems) {
  const auto fail = [&](std::string reason) {
    // A file named on the command line has no place of reference: then the message stands at its own name.
    const Place place =
        reference.file ? reference : Place{std::make_shared<SourceFile>(SourceFile{path, {}}), 0};
    problems.error(place, {}, {}, fmt::format("the file \"{}\" cannot be read: {}", path, reason));
    return nullptr;
  };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (path.empty() || !std::filesystem::exists(status)) return fail("there is no such file");
  if (std::filesystem::is_directory(status)) return fail("it is a folder");
  if (!std::filesystem::is_regular_file(status) && !std::filesystem::is_fifo(status))
    return fail("it is not a file of text");
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return fail(std::strerror(errno));
  auto file = std::make_shared<SourceFile>(SourceFile{path, {}});
  constexpr size_t chunk = 1u << 16;
  while (stream && file->text.size() <= largest_file) {
    const size_t length = file->text.size();
    file->text.resize(length + chunk);
    stream.read(file->text.data() + length, chunk);
    file->text.resize(length + static_cast<size_t>(stream.gcount()));
  }
  if (stream.bad()) return fail(std::strerror(errno));
  if (file->text.size() > largest_file) return fail("it is larger than 64 MB");
  return file;
}

Value parse_json(std::shared_ptr<const SourceFile> file, Problems& problems) {
  if (reject_text(file, problems)) return {};
  Problems found;
  ValueBuilder builder(file, found);
  // What the standard library throws for want of memory is the only exception here: errors arrive as events.
  const bool is_complete = nlohmann::json::sax_parse(file->text, &builder);
  const bool is_good = is_complete && !found.has_errors();
  for (const Problem& problem : found.list()) problems.add(problem);
  return is_good ? builder.take_result() : Value{};
}

std::string to_json(const Value& value) {
  std::string text;
  write(value, text);
  return text;
}

}  // namespace loopwright
