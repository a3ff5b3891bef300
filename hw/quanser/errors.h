/// The vendor's error numbers: names, and which kind of status each is.
#pragma once
#include <cstdint>
#include <string_view>
#include "hw/device/status.h"

namespace loopwright::hw::quanser {

/// "BUFFER_OVERFLOW" for -111 (or 111); empty: not known.
std::string_view error_name(int32_t code);
/// The kind of a negative result. `while_open`: a board that is not found has been there before.
Code classify(int32_t code, bool while_open);
/// One of the "not supported" answers: the board or its driver does not have the function.
bool is_not_supported(int32_t code);

}  // namespace loopwright::hw::quanser
