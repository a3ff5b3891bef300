#include "tools/studio/session/document.h"
#include <fmt/format.h>
#include <algorithm>
#include <ranges>
#include <utility>
#include "engine/json/reader.h"

namespace loopwright::studio {
namespace {

constexpr size_t most_steps = 1000, longest_history = 500;

bool is_json(const std::string& text) { return !ParsedText("", text).problems.has_errors(); }

bool is_typed(const Value& intent) { return required_text(intent, "intent") == "text"; }

}  // namespace

Document::Document(const Folder& folder, std::string path) : folder_(folder), path_(std::move(path)) {
  on_disk_ = folder_.read(path_);
  if (!on_disk_) throw Refused(fmt::format("there is no file \"{}\"", path_));
  text_ = *on_disk_;
  layout_ = read_layout(folder_.read(layout_path(path_)));
}

bool Document::look() {
  layout_ = read_layout(folder_.read(layout_path(path_)));
  const std::optional<std::string> now = folder_.read(path_);
  if (now == on_disk_) return false;
  if (!now) {  // removed: the next edit writes it again
    on_disk_.reset();
    accept(text_, {});
    return true;
  }
  take_from_outside(*now);
  return true;
}

/// Unsaved changes are made to the new text if they touch other lines; otherwise a person decides.
void Document::take_from_outside(const std::string& theirs) {
  const bool was_saved = is_saved() || !on_disk_;
  const std::optional<std::string> base = on_disk_;
  on_disk_ = theirs;
  if (was_saved || !base) {
    conflict_.reset();
    step({"change from outside", difference(text_, theirs), {}, {}}, undo_);
    redo_.clear();  // its places are those of the text before
    return;
  }
  const auto mine = rebased(difference(*base, text_), difference(*base, theirs));
  if (!mine || conflict_) {
    conflict_ = theirs;
    if (theirs == text_) conflict_.reset();
    accept(text_, {});
    return;
  }
  const std::string merged = applied(theirs, *mine);
  step({"change from outside", difference(text_, merged), {}, {}}, undo_);
  redo_.clear();
  if (is_json(merged)) write(merged);
}

void Document::write(const std::string& text) {
  for (int attempt = 0; attempt < 5; ++attempt) {
    const auto found = folder_.replace(path_, on_disk_, text);
    if (!found) {
      on_disk_ = text;
      return;
    }
    if (found->text != on_disk_)
      throw ChangedMeanwhile(fmt::format("\"{}\" was changed by another program at the same moment", path_));
  }
  throw Refused(fmt::format("\"{}\" is being written by another program", path_));
}

/// All of them or none.
void Document::write_others(const std::vector<OtherFile>& others) const {
  std::vector<OtherFile> written;
  try {
    for (const OtherFile& other : others) {
      write_other(other);
      written.push_back({other.path, other.after, other.before});
    }
  } catch (...) {
    for (const OtherFile& other : written | std::views::reverse) {
      try {
        write_other(other);
      } catch (const Refused&) {  // changed by another program since: its text stays
      }
    }
    throw;
  }
}

void Document::write_other(const OtherFile& other) const {
  const std::optional<std::string> now = folder_.read(other.path);
  if (now == other.after) return;
  if (now == other.before && !other.after) return folder_.remove(other.path, *now);
  // Another program changed it in other places: these stay.
  std::string text = other.after.value_or("");
  if (now && other.before && *now != *other.before) {
    const auto changes = rebased(difference(*other.before, text), difference(*other.before, *now));
    if (!changes)
      throw Refused(fmt::format("\"{}\" was changed in the same place by another program", other.path));
    text = applied(*now, *changes);
  } else if (now != other.before) {
    throw Refused(fmt::format("\"{}\" was created or removed by another program", other.path));
  }
  if (folder_.replace(other.path, now, text))
    throw Refused(fmt::format("\"{}\" was changed by another program at the same moment", other.path));
}

void Document::accept(const std::string& text, const TextChanges& changes) {
  history_.push_back({changes, inverse(text_, changes)});
  if (history_.size() > longest_history) history_.pop_front();
  text_ = text;
  ++revision_;
}

/// Writes and takes over; with nothing changed after an exception.
Edited Document::step(const Step& done, std::vector<Step>& to) {
  Edited edited{done.changes, text_, {}, done.others, done.renamed};
  const std::string text = applied(text_, edited.changes);
  Step reverse{done.what, inverse(text_, edited.changes), edited.others, {}};
  for (OtherFile& other : reverse.others) std::swap(other.before, other.after);
  for (const Renaming& renaming : edited.renamed | std::views::reverse)
    reverse.renamed.push_back({renaming.kind, renaming.to, renaming.from});
  write_others(edited.others);
  try {
    if ((!on_disk_ || text != *on_disk_) && is_json(text) && !conflict_) write(text);
  } catch (...) {
    write_others(reverse.others);
    throw;
  }
  to.push_back(std::move(reverse));
  if (to.size() > most_steps) to.erase(to.begin());
  accept(text, edited.changes);
  layout_ = read_layout(folder_.read(layout_path(path_)));
  return edited;
}

/// What was typed in the text of an earlier revision, as changes of the present one.
TextChanges Document::typed_in(const std::vector<Value>& intents, int64_t seen) const {
  const int64_t missed = revision_ - seen;
  if (missed < 0 || size_t(missed) > history_.size())
    throw Refused("the page shows a revision that is too old: load it again");
  const size_t first = history_.size() - size_t(missed);
  std::string then = text_;
  for (size_t i = history_.size(); i-- > first;) then = applied(then, history_[i].reverse);
  TextChanges since;
  for (size_t i = first; i < history_.size(); ++i) since = composed(then.size(), since, history_[i].changes);
  Draft draft(path_, then, {});
  IntentEffects effects;
  for (const Value& intent : intents)
    if (!apply_text_intent(intent, draft, effects))
      throw Refused("text and canvas cannot be changed in one step");
  const auto changes = rebased(draft.changes(), since);
  if (!changes) throw Refused("the text was changed in the same place at the same moment: type it again");
  return *changes;
}

OtherFile Document::with_positions(const IntentEffects& effects) const {
  OtherFile file{layout_path(path_), folder_.read(layout_path(path_)), {}};
  Layout layout = read_layout(file.before);
  for (const auto& [block, position] : effects.positions) {
    if (position)
      layout[block] = *position;
    else
      std::erase_if(layout, [&](const auto& entry) {
        return entry.first == block || entry.first.starts_with(block + ".");
      });
  }
  for (const Renaming& renaming : effects.renamed) {
    if (renaming.kind != Renaming::Kind::block) continue;
    const std::string &from = renaming.from, &to = renaming.to;
    Layout renamed;
    for (const auto& [block, position] : layout) {
      const bool is_inside = block == from || block.starts_with(from + ".");
      renamed[is_inside ? to + block.substr(from.size()) : block] = position;
    }
    layout = std::move(renamed);
  }
  file.after = layout_text(layout);
  if (!file.after && file.before) file.after = "{\"positions\": {}}\n";
  return file;
}

void Document::apply(const std::vector<Value>& intents, const IntentContext& context, Draft& draft,
                     IntentEffects& effects) const {
  for (const Value& intent : intents) {
    if (required_text(intent, "intent") != "move") {
      const std::string before = effects.what;
      apply_intent(intent, context, draft, effects);
      if (!before.empty()) effects.what = before;
      continue;
    }
    const Value::Member* positions = intent.find("positions");
    if (!positions || positions->value.kind != Value::Kind::object) throw Refused("there are no positions");
    for (const Value::Member& block : positions->value.members) {
      const std::vector<Value>& xy = block.value.items;
      const bool is_position =
          xy.size() == 2 && xy[0].kind == Value::Kind::number && xy[1].kind == Value::Kind::number;
      effects.positions.push_back({joined(context.inside, block.name), std::nullopt});
      if (is_position) effects.positions.back().second = std::pair(xy[0].number, xy[1].number);
    }
    if (effects.what.empty()) effects.what = "move";
  }
}

Edited Document::edit(const std::vector<Value>& intents, const IntentContext& context,
                      const Variants& variants, int64_t seen) {
  Draft draft(path_, text_, variants);
  IntentEffects effects;
  if (seen != revision_ && std::ranges::any_of(intents, is_typed))
    draft.change(typed_in(intents, seen)), effects.what = "type";
  else
    apply(intents, context, draft, effects);
  std::vector<OtherFile> others;
  const auto is_block = [](const Renaming& renaming) { return renaming.kind == Renaming::Kind::block; };
  if (!effects.positions.empty() || std::ranges::any_of(effects.renamed, is_block)) {
    OtherFile layout = with_positions(effects);
    if (layout.before != layout.after) others.push_back(std::move(layout));
  }
  if (!effects.renamed.empty() && context.followers)
    std::ranges::move(context.followers(effects.renamed), std::back_inserter(others));
  if (draft.text() == text_ && others.empty()) return {{}, text_, effects.blocks, {}, {}};
  Edited edited = step({effects.what, draft.changes(), std::move(others), effects.renamed}, undo_);
  redo_.clear();
  edited.blocks = effects.blocks;
  return edited;
}

Edited Document::take(const std::string& what, const std::string& text, std::vector<OtherFile> others,
                      std::vector<std::string> blocks) {
  Edited edited = step({what, difference(text_, text), std::move(others), {}}, undo_);
  redo_.clear();
  edited.blocks = std::move(blocks);
  return edited;
}

Edited Document::back(std::vector<Step>& from, std::vector<Step>& to) {
  if (from.empty()) throw Refused("there is nothing to undo");
  const Step last = from.back();
  Edited edited = step(last, to);
  from.pop_back();
  return edited;
}

Edited Document::undo() { return back(undo_, redo_); }
Edited Document::redo() { return back(redo_, undo_); }

Edited Document::resolve(std::string text) {
  const std::optional<std::string> conflict = std::exchange(conflict_, std::nullopt);
  try {
    return take("resolve the conflict", text, {}, {});
  } catch (...) {
    conflict_ = conflict;
    throw;
  }
}

}  // namespace loopwright::studio
