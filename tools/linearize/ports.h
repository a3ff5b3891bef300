/// Ports by name, as points at which to add a signal or to read one.
#pragma once
#include <string>
#include <vector>
#include "engine/plan/plan.h"

namespace loopwright {

/// One number on a port.
struct PortNumber {
  std::string name;                          ///< "stage.position", with [i] if a port has several
  Number number;                             ///< the output of the block there, or what feeds it
  bool is_output = false;                    ///< all readers of the number read this port
  std::vector<std::pair<int, int>> readers;  ///< of an input: block, and index among the numbers it reads
};

/// The numbers of a port of a block or of a subdiagram, "command.terms[1]" being one of several. Unknown
/// names are reported to `problems`, with similar names.
std::vector<PortNumber> find_port(const Plan& plan, const std::string& port, Problems& problems);

}  // namespace loopwright
