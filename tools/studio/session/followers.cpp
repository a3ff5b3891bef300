#include "tools/studio/session/followers.h"
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>
#include "engine/diagram/diagram.h"
#include "engine/json/file_kind.h"
#include "engine/json/reader.h"
#include "tools/studio/session/experiment_text.h"
#include "tools/studio/session/inclusions.h"
#include "tools/studio/session/member_change.h"
#include "tools/studio/session/references.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;
namespace fs = std::filesystem;

/// A JSON file of the folder.
struct Entry {
  std::string path;  ///< below the folder
  std::string identity;
  ParsedText parsed;
  FileKind kind;
  TextChanges changes = {};
  const Value& root() const { return parsed.root; }
  bool is_diagram() const { return kind == FileKind::diagram || kind == FileKind::effect; }
};

std::string first_part(const std::string& path) { return path.substr(0, path.find_first_of(".[")); }

bool has_entry(const Value& diagram, std::string_view list, const std::string& name) {
  const Value::Member* entries = diagram.find(list);
  return entries && entries->value.find(name);
}

/// Whether a path of a block or parameter begins in this diagram.
bool begins_in(const Value& diagram, const Renaming& renaming) {
  const std::string name = first_part(renaming.from);
  const bool is_own_parameter = renaming.kind == Renaming::Kind::parameter && name == renaming.from;
  return has_entry(diagram, is_own_parameter ? "parameters" : "blocks", name);
}

/// What the level of a renamed block or parameter tells about the paths that name it.
Renaming with_surroundings(Renaming renaming, const Value& root) {
  const Value* diagram = &root;
  const std::vector<std::string> parts = split_path(renaming.from);
  for (size_t i = 0; i + 1 < parts.size(); ++i) {
    const Value::Member* blocks = diagram->find("blocks");
    const Value::Member* block = blocks ? blocks->value.find(parts[i]) : nullptr;
    if (!block) return renaming;
    const Value* inner = nullptr;
    each_body(block->value, [&](const Value& body) {
      const Value* found = subdiagram_of(body);
      if (found && found->kind == Kind::object && !inner) inner = found;
    });
    if (!inner) return renaming;
    diagram = inner;
  }
  const bool is_block = renaming.kind == Renaming::Kind::block;
  const std::string_view others = is_block ? "parameters" : "blocks";
  renaming.has_namesake = has_entry(*diagram, others, parts.back());
  renaming.meets_namesake = has_entry(*diagram, others, split_path(renaming.to).back());
  for (const char* list : {"parameters", "blocks"})
    if (const Value::Member* entries = diagram->find(list))
      for (const Value::Member& entry : entries->value.members) {
        bool is_subdiagram = false;
        each_body(entry.value, [&](const Value& body) { is_subdiagram |= body.find("diagram") != nullptr; });
        if (!is_subdiagram) renaming.in_scope.insert(entry.name);
      }
  return renaming;
}

class Search {
 public:
  Search(const Folder& folder, const std::string& path, const std::string& text,
         const std::vector<Renaming>& renamings)
      : folder_(folder), diagram_{path, identity(path), ParsedText(path, text), FileKind::diagram} {
    for (const Renaming& renaming : renamings)
      renamings_.push_back(with_surroundings(renaming, diagram_.root()));
    renamed_[diagram_.identity] = renamings_;
  }

  Following run() {
    read_files();
    for (Entry& entry : entries_)
      if (entry.is_diagram()) renamed_in(entry);
    for (Entry& entry : entries_) {
      if (entry.kind == FileKind::sweep) follow_in_sweep(entry);
      if (entry.kind == FileKind::experiment) follow_in_experiment(entry);
    }
    for (Entry& entry : entries_) finish(entry);
    return std::move(following_);
  }

 private:
  std::string identity(const std::string& path) const {
    std::error_code code;
    const fs::path whole = path.empty() ? fs::path(folder_.path()) : fs::path(folder_.path()) / path;
    return fs::weakly_canonical(whole, code).string();
  }
  /// Of a file that a text in another one names.
  std::string identity(const Value& name) const { return identity(resolve_relative(name.place, name.text)); }

  void leave_behind(const Entry& entry, std::string_view why) {
    following_.left_behind.push_back(fmt::format("\"{}\" {}", entry.path, why));
  }

  /// The diagram itself, and links to files of the folder: these are listed by themselves.
  bool is_listed_elsewhere(const std::string& path) const {
    const std::string real = identity(path);
    return real == diagram_.identity ||
           (real != (fs::path(root_) / path).string() && real.starts_with(root_ + "/"));
  }

