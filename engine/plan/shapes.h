/// How wide every port is, and blocks on vectors taken apart into blocks on scalars.
#pragma once
#include "engine/plan/flatten.h"
#include "engine/plan/plan.h"

namespace loopwright {

/// Works out FlatBlock::width and output_lengths from the wires; clashes are problems.
void find_shapes(FlatDiagram& flat, Problems& problems);

/// Elements that a wire carries.
int length_of(const FlatDiagram& flat, const FlatWire& wire);

/// Fills Plan::blocks with one block an element, gives every output its numbers, and wires the inputs.

class Layout {
 public:
  Layout(const FlatDiagram& flat, Plan& plan);
  std::vector<Number> numbers_of(const FlatWire& wire) const;

 private:
  std::optional<Number> scalar_of(const FlatWire& wire) const;
  void add_blocks();
  void number_constants_and_states();
  void list_scalars();
  void wire_inputs();
  void wire_port(Plan::Block& block, const FlatBlock& flat, size_t port, int element);
  std::vector<Number> contiguous(std::vector<Number> numbers, const std::string& reader);
  const FlatDiagram& flat_;
  Plan& plan_;
  std::vector<int> first_instance_;  ///< of each flat block
  /// Of scalar ports of blocks that stand once, which most are: every wire asks for its number, and finds it
  /// here sooner than in the blocks.
  std::vector<std::optional<Number>> scalars_;
  std::vector<size_t> first_scalar_;  ///< of each flat block
};

}  // namespace loopwright
