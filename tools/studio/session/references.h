/// Names of a diagram in other files: how they follow when a block or a parameter gets another name.
#pragma once
#include <set>
#include <string>
#include <vector>
#include "engine/json/value.h"
#include "tools/studio/session/intent.h"

namespace loopwright::studio {

/// Renamings as a file sees them that has the diagram at a path: "axis" → "slide" is "x.axis" → "x.slide" at
/// "x".
std::vector<Renaming> seen_from(const std::string& path, const std::vector<Renaming>& renamings);

/// New names for the texts by which files refer to a diagram. A text that refers to nothing renamed stays.
class NewNames {
 public:
  explicit NewNames(const std::vector<Renaming>& renamings) : renamings_(renamings) {}

  /// Of a port, an element of it, or a pattern: "axis.position", "axis.y[2]", "axis.*".
  std::string signal(std::string name) const;
  /// Of a formula over signals that begins with '=', or of a signal.
  std::string metric(const std::string& text) const;
  /// Of a block: the path of a choice among variants.
  std::string block(std::string path) const;
  /// Of what `--set` takes: "payload", "axis.mass". `conflict`: why it cannot follow; empty: it can.
  std::string setting(std::string path, std::string& conflict) const;

 private:
  const std::vector<Renaming>& renamings_;
};

// The changes of the text of a file, unsorted. `conflicts`: what cannot follow, as sentences without a
// subject.
TextChanges renamed_in_sweep(const Value& sweep, const std::vector<Renaming>& renamings,
                             std::vector<std::string>& conflicts);
TextChanges renamed_in_experiment(const Value& experiment, const std::vector<Renaming>& renamings,
                                  std::vector<std::string>& conflicts);
/// Wires, outputs and records of one level of a diagram, without the diagrams inside it.
TextChanges renamed_in_level(const Value& diagram, const std::vector<Renaming>& renamings);

}  // namespace loopwright::studio
