#include "engine/json/file_shape.h"
#include <algorithm>
#include <fmt/format.h>
#include "engine/json/reader.h"

namespace loopwright {

std::vector<std::string_view> FileShape::names() const {
  std::vector<std::string_view> names;
  const auto add = [&](std::string_view name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const Key& key : keys) add(key.name);
  if (kind == Kind::either)
    for (const FileShape& part : parts)
      for (const std::string_view name : part.names()) add(name);
  return names;
}

void reject_unknown(const Reader& reader, const Value& object, const FileShape& shape,
                    std::string_view owner) {
  const std::vector<std::string_view> known = shape.names();
  for (const Value::Member& member : object.members) {
    if (std::ranges::find(known, member.name) != known.end()) continue;
    Problem& problem = reader.error(member, fmt::format("{} has no key \"{}\"", owner, member.name));
    KnownNames({known.begin(), known.end()}).explain(problem, member.name);
  }
}

namespace shapes {
namespace {

FileShape of(FileShape::Kind kind) {
  FileShape shape;
  shape.kind = kind;
  return shape;
}
FileShape of_numbers(FileShape::Kind kind, double low, double high) {
  FileShape shape = of(kind);
  shape.low = low, shape.high = high;
  return shape;
}
FileShape of_parts(FileShape::Kind kind, std::vector<FileShape> parts, size_t fewest, size_t most) {
  FileShape shape = of(kind);
  shape.parts = std::move(parts), shape.fewest = fewest, shape.most = most;
  return shape;
}
FileShape::Key key(std::string_view name, FileShape shape, std::string sentence, bool is_required) {
  shape.sentence = std::move(sentence);
  return {name, std::move(shape), is_required};
}

}  // namespace

FileShape anything() { return of(FileShape::Kind::anything); }
FileShape text(size_t fewest) { return of_parts(FileShape::Kind::text, {}, fewest, FileShape::unlimited); }
FileShape flag() { return of(FileShape::Kind::flag); }
FileShape number(double low, double high) { return of_numbers(FileShape::Kind::number, low, high); }
FileShape whole(double low, double high) { return of_numbers(FileShape::Kind::whole, low, high); }
FileShape stated(double low) { return of_numbers(FileShape::Kind::stated, low, FileShape::infinity); }
FileShape computed() { return of(FileShape::Kind::computed); }
FileShape block() { return of(FileShape::Kind::block); }
FileShape choice(std::vector<std::string_view> choices) {
  FileShape shape = of(FileShape::Kind::choice);
  shape.choices = std::move(choices);
  return shape;
}
FileShape list(FileShape item, size_t fewest, size_t most) {
  return of_parts(FileShape::Kind::list, {std::move(item)}, fewest, most);
}
FileShape by_name(FileShape item, size_t fewest) {
  return of_parts(FileShape::Kind::by_name, {std::move(item)}, fewest, FileShape::unlimited);
}
FileShape object(std::vector<FileShape::Key> keys) {
  FileShape shape = of(FileShape::Kind::object);
  shape.keys = std::move(keys);
  return shape;
}
FileShape either(std::vector<FileShape> alternatives) {
  return of_parts(FileShape::Kind::either, std::move(alternatives), 0, FileShape::unlimited);
}

FileShape file(std::vector<FileShape::Key> keys) {
  keys.insert(keys.begin(), {optional("$schema", text(), "The JSON Schema of this file, for editors"),
                             required("loopwright", whole(1, 1), "Version of the format: 1")});
  return object(std::move(keys));
}

FileShape::Key required(std::string_view name, FileShape shape, std::string sentence) {
  return key(name, std::move(shape), std::move(sentence), true);
}
FileShape::Key optional(std::string_view name, FileShape shape, std::string sentence) {
  return key(name, std::move(shape), std::move(sentence), false);
}

}  // namespace shapes
}  // namespace loopwright
