#include "engine/json/json.h"

#include <cmath>
#include <fmt/format.h>
#include "engine/file/regular_file.h"
#include "engine/json/nearest_file.h"
#include "engine/json/read_bytes.h"
#include "engine/json/tokens.h"

namespace loopwright {
namespace {

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
  return read_bytes(path, reference, largest_json_file, problems);
}

std::shared_ptr<const SourceFile> read_bytes(const std::string& path, const Place& reference, size_t largest,
                                             Problems& problems) {
  const auto fail = [&](std::string reason) {
    // A file named on the command line has no source location of its reference: the message then shows its
    // own name.
    const Place place =
        reference.file ? reference : Place{std::make_shared<SourceFile>(SourceFile{path, {}}), 0};
    problems.error(place, {}, {}, fmt::format("the file \"{}\" cannot be read: {}", path, reason)).hint =
        nearest_file_hint(path);
    return nullptr;
  };
  auto file = std::make_shared<SourceFile>(SourceFile{path, {}});
  const std::string reason = read_regular_file(path, largest, file->text);
  if (!reason.empty()) return fail(reason);
  problems.note_file(path, file->text);
  return file;
}

Value parse_json(std::shared_ptr<const SourceFile> file, Problems& problems) {
  const auto tokens = read_tokens(std::move(file), problems);
  return tokens ? tokens->value(0) : Value{};
}

std::string to_json(const Value& value) {
  std::string text;
  write(value, text);
  return text;
}

}  // namespace loopwright
