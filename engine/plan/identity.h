/// What made a result: the diagram with its parameters, the contents of every file that was read, the program.
/// Results belong together, and a run can be gone on with, only where all of it is the same.
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
  std::vector<FileRead> files;  ///< besides the diagram itself, which the structure covers; sorted

  /// Of all of it but the names of files, 16 hexadecimal digits: results may move to another folder or machine.
  std::string hash() const;
  /// As recordings and checkpoints carry it: "plan", "plan structure", "build", and "file NAME" for each file.
  Facts facts() const;
};

/// Reads back what Identity::facts() wrote; what is not there stays empty.
Identity identity_of(const Facts& facts);

/// One fact a line, and back. What follows the last line that is a fact is left out.
std::string to_text(const Facts& facts);
Facts facts_of(std::string_view text);

/// In what two identities differ besides the build, a sentence each: `the file "track.csv" has changed`.
std::vector<std::string> changes(const Identity& before, const Identity& now);
/// The same, with the program's build as the last; empty: nothing has changed.
std::string changes_with_build(const Identity& before, const Identity& now);

/// Sorted, each once, named relative to the folder of the diagram.
std::vector<FileRead> named_from(const std::string& diagram, std::vector<FileRead> files);

/// Tells builds of this program apart: the identifier that the linker works out from its contents. The same
/// program has the same build on every machine.
const std::string& program_build();

}  // namespace loopwright
