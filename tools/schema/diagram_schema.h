/// The schema of diagrams.
#pragma once
#include <nlohmann/json.hpp>

namespace loopwright {

/// Definitions of blocks, of each block type, and of diagrams ("block", "diagram", "Mass" …), with those of
/// common_definitions().
nlohmann::ordered_json diagram_definitions();

/// A whole diagram, which refers to these definitions.
nlohmann::ordered_json diagram_file_schema();

}  // namespace loopwright
