/// Assigns every number of a run its index: blocks on vectors are split into blocks on scalars, wires become
/// numbers.
#pragma once
#include "engine/plan/flatten.h"
#include "engine/plan/plan.h"

namespace loopwright {

/// Fills Plan::blocks with one block for each element, assigns every output its numbers, and connects the
/// inputs.
class Layout {
 public:
  /// The shapes of the flat diagram must be known. The blocks point into `lists`.
  Layout(const FlatDiagram& flat, Plan& plan, Plan::Lists& lists);
  /// Appends the numbers of a wire to a list.
  void append_numbers(const FlatWire& wire, std::vector<Number>& to) const;

 private:
  std::optional<Number> scalar_of(const FlatWire& wire) const;
  void reserve();
  void add_blocks();
  void add_outputs(const FlatBlock& flat, int element, Plan::Block& block);
  void number_constants();
  void list_scalars();
  void wire_inputs();
  void wire_port(const FlatBlock& flat, size_t port, int element);
  void put_in_a_row(size_t first, const Plan::Block& reader, std::string_view port);
  void settle_states();
  void hand_out_inputs();

  const FlatDiagram& flat_;
  Plan& plan_;
  Plan::Lists& lists_;
  std::vector<int> first_instance_;  // of each flat block
  /// Numbers of scalar ports of blocks with one element, which are most blocks: a faster look-up than in the
  /// blocks, as every wire needs its number.
  std::vector<std::optional<Number>> scalars_;
  std::vector<size_t> first_scalar_;            // of each flat block
  std::vector<size_t> end_of_input_;            // of each input port, as an index into all numbers
  std::vector<std::vector<Number>> scattered_;  // inputs of the blocks that make them contiguous
};

}  // namespace loopwright
