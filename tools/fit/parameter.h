/// Numbers of a diagram by path: "mass", "stage.payload", "stage.cogging.harmonics.0.amplitude".
#pragma once
#include <optional>
#include "engine/diagram/diagram.h"

namespace loopwright {

struct DiagramNumber {
  double value = 0;          ///< SI
  std::optional<Unit> unit;  ///< scale 1; empty: a bare number
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
};

/// The number that `--set PATH` would change; empty after a problem, which suggests a correction.
std::optional<DiagramNumber> find_number(const Diagram& diagram, const std::string& path, Problems& problems);

/// `--set PATH=VALUE` with a value in SI.
std::pair<std::string, std::string> setting(const std::string& path, const DiagramNumber& number,
                                            double value);

}  // namespace loopwright
