/// The keys of device files, for their reader and for the JSON Schema.
#pragma once
#include <utility>
#include <vector>
#include "engine/json/file_shape.h"

namespace loopwright::hw {

/// One alternative for each driver: its name, and the shape of its settings.
FileShape device_shape(const std::vector<std::pair<std::string_view, FileShape>>& drivers);

}  // namespace loopwright::hw
