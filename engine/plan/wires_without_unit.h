/// Wires whose unit is not determined by the diagram.
#pragma once
#include <string>
#include <vector>
#include "engine/json/problem.h"

namespace loopwright {

struct WiresWithoutUnit {
  struct Wire {
    std::string output;  ///< "gain.y"
    Place place;         ///< of its block
  };
  static constexpr size_t most_named = 200;
  size_t count = 0;
  std::vector<Wire> named;  ///< the first of them
};

/// "3 wires without a unit: push.y, net_force.sum, mass.position"; empty if there are none.
std::string to_string(const WiresWithoutUnit& wires);

/// Reports an error for each of them, for --strict-units.
void refuse(const WiresWithoutUnit& wires, Problems& problems);

}  // namespace loopwright
