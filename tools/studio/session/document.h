/// An open diagram file: its text, its revisions, one list of undo, and changes that others make to the file.
#pragma once
#include <deque>
#include <optional>
#include "tools/studio/session/folder.h"
#include "tools/studio/session/intent.h"
#include "tools/studio/session/layout_file.h"

namespace loopwright::studio {

/// Another program changed the file at the same moment: read it again, and try again.
struct ChangedMeanwhile : Refused {
  using Refused::Refused;
};

/// What a step changed, for the page.
struct Edited {
  TextChanges changes;              ///< of the text before
  std::string before;               ///< the text before
  std::vector<std::string> blocks;  ///< that were added or changed
  std::vector<OtherFile> others;
  std::vector<Renaming> renamed;
};

class Document {
 public:
  /// Throws Refused if the file cannot be read.
  Document(const Folder& folder, std::string path);

  const std::string& path() const { return path_; }
  const std::string& text() const { return text_; }
  int64_t revision() const { return revision_; }
  bool is_saved() const { return on_disk_ && *on_disk_ == text_; }
  /// The text of the file that conflicts with the unsaved one.
  const std::optional<std::string>& conflict() const { return conflict_; }
  const Layout& layout() const { return layout_; }
  std::string undo_text() const { return undo_.empty() ? "" : undo_.back().what; }
  std::string redo_text() const { return redo_.empty() ? "" : redo_.back().what; }

  /// Reads the file again. True if it was changed by another program: that is a step of its own.
  bool look();

  /// Carries out intents as one step, and writes the file if the text is JSON. `seen`: the revision that
  /// the page saw. Throws Refused with nothing changed. Like every change, it throws ChangedMeanwhile if the
  /// file is not as it was when it was last looked at.
  Edited edit(const std::vector<Value>& intents, const IntentContext& context, const Variants& variants,
              int64_t seen);
  /// A new text, together with other files, as one step.
  Edited take(const std::string& what, const std::string& text, std::vector<OtherFile> others,
              std::vector<std::string> blocks);
  Edited undo();
  Edited redo();
  /// Ends a conflict with this text.
  Edited resolve(std::string text);  ///< a copy: it may be that of the conflict, which ends here

 private:
  struct Step {
    std::string what;
    TextChanges changes;  ///< that undo or repeat it
    std::vector<OtherFile> others;
    std::vector<Renaming> renamed;
  };

  /// A revision, and what leads back to the one before.
  struct Revision {
    TextChanges changes, reverse;
  };

  /// `done`: changes and others, and what they rename.
  Edited step(const Step& done, std::vector<Step>& to);
  Edited back(std::vector<Step>& from, std::vector<Step>& to);
  void apply(const std::vector<Value>& intents, const IntentContext& context, Draft& draft,
             IntentEffects& effects) const;
  void take_from_outside(const std::string& theirs);
  void write(const std::string& text);
  void write_others(const std::vector<OtherFile>& others) const;
  void write_other(const OtherFile& other) const;
  void accept(const std::string& text, const TextChanges& changes);
  TextChanges typed_in(const std::vector<Value>& intents, int64_t seen) const;
  OtherFile with_positions(const IntentEffects& effects) const;

  const Folder& folder_;
  const std::string path_;
  std::string text_;
  std::optional<std::string> on_disk_;  ///< as last read or written
  std::optional<std::string> conflict_;
  Layout layout_;
  int64_t revision_ = 1;
  std::deque<Revision> history_;  ///< the last ones
  std::vector<Step> undo_, redo_;
};

}  // namespace loopwright::studio
