/// Diagrams that a program created or changed without writing them to a file.
#pragma once
#include "engine/diagram/diagram.h"

namespace loopwright {

/// Reads a diagram from its JSON value, as `load_diagram` does from a file. `path` is the file that it would
/// be: files named in the diagram are relative to the folder of the file in which the name stands.
std::shared_ptr<const Diagram> read_diagram(const Value& root, const std::string& path,
                                            const LoadOptions& options, Problems& problems);

/// Reads a diagram file whose text is in memory, as `load_diagram` reads it once it is written.
std::shared_ptr<const Diagram> load_diagram_text(const std::shared_ptr<const SourceFile>& file,
                                                 const LoadOptions& options, Problems& problems);

}  // namespace loopwright