  /// Only files that can name a diagram, or what is renamed: large models and their like are not parsed.
  void read_files() {
    std::vector<std::string> words{"\"diagram\"", "\\u"};
    for (const Renaming& renaming : renamings_) words.push_back(split_path(renaming.from).back());
    const std::string file_name = fs::path(diagram_.path).filename().string();
    for (const Folder::File& file : folder_.files()) {
      if (!file.path.ends_with(".json") || is_listed_elsewhere(file.path)) continue;
      std::optional<std::string> text;
      try {
        text = folder_.read(file.path);
      } catch (const Refused&) {  // what cannot be read cannot be used
        continue;
      }
      const auto is_in_text = [&](const std::string& word) { return text->find(word) != text->npos; };
      if (!text || std::ranges::none_of(words, is_in_text)) continue;
      const bool may_name_it = is_in_text(file_name) || file.path.ends_with(".experiment.json");
      Entry entry{file.path, identity(file.path), ParsedText(file.path, std::move(*text)), FileKind::unknown};
      if (entry.parsed.is_object() && !entry.parsed.problems.has_errors()) {
        entry.kind = kind_of(entry.root());
        entries_.push_back(std::move(entry));
      } else if (may_name_it) {
        leave_behind(entry, "is not JSON at present");
      }
    }
  }

  const Entry* find(const std::string& identity) const {
    if (identity == diagram_.identity) return &diagram_;
    const auto found = std::ranges::find(entries_, identity, &Entry::identity);
    return found == entries_.end() ? nullptr : &*found;
  }

  /// What is renamed, as seen from a file; collects the changes of a diagram that contains it.
  const std::vector<Renaming>& renamed_in(Entry& entry) {
    const auto [known, is_new] = renamed_.try_emplace(entry.identity);
    if (!is_new)
      return known->second;  // also while it is computed: a diagram that contains itself is an error
    std::vector<Renaming> seen;
    for (const Inclusion& inclusion : inclusions(entry.root())) {
      const std::string file = identity(*inclusion.file);
      const auto inner = std::ranges::find(entries_, file, &Entry::identity);
      const std::vector<Renaming> renamed = inner != entries_.end()     ? renamed_in(*inner)
                                            : file == diagram_.identity ? renamings_
                                                                        : std::vector<Renaming>();
      if (renamed.empty()) continue;
      follow_in_diagram(entry, inclusion, renamed);
      for (Renaming& renaming : seen_from(path_from(inclusion.path, 0), renamed))
        if (!is_among(renaming, seen)) seen.push_back(std::move(renaming));
    }
    follow_values(entry, entry.root());
    return renamed_[entry.identity] = std::move(seen);
  }
  /// Several variants of a block may be the same file.
  static bool is_among(const Renaming& renaming, const std::vector<Renaming>& list) {
    return std::ranges::any_of(list, [&](const Renaming& other) {
      return other.kind == renaming.kind && other.from == renaming.from && other.to == renaming.to;
    });
  }

  void follow_in_diagram(Entry& entry, const Inclusion& inclusion, const std::vector<Renaming>& renamed) {
    const size_t before = entry.changes.size();
    for (size_t i = 0; i < inclusion.around.size(); ++i) {
      const std::vector<Renaming> seen = seen_from(path_from(inclusion.path, i), renamed);
      add(entry, renamed_in_level(*inclusion.around[i], seen));
    }
    if (entry.changes.size() > before) tell_of_other_variants(entry, inclusion, renamed);
    // The block passes values on by name.
    if (const Value::Member* passed = inclusion.body->find("parameters"))
      for (const Renaming& renaming : renamed)
        if (renaming.kind == Renaming::Kind::parameter)
          if (const Value::Member* own = passed->value.find(renaming.from))
            add(entry, {renamed_member(*own, renaming.to)});
  }

  /// A wire that reads inside a block with variants reads inside all of them.
  void tell_of_other_variants(const Entry& entry, const Inclusion& inclusion,
                              const std::vector<Renaming>& renamed) {
    each_body(*inclusion.block, [&](const Value& body) {
      const Value* inner = subdiagram_of(body);
      if (!inner || &body == inclusion.body) return;
      if (inner->kind == Kind::text) {
        const std::string file = identity(*inner);
        const Entry* other = find(file);
        if (!other || file == identity(*inclusion.file)) return;
        inner = &other->root();
      }
      if (std::ranges::any_of(renamed, [&](const Renaming& renaming) { return begins_in(*inner, renaming); }))
        leave_behind(entry, fmt::format("reads inside \"{}\", another variant of which keeps the old name",
                                        path_from(inclusion.path, 0)));
    });
  }

