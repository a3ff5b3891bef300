/// Shapes of files as JSON Schema.
#pragma once
#include <nlohmann/json.hpp>
#include "engine/json/file_shape.h"

namespace loopwright {

/// The schema of a value of this shape. It refers to definitions of `common_definitions()` and, for blocks of
/// a diagram, to
/// "#/$defs/block".
nlohmann::ordered_json to_schema(const FileShape& shape);

/// Refers to a definition of the same schema.
nlohmann::ordered_json reference(const std::string& name);

/// Definitions of how numbers may be written.
nlohmann::ordered_json common_definitions();

/// The schema with its name, and with those definitions that it needs, directly or through others.
nlohmann::ordered_json complete_schema(const std::string& title, const nlohmann::ordered_json& schema,
                                       const nlohmann::ordered_json& definitions);

}  // namespace loopwright
