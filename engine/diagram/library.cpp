#include "engine/diagram/library.h"

#include <array>
#include <filesystem>
#include <fmt/format.h>
#include "engine/json/file_kind.h"
#include "engine/json/json.h"
#include "engine/json/reader.h"

namespace loopwright {
namespace {

constexpr int current_version = 1;
/// migrations[i] converts a file of version i + 1 to version i + 2.
using Migration = Value (*)(Value);
constexpr std::array<Migration, current_version - 1> migrations = {};

}  // namespace

const DiagramFile& DiagramLibrary::open(const std::string& path, const Place& reference) {
  const auto [entry, is_new] = files_.try_emplace(identity(path));
  DiagramFile& file = entry->second;
  if (!is_new) {
    if (!file.source)
      read_source(path, reference, problems_);  // every reference to a missing file is reported
    return file;
  }
  file.source = read_source(path, reference, problems_);
  if (!file.source) return file;
  names_.push_back(path);
  read(file);
  return file;
}

void DiagramLibrary::hold(std::shared_ptr<const SourceFile> source) {
  problems_.note_file(source->name, source->text);
  names_.push_back(source->name);
  DiagramFile& file = files_[identity(source->name)];
  file.source = std::move(source);
  read(file);
}

void DiagramLibrary::read(DiagramFile& file) {
  auto tokens = read_tokens(file.source, problems_);
  if (!tokens) return;
  Value root = tokens->value_without_members("blocks");
  const auto version = version_of(root);
  if (!version) return;
  if (*version == current_version) {
    file.root = std::move(root), file.tokens = std::move(tokens);
    return;
  }
  file.root = tokens->value(0);
  for (auto v = static_cast<size_t>(*version); v < current_version; ++v)
    file.root = migrations[v - 1](std::move(file.root));
}

const std::string& DiagramLibrary::identity(const std::string& path) {
  const auto [entry, is_new] = identities_.try_emplace(path);
  if (is_new) {
    std::error_code error;
    const auto canonical = std::filesystem::weakly_canonical(path, error);
    entry->second = error ? path : canonical.string();
  }
  return entry->second;
}

/// The current version if none is given; nothing after a problem that makes the rest meaningless.
std::optional<int> DiagramLibrary::version_of(const Value& root) {
  const Reader reader{problems_, {}};
  if (!reader.expect(root, Value::Kind::object, "the diagram", "an object: { \"loopwright\": 1, … }"))
    return {};
  if (!expect_kind(root, FileKind::diagram, problems_)) return {};
  const std::string expected = fmt::format("\"loopwright\": {}", current_version);
  const Value::Member* version = root.find("loopwright");
  if (!version) {
    reader.error(root, "the key \"loopwright\" is missing: the version of the format").expected = expected;
    return current_version;
  }
  const Value& number = version->value;
  if (!reader.expect(number, Value::Kind::number, "\"loopwright\"",
                     fmt::format("the number {}", current_version)))
    return current_version;
  const bool is_known = number.whole && number.number >= 1 && number.number <= current_version;
  if (is_known) return static_cast<int>(number.number);
  Problem& problem = reader.error(number, "the version of the format is not known");
  problem.expected = expected;
  problem.found = shown(number);
  if (number.number > current_version) problem.hint = "a newer Loopwright wrote this file";
  return {};
}

}  // namespace loopwright
