/// Ports that a block instance declares in its settings, such as the inputs and outputs of a state machine.
///
/// The description of such a block has one input of type `NamedInputs<Real>` as its last input, or one output
/// of type `NamedOutputs<Real>` as its last output. The block states which ports there are:
///
///     std::vector<InstancePort> input_ports() const;
///     std::vector<InstancePort> output_ports() const;
///
/// In a plan each of them is a scalar port with a name, a unit and a wire of its own.
#pragma once
#include <memory>
#include <string>
#include <vector>

namespace loopwright {

struct BlockType;

struct InstancePort {
  std::string name;
  std::string unit;  ///< as in a description: "m/s", "$name", "?"
  std::string sentence;
};

/// The unit of a number by name that has the unit of the output with this name.
inline constexpr std::string_view unit_of_output = "$*";

/// The type of one instance: named ports are scalar ports, and numbers by the names of outputs have their
/// units. Null if the type has no named ports. The result owns all texts.
std::shared_ptr<const BlockType> instance_type(const BlockType& type, const void* block);

}  // namespace loopwright
