/// An additional term in the sum of forces, whose value the caller sets.
#pragma once
#include "engine/diagram/diagram.h"

namespace loopwright::diagnosis {

/// Name of the added block; its output is "y".
inline constexpr const char* injected_force = "injected force";

/// The diagram with a Constant of that name beside the Sum that computes the port, as an additional + term of
/// it. Also the path of the Sum's parent, "" at the top or "axis.". Null, with a problem, if the port is not
/// that of a Sum.
std::shared_ptr<const Diagram> with_injected_force(const Diagram& diagram, const std::string& port,
                                                   const Place& place, Problems& problems,
                                                   std::string& parent);

}  // namespace loopwright::diagnosis
