/// The inputs that determine a result: the diagram with its parameters, the contents of every file that was
/// read, the program. Results are comparable, and a run can be continued, only if all of them are the same.
#pragma once
#include <span>
#include <string>
#include <utility>
#include <vector>
#include "engine/json/problem.h"

namespace loopwright {

using Facts = std::vector<std::pair<std::string, std::string>>;

struct Identity {
  std::string structure;        ///< hash of the plan's blocks, wires, times and effective parameters
  std::string build;            ///< of the program, as program_build() gives it
  std::vector<FileRead> files;  ///< sorted; without the diagram itself, which the structure covers

  /// Hash of everything, 16 hexadecimal digits. The names of files are relative to the diagram: results may
  /// move with its folder, and to another machine.
  std::string hash() const;
  /// As in recordings and checkpoints: "plan", "plan structure", "build", and "file NAME" for each file.
  Facts facts() const;
};

/// Reads back the output of Identity::facts(); missing facts give empty members.
Identity identity_of(const Facts& facts);

/// One fact per line, and back. Text after the last line that is a fact is ignored.
std::string to_text(const Facts& facts);
Facts facts_of(std::string_view text);

/// The differences between two identities except the build, one sentence each: `the file "track.csv" has
/// changed`.
std::vector<std::string> changes(const Identity& before, const Identity& now);
/// The same, followed by the build of the program; empty: no change.
std::string changes_with_build(const Identity& before, const Identity& now);

/// Sorted, without duplicates, with names relative to the folder of the diagram.
std::vector<FileRead> named_from(const std::string& diagram, std::vector<FileRead> files);

/// Distinguishes builds of this program: the identifier that the linker computes from its contents. The same
/// program has the same build on every machine.
const std::string& program_build();

}  // namespace loopwright
