/// Changes of an open diagram, and what follows them in other files.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include "tools/studio/session/copied_blocks.h"
#include "tools/studio/session/followers.h"
#include "tools/studio/session/session.h"

namespace loopwright::studio {

using Kind = Value::Kind;

namespace {

/// The blocks of a level that were changed, or that contain a change.
std::set<std::string> names_in_level(const std::vector<std::string>& paths, const std::string& inside) {
  std::set<std::string> names;
  const std::string prefix = inside.empty() ? "" : inside + ".";
  for (const std::string& path : paths)
    if (path.starts_with(prefix))
      names.insert(path.substr(prefix.size(), path.find('.', prefix.size()) - prefix.size()));
  return names;
}

Json edits_json(const Edited& edited) {
  const Utf16 places(edited.before);
  Json list = Json::array();
  for (const TextChange& change : edited.changes)
    list.push_back(
        {{"from", places.units(change.from)}, {"to", places.units(change.to)}, {"text", change.text}});
  return list;
}

Json others_json(const Edited& edited) {
  Json list = Json::array();
  for (const OtherFile& other : edited.others)
    if (!other.path.ends_with(".layout.json"))
      list.push_back({{"path", other.path}, {"text", other.after.value_or("")}});
  return list;
}

Json renamed_json(const Edited& edited) {
  Json list = Json::array();
  for (const Renaming& renaming : edited.renamed)
    list.push_back({{"kind", renaming.kind == Renaming::Kind::block ? "block" : "parameter"},
                    {"from", renaming.from},
                    {"to", renaming.to}});
  return list;
}

/// Throws NeedsConsent if something keeps the old name, unless that is accepted.
std::vector<OtherFile> following_files(const Folder& folder, const Document& document,
                                       const std::vector<Renaming>& renamed, bool despite_others) {
  Following following = followers(folder, document.path(), document.text(), renamed);
  if (!following.left_behind.empty() && !despite_others)
    throw NeedsConsent(fmt::format("{} cannot follow everywhere: {}.",
                                   renamed.size() == 1 ? "The new name" : "The new places",
                                   fmt::join(following.left_behind, "; ")));
  return std::move(following.files);
}

}  // namespace

Json Session::changed(const Request& request, const std::function<Edited(Document&)>& change) {
  constexpr int most_attempts = 5;
  Document& changed = document(request.required("path"));
  for (int attempt = 1;; ++attempt) {
    if (changed.look()) tell_others(changed, 0);
    try {
      const Edited edited = change(changed);
      Seen& seen = seen_[request.client][changed.path()];
      Json answer{{"edits", edits_json(edited)},
                  {"document", nullptr},
                  {"blocks", names_in_level(edited.blocks, seen.inside)},
                  {"others", others_json(edited)},
                  {"renamed", renamed_json(edited)}};
      tell_others(changed, request.client);
      answer["document"] = document_json(changed, seen, false);  // last: what it says was sent is sent
      return answer;
    } catch (const ChangedMeanwhile&) {
      if (attempt == most_attempts) throw;
    }
  }
}

std::vector<std::string> Session::recorded(const Document& document, const LoadOptions& options) const {
  const CheckedText text = check_text(folder_.path_of(document.path()), document.text(), options);
  std::vector<std::string> names;
  if (text.checked.plan)
    for (const Plan::Logged& logged : text.checked.plan->log) names.push_back(logged.name);
  return names;
}

Json Session::edit(const Request& request) {
  const Value* intents = request.find("intents");
  if (!intents || intents->kind != Kind::list || intents->items.empty())
    throw Refused("there are no intents");
  const std::string path = request.required("path");
  Seen& seen = seen_[request.client][path];
  if (request.find("variants")) seen.variants = request.text_map("variants");
  if (request.find("inside")) seen.inside = request.text("inside");
  const int64_t revision = request.whole("revision", -1);
  const bool despite_others = request.flag("despite_others");
  return changed(request, [&](Document& document) {
    LoadOptions options;
    options.variants = seen.variants;
    const IntentContext context{seen.inside, [&] { return recorded(document, options); },
                                [&](const std::vector<Renaming>& renamed) {
                                  return following_files(folder_, document, renamed, despite_others);
                                }};
    return document.edit(intents->items, context, seen.variants,
                         revision < 0 ? document.revision() : revision);
  });
}

Json Session::undo(const Request& request) {
  return changed(request, [](Document& document) { return document.undo(); });
}

Json Session::redo(const Request& request) {
  return changed(request, [](Document& document) { return document.redo(); });
}

Json Session::resolve(const Request& request) {
  const std::string keep = request.required("keep");
  return changed(request, [&](Document& document) {
    if (!document.conflict()) throw Refused("there is no conflict");
    if (keep == "theirs") return document.resolve(*document.conflict());
    if (keep == "mine") return document.resolve(document.text());
    if (keep == "text") return document.resolve(request.required("text"));
    throw Refused("\"keep\" is mine, theirs or text");
  });
}

Json Session::copy(const Request& request) {
  const std::string path = request.required("path");
  const Seen& seen = seen_[request.client][path];
  const ParsedText parsed(path, document(path).text());
  const Level level = find_level(parsed.root, request.text("inside"), seen.variants);
  return {{"text", copied_blocks(level, request.texts("blocks"))}};
}

}  // namespace loopwright::studio
