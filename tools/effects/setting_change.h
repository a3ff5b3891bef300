/// Adds a fitted number to a setting of a block, as its author wrote it.
#pragma once
#include <string>
#include "tools/effects/nest.h"

namespace loopwright {

struct SettingChange {
  double add = 0;         ///< SI
  std::string unit;       ///< its quantity, such as "kg"; empty: that to which it is added
  std::string parameter;  ///< name of the new parameter if the setting is an expression
  std::string description;
};

enum class ChangedSetting { number, parameter, nothing };

/// Changes the text of a setting in the diagram of `level`. A number is replaced by the sum, in the unit that
/// is written beside it. An expression becomes "=mass + inertia_mass" with a new parameter of that diagram,
/// which has the unit of the expression's own parameters where one of them has the same dimension. Nothing is
/// changed if the setting is neither, or if its unit has another dimension.
ChangedSetting add_to_setting(const Nest::Level& level, const Value& setting, const SettingChange& change);

}  // namespace loopwright
