/// Ports by name, as something to add a signal to or to look at.
#pragma once
#include <string>
#include <vector>
#include "engine/plan/plan.h"

namespace loopwright {

/// One number on a port.
struct PortNumber {
  std::string name;                          ///< "stage.position", with [i] where a port has several
  Number number;                             ///< what the block computes there, or what feeds it
  bool is_output = false;                    ///< everybody who reads the number reads this port
  std::vector<std::pair<int, int>> readers;  ///< of an input: block, and which of the numbers that it reads
};

/// The numbers of a port of a block or of a subdiagram, "command.terms[1]" being one of several. Unknown
/// names go to `problems`, with what may have been meant.
std::vector<PortNumber> find_port(const Plan& plan, const std::string& port, Problems& problems);

}  // namespace loopwright
