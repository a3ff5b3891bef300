/// The readers of a signal, so that a block can be inserted before them.
#pragma once
#include <string>
#include <vector>
#include "tools/effects/nest.h"

namespace loopwright {

struct WireReader {
  const Value::Member* block;
  const Value* wire;  ///< into it
};

/// The port of the block into which the wire leads, as experiments name it: "u", "terms[1]".
std::string port_of(const WireReader& reader);

/// "mass" of "mass.position".
std::string block_of(const std::string& port);

/// Wires from `source` into blocks that lead to the block `target` by the shortest path: an observer that
/// reads the same command still reads the command.
std::vector<WireReader> nearest_readers(const Nest::Level& level, const std::string& source,
                                        const std::string& target);

/// Wires from `source` into all blocks but the mechanics: a force depends on the true position of the
/// machine, not on the measured one.
std::vector<WireReader> readers_but_mechanics(const Nest& nest, const Nest::Level& level,
                                              const std::string& source);

/// From now on the readers read `source`.
void redirect(const Nest::Level& level, const std::vector<WireReader>& readers, const std::string& source);

/// A block of this type that a block reads, else any in its diagram; null if there is none.
const Value::Member* block_before(const Nest::Level& level, const Value::Member& reader,
                                  const std::string& type);

}  // namespace loopwright
