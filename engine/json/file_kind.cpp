#include "engine/json/file_kind.h"
#include <array>
#include <fmt/format.h>
#include "engine/json/json.h"
#include "engine/json/tokens.h"

namespace loopwright {
namespace {

struct TellingKey {
  std::string_view key;
  FileKind kind;
};
/// The first key present in a file decides: an effect also has "blocks", a sweep also "diagram".
constexpr TellingKey telling_keys[] = {
    {"loopwright_gp_model", FileKind::model},
    {"effect", FileKind::effect},
    {"driver", FileKind::device},
    {"blocks", FileKind::diagram},
    {"axes", FileKind::sweep},
    {"metrics", FileKind::sweep},
    {"recordings", FileKind::training},
    {"label", FileKind::training},
    {"data", FileKind::experiment},
    {"compare", FileKind::experiment},
    {"drive", FileKind::experiment},
};

/// The program that reads a file of this kind.
std::string_view user_of(FileKind kind) {
  switch (kind) {
    case FileKind::diagram:
      return "`loopwright run` takes diagrams";
    case FileKind::experiment:
      return "`loopwright compare DIAGRAM EXPERIMENT` takes experiments, as fit and diagnose do";
    case FileKind::sweep:
      return "`loopwright sweep` takes sweeps";
    case FileKind::training:
      return "`loopwright gp train` takes training files";
    case FileKind::effect:
      return "`loopwright diagnose --effects FOLDER` takes folders of effects";
    case FileKind::device:
      return "the block HardwareIo names a device, `loopwright probe` asks it";
    case FileKind::model:
      return "the block Gpr names a learned model, `loopwright gp show` shows it";
    case FileKind::unknown:
      break;
  }
  return "";
}

const Value::Member* telling_member(const Value& file, FileKind& kind) {
  for (const TellingKey& telling : telling_keys)
    if (const Value::Member* member = file.find(telling.key)) {
      kind = telling.kind;
      return member;
    }
  kind = FileKind::unknown;
  return nullptr;
}

}  // namespace

std::string_view with_article(FileKind kind) {
  constexpr std::array<std::string_view, 8> names{"none of the files that are known here",
                                                  "a diagram",
                                                  "an experiment",
                                                  "a sweep",
                                                  "a training file",
                                                  "an effect",
                                                  "a device",
                                                  "a learned model"};
  return names[size_t(kind)];
}

FileKind kind_of(const Value& file) {
  FileKind kind;
  telling_member(file, kind);
  return kind;
}

FileKind kind_of_file(const std::string& path, Problems& problems) {
  const auto source = read_source(path, {}, problems);
  const auto tokens = source ? read_tokens(source, problems) : std::nullopt;
  return tokens ? kind_of(tokens->value_without_members("blocks")) : FileKind::unknown;
}

bool expect_kind(const Value& file, FileKind wanted, Problems& problems) {
  FileKind kind;
  const Value::Member* member = telling_member(file, kind);
  if (kind == FileKind::unknown || kind == wanted) return true;
  auto& p = problems.error(member->place, member->value.place.pointer(), "",
                           fmt::format("this is {}, not {}", with_article(kind), with_article(wanted)));
  p.found = fmt::format("the key \"{}\"", member->name);
  p.hint = user_of(kind);
  return false;
}

}  // namespace loopwright
