/// The vendor's error numbers: their names, and the kind of status of each.
#pragma once
#include <cstdint>
#include <string_view>
#include "hw/device/status.h"

namespace loopwright::hw::quanser {

/// "BUFFER_OVERFLOW" for -111 (or 111); empty: unknown.
std::string_view error_name(int32_t code);
/// The kind of a negative result. `while_open`: a board that is now not found was present before.
Code classify(int32_t code, bool while_open);
/// A "not supported" error: the board or its driver lacks the function.
bool is_not_supported(int32_t code);

}  // namespace loopwright::hw::quanser
