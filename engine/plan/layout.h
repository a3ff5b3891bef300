/// Where every number of a run stands: blocks on vectors taken apart into blocks on scalars, wires turned
/// into numbers.
#pragma once
#include "engine/plan/flatten.h"
#include "engine/plan/plan.h"

namespace loopwright {

/// Fills Plan::blocks with one block an element, gives every output its numbers, and wires the inputs.
class Layout {
 public:
  /// The shapes of the flat diagram are found. The blocks point into `lists`.
  Layout(const FlatDiagram& flat, Plan& plan, Plan::Lists& lists);
  /// Adds the numbers that a wire carries to a list.
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
  /// Of scalar ports of blocks that stand once, which most are: every wire asks for its number, and finds it
  /// here sooner than in the blocks.
  std::vector<std::optional<Number>> scalars_;
  std::vector<size_t> first_scalar_;            // of each flat block
  std::vector<size_t> end_of_input_;            // of each input port, in the numbers of all
  std::vector<std::vector<Number>> scattered_;  // what the blocks read that put it in a row
};

}  // namespace loopwright
