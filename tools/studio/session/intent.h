/// What a user wants changed in a diagram, as changes of its text.
#pragma once
#include <functional>
#include <optional>
#include <set>
#include "tools/studio/session/draft.h"

namespace loopwright::studio {

/// A block or a parameter with another name, or a block in another place. Other files may name it.
struct Renaming {
  enum class Kind { block, parameter };
  Kind kind = Kind::block;
  std::string from, to;  ///< paths: "stage.axis" → "stage.slide"
  // Of the level in which it stands:
  bool has_namesake = false;    ///< of a block: a parameter is called so, too; of a parameter: a block
  bool meets_namesake = false;  ///< the same for the new name
  std::set<std::string> in_scope =
      {};  ///< of a parameter: blocks and parameters whose expressions may use it
};

/// A file that changes together with the diagram: its layout, a sweep, an experiment, a diagram that contains
/// it.
struct OtherFile {
  std::string path;
  std::optional<std::string> before, after;  ///< nothing: there is no file
};

/// What intents do besides changing the text.
struct IntentEffects {
  std::vector<std::string> blocks;  ///< that were added or changed, by path
  std::string what;                 ///< for the list of undo: "set mass"
  /// Positions of the layout file: block path → position, or nothing to forget it.
  std::vector<std::pair<std::string, std::optional<std::pair<double, double>>>> positions;
  std::vector<Renaming> renamed;  ///< in the order in which it was done
};

struct IntentContext {
  std::string inside;
  /// The names of the signals that are recorded now; for a diagram without "log".
  std::function<std::vector<std::string>()> recorded;
  /// The other files that name what is renamed, with the new names. May throw Refused.
  std::function<std::vector<OtherFile>(const std::vector<Renaming>& renamed)> followers = {};
};

/// Carries out an intent (tools/studio/protocol.md). Throws Refused if it cannot be, with nothing changed.
void apply_intent(const Value& intent, const IntentContext& context, Draft& draft, IntentEffects& effects);

// By subject; each returns false for an intent that is not its own.
bool apply_setting_intent(const Value& intent, const IntentContext& context, Draft& draft,
                          IntentEffects& effects);
bool apply_parameter_intent(const Value& intent, const IntentContext& context, Draft& draft,
                            IntentEffects& effects);
bool apply_wire_intent(const Value& intent, const IntentContext& context, Draft& draft,
                       IntentEffects& effects);
bool apply_block_intent(const Value& intent, const IntentContext& context, Draft& draft,
                        IntentEffects& effects);
bool apply_name_intent(const Value& intent, const IntentContext& context, Draft& draft,
                       IntentEffects& effects);
bool apply_wrap_intent(const Value& intent, const IntentContext& context, Draft& draft,
                       IntentEffects& effects);
bool apply_text_intent(const Value& intent, Draft& draft, IntentEffects& effects);

// ---- Shared ----

/// A text that an intent must have. Throws Refused.
std::string required_text(const Value& intent, std::string_view name);
/// A whole number; `otherwise` if there is none.
int64_t optional_whole(const Value& intent, std::string_view name, int64_t otherwise);
/// The texts of a list. Throws Refused if there is none.
std::vector<std::string> required_texts(const Value& intent, std::string_view name);
/// A block of a level. Throws Refused.
const Value::Member& required_block(const Level& level, const std::string& name);
/// Throws Refused unless it is a name that no other block has.
void require_free_name(const Level& level, const std::string& name);
std::string free_name(const Level& level, const std::string& wanted);
/// A member of the diagram itself, added in the usual order of a file if it is not there.
TextChange with_top_member(const Value& diagram, const std::string& name, const std::string& value);

/// Entries of an object or a list that are left out together.
TextChanges without_entries(const Value& value, const std::vector<bool>& leave_out);

}  // namespace loopwright::studio
