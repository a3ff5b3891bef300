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
  std::string times;  ///< parameter by which the addition is multiplied; empty: none
};

/// Parameters that are added to diagrams, each diagram's together.
class NewParameters {
 public:
  /// An empty unit: a bare number.
  void add(const Nest::Level& level, const std::string& name, double number, const std::string& unit,
           const std::string& description);
  void write() const;

 private:
  struct OfDiagram {
    Nest::Level level;
    std::vector<std::pair<std::string, std::string>> list;  ///< name, text
  };
  std::vector<OfDiagram> diagrams_;
};

enum class ChangedSetting { number, parameter, nothing };

/// Changes the text of a setting in the diagram of `level`. A number is replaced by the sum, in the unit that
/// is written beside it; by an expression if the addition is multiplied by a parameter. An expression becomes
/// "=mass + inertia_mass" with a new parameter of that diagram, which has the unit of the expression's own
/// parameters where one of them has the same dimension. Nothing is changed if the setting is neither, or if
/// its unit has another dimension.
ChangedSetting add_to_setting(const Nest::Level& level, const Value& setting, const SettingChange& change,
                              NewParameters& parameters);

}  // namespace loopwright
