/// What a plan keeps of the blocks' settings as the diagram has them. It is gathered when a block is read: in
/// a large diagram, settings that are looked at again come from memory again.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include "engine/block/registry.h"
#include "engine/diagram/diagram.h"

namespace loopwright {

/// A number that was written with a unit, or comes from a parameter with one, or is bare where bare numbers
/// have none. Points into the diagram.
struct NumberWithUnit {
  int block;                  ///< flat
  const ParameterInfo* info;  ///< of the number, also inside a list or an object
  std::string_view name;      ///< of the parameter that holds it
  const Value* value;         ///< null: left out

  Unit unit() const { return value && value->unit ? *value->unit : Unit{}; }
};

struct Settings {
  std::vector<std::pair<std::string, std::string>> effective;  ///< path → value with unit
  std::vector<NumberWithUnit> with_units;                      ///< block by block, and without units too

  /// The parameters of a diagram.
  void add(const std::vector<Parameter>& parameters);
  /// Every setting of a block as evaluated, and the defaults of what was left out.
  void add(int block, const BlockType& type, const BlockEntry& entry, const std::string& path);

 private:
  void add_numbers(int block, const ParameterInfo& info, std::string_view name, const Value& value,
                   bool bare_is_plain);
};

}  // namespace loopwright
