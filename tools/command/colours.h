/// Colours of messages on a terminal.
#pragma once
#include <string>
#include <string_view>

namespace loopwright {

/// Whether stderr is a terminal that shows colours: not with NO_COLOR set (https://no-color.org), nor with
/// TERM=dumb.
bool has_colours();

/// Messages with control sequences: "error:" red, "warning:" yellow, the names of their further lines cyan.
/// `text` must be printable, so that no other sequence is in it.
std::string coloured(std::string_view text);

}  // namespace loopwright
