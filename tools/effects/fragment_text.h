/// The blocks of an effect as the text of blocks in a diagram.
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>
#include "tools/effects/effect.h"
#include "tools/effects/effect_values.h"

namespace loopwright {

class FragmentText {
 public:
  /// What the blocks find in the diagram.
  struct Surroundings {
    std::function<std::string(std::string_view role)> wire;  ///< "position" → "mass.position"
    std::function<std::string(std::string_view name)>
        initial;  ///< a setting of the moving mass; may be empty
  };

  FragmentText(const Effect& effect, const EffectValues& values, const MachineUnits& units)
      : effect_(effect), values_(values), units_(units) {}

  /// `base` is the name of the only block, or precedes the names of all.
  void name(std::string base, bool is_only_one) { base_ = std::move(base), is_only_one_ = is_only_one; }
  std::string name_of(const std::string& block) const { return is_only_one_ ? base_ : base_ + "_" + block; }
  /// A block that will have this path. Appends the parameters of the effect that can be set in it.
  std::string block(const Value::Member& block, const std::string& path, const Surroundings& around,
                    std::vector<std::pair<std::string, std::string>>& settings) const;

 private:
  std::string wires(const Value& port, const Surroundings& around) const;
  std::string wire(const Value& wire, const Surroundings& around) const;
  using Settings = std::vector<std::pair<std::string, std::string>>;
  std::string setting(const Value::Member& block, const Value::Member& setting, const std::string& path,
                      const Surroundings& around, Settings& settings) const;
  std::string constants(const Value::Member& block, const std::string& path, Settings& settings) const;
  std::string value(const Value& value, const std::string& path, Settings& settings) const;

  const Effect& effect_;
  const EffectValues& values_;
  const MachineUnits& units_;
  std::string base_;
  bool is_only_one_ = false;
};

}  // namespace loopwright