  /// Numbers that are taken out of the text of the diagram: {"file": "axis.json", "name": "parameters.mass"}.
  void follow_values(Entry& entry, const Value& value) {
    const Value::Member *file = value.find("file"), *name = value.find("name");
    if (file && name && file->value.kind == Kind::text && name->value.kind == Kind::text &&
        identity(file->value) == diagram_.identity) {
      std::string to = name->value.text;
      for (const Renaming& renaming : renamings_) {
        const std::string from = place_in_text(renaming, renaming.from);
        if (to == from || to.starts_with(from + "."))
          to = place_in_text(renaming, renaming.to) + to.substr(from.size());
      }
      if (to != name->value.text) add(entry, {replaced(name->value, in_quotes(to))});
    }
    for (const Value& item : value.items) follow_values(entry, item);
    for (const Value::Member& member : value.members) follow_values(entry, member.value);
  }
  static std::string place_in_text(const Renaming& renaming, const std::string& path) {
    std::string place;
    const std::vector<std::string> parts = split_path(path);
    for (size_t i = 0; i < parts.size(); ++i) {
      const bool is_last = i + 1 == parts.size();
      const bool is_parameter = is_last && renaming.kind == Renaming::Kind::parameter;
      place += (is_parameter ? "parameters." : "blocks.") + parts[i] + (is_last ? "" : ".diagram.");
    }
    return place;
  }

  void follow_in_sweep(Entry& entry) {
    const Value::Member* diagram = entry.root().find("diagram");
    if (!diagram || diagram->value.kind != Kind::text) return;
    const auto renamed = renamed_.find(identity(diagram->value));
    if (renamed == renamed_.end()) return;
    std::vector<std::string> conflicts;
    add(entry, renamed_in_sweep(entry.root(), renamed->second, conflicts));
    for (const std::string& conflict : conflicts) leave_behind(entry, conflict);
  }

  /// An experiment names no diagram: it belongs to all in its folder that have its ports.
  void follow_in_experiment(Entry& entry) {
    const std::vector<std::string> ports = ports_of_experiment(entry.root());
    const auto fits = [&](const Entry& diagram) {
      return fs::path(diagram.path).parent_path() == fs::path(entry.path).parent_path() &&
             std::ranges::all_of(ports, [&](const std::string& port) {
               return has_entry(diagram.root(), "blocks", first_part(port)) ||
                      has_entry(diagram.root(), "inputs", first_part(port));
             });
    };
    std::vector<const Entry*> keeping;
    const auto take = [&](const Entry& diagram) {
      if (!fits(diagram)) return;
      const auto renamed = renamed_.find(diagram.identity);
      std::vector<std::string> conflicts;
      TextChanges changes = renamed == renamed_.end()
                                ? TextChanges()
                                : renamed_in_experiment(entry.root(), renamed->second, conflicts);
      for (const std::string& conflict : conflicts) leave_behind(entry, conflict);
      if (changes.empty())
        keeping.push_back(&diagram);
      else if (entry.changes.empty())
        entry.changes = std::move(changes);
      else if (entry.changes != changes)
        leave_behind(entry, fmt::format("fits \"{}\" too, where the new name is another", diagram.path));
    };
    take(diagram_);
    for (const Entry& other : entries_)
      if (other.kind == FileKind::diagram) take(other);
    if (entry.changes.empty()) return;
    for (const Entry* other : keeping)
      leave_behind(entry, fmt::format("fits \"{}\" too, which keeps the old name", other->path));
  }

  static void add(Entry& entry, TextChanges changes) {
    std::ranges::move(changes, std::back_inserter(entry.changes));
  }

  void finish(Entry& entry) {
    TextChanges& changes = entry.changes;
    if (changes.empty()) return;
    std::ranges::sort(changes, {},
                      [](const TextChange& change) { return std::tie(change.from, change.text); });
    const auto doubled = std::ranges::unique(changes);
    changes.erase(doubled.begin(), doubled.end());
    for (size_t i = 1; i < changes.size(); ++i)
      if (changes[i].from < changes[i - 1].to)
        return leave_behind(entry, "names it in one place with two meanings");
    if (!folder_.is_writable(entry.path)) return leave_behind(entry, "is read-only, or a link");
    const std::string& text = entry.parsed.file->text;
    following_.files.push_back({entry.path, text, applied(text, changes)});
  }

  const Folder& folder_;
  const std::string root_ = identity(std::string());
  const Entry diagram_;
  std::vector<Renaming> renamings_;
  std::vector<Entry> entries_;
  std::map<std::string, std::vector<Renaming>> renamed_;  ///< by identity of the diagram
  Following following_;
};

}  // namespace

Following followers(const Folder& folder, const std::string& path, const std::string& text,
                    const std::vector<Renaming>& renamings) {
  return Search(folder, path, text, renamings).run();
}

}  // namespace loopwright::studio
