/// The parts of the block settings that a plan needs. They are collected when a block is read: in a large
/// diagram, reading the settings a second time would load them from memory again.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include "engine/block/registry.h"
#include "engine/diagram/diagram.h"

namespace loopwright {

/// A number written with a unit, or from a parameter with a unit, or a bare number where bare numbers are
/// dimensionless. Points into the diagram.
struct NumberWithUnit {
  int block;                  ///< index of the flat block
  const ParameterInfo* info;  ///< of the number, which may be inside a list or an object, or one of several
  std::string_view name;      ///< of the parameter that has it
  const Value* value;         ///< null: omitted

  Unit unit() const { return value && value->unit ? *value->unit : Unit{}; }
};

struct Settings {
  std::vector<std::pair<std::string, std::string>> effective;  ///< path → value with unit
  std::vector<NumberWithUnit> with_units;                      ///< by block; includes those without units

  /// Adds the parameters of a diagram.
  void add(const std::vector<Parameter>& parameters);
  /// Adds every evaluated setting of a block, and the defaults of omitted ones.
  void add(int block, const BlockType& type, const Value& settings, const std::string& path);

 private:
  void add_numbers(int block, const ParameterInfo& info, std::string_view name, const Value& value,
                   bool bare_is_plain);
};

}  // namespace loopwright
