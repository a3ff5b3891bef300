/// Where a diagram may lack something: ports at which a term can be added. Nothing else is needed: a
/// distortion of a signal is a term that depends on the signal itself.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"
#include "engine/plan/plan.h"
#include "tools/diagnose/predict/quantity.h"

namespace loopwright::diagnosis {

struct Site {
  enum class Kind {
    sum,     ///< an additional term of a Sum
    shared,  ///< the output of a block that several Sums read: a term acts in each of them, as a coupling
    input,   ///< a recorded input
    block,   ///< the output of a block with states of its own, such as a valve or an amplifier
    wire,    ///< the input of a block with states that no Sum feeds
    sensor,  ///< a compared output: a term there changes what is measured and nothing else
  };
  Kind kind = Kind::sum;
  std::string name;  ///< the port at which the term acts, "axis.net_force.sum"; that of a sensor says so
  std::string
      term_block;  ///< path of the block of the rewritten diagram that provides the term; none at a sensor
  std::string own_signal;  ///< the distorted port; empty at a Sum
  std::optional<Unit> unit;
  Quantity quantity = Quantity::other;
  bool is_searched = true;  ///< the experiment may limit the search

  bool is_sensor_not_looked_at() const { return kind == Kind::sensor && !is_searched; }
};

/// The diagram with a block at every site, whose output is added there. The blocks are ExternalSignals of
/// value zero: the diagram behaves as before. `plan` is that of the diagram.
std::shared_ptr<const Diagram> with_sites(const Diagram& diagram, const Plan& plan, std::vector<Site>& sites);

}  // namespace loopwright::diagnosis
