/// The text of a diagram file under change, with its values.
#pragma once
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>
#include "engine/json/problem.h"
#include "engine/json/value.h"
#include "tools/studio/session/text_change.h"

namespace loopwright::studio {

/// An intent, or another request, that cannot be carried out; nothing was changed.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A JSON text and its values; `root` is null if the text is not JSON, and `problems` say why.
struct ParsedText {
  std::shared_ptr<const SourceFile> file;
  Value root;
  Problems problems;

  ParsedText(const std::string& path, std::string text);
  bool is_object() const { return root.kind == Value::Kind::object; }
};

/// Chosen variants by the path of their block: `--variant`.
using Variants = std::map<std::string, std::string>;

/// A diagram in a file: the outermost one, or a subdiagram that is written inside it.
struct Level {
  const Value* diagram = nullptr;
  std::string inside;                    ///< "stage.motor"; empty: the outermost
  std::vector<const Value*> outer = {};  ///< the diagrams around it, outermost first
  const Value::Member* block(std::string_view name) const;
  const Value& blocks() const;  ///< an empty object if there are none
};

/// The body of a block: that of its active variant if it has several.
const Value& body_of(const Value& block, const std::string& path, const Variants& variants);
std::string variant_of(const Value& block, const std::string& path, const Variants& variants);
/// The subdiagram in a block, as a text (a file) or an object; null for another block.
const Value* subdiagram_of(const Value& body);
/// The text of a member; empty if there is none.
std::string_view text_in(const Value& object, std::string_view name);

/// Throws Refused if `inside` leads to no diagram in this file.
Level find_level(const Value& root, const std::string& inside, const Variants& variants);

/// Collects the changes of several intents: each sees the text that the earlier ones left.
class Draft {
 public:
  Draft(std::string path, std::string text, Variants variants);
  const ParsedText& parsed() const { return *parsed_; }
  const std::string& text() const { return parsed_->file->text; }
  const std::string& path() const { return path_; }
  const Variants& variants() const { return variants_; }
  Level level(const std::string& inside) const { return find_level(parsed_->root, inside, variants_); }
  /// In any order, disjoint.
  void change(TextChanges changes);
  /// From the first text to the present one.
  const TextChanges& changes() const { return changes_; }

 private:
  const std::string path_;
  const Variants variants_;
  const size_t first_size_;
  std::shared_ptr<const ParsedText> parsed_;
  TextChanges changes_;
};

}  // namespace loopwright::studio
