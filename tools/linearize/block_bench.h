/// A copy of one block of a run, to be evaluated with different inputs, states and memory.
#pragma once
#include <span>
#include <vector>
#include "engine/run/run.h"

namespace loopwright {

class BlockBench {
 public:
  BlockBench(const Run<double>& run, int index);
  BlockBench(const BlockBench&) = delete;
  BlockBench& operator=(const BlockBench&) = delete;

  const Plan::Block& block() const { return block_; }
  bool has_update() const { return methods_.update; }
  bool has_derivatives() const { return methods_.derivatives; }
  bool has_accept() const { return methods_.accept; }
  bool has_decide() const { return methods_.decide; }

  /// Its inputs, port after port, and the numbers that may be changed to find slopes.
  std::vector<double>& inputs() { return inputs_; }
  std::vector<double>& states() { return states_; }
  /// Numbers that it remembers: those of its Memory, then the buffers.
  std::vector<double*>& remembered() { return remembered_; }
  /// Its outputs, port after port, except outputs bound to states.
  std::vector<Number> computed_numbers() const;
  size_t outputs() const { return computed_.size(); }

  /// A tunable parameter of the block; null if there is none with this name.
  const double* parameter(std::string_view path) const;

  /// Back to the state of the block in the run.
  void restore();
  bool decide();
  /// All outputs with the mode held; false for a fault.
  bool compute(std::span<double> outputs);
  bool derivatives(std::span<double> rates);
  bool update();
  /// Whether an update moves an index: the numbers of a ring buffer change their meaning from sample to
  /// sample.
  bool update_moves_index();

 private:
  bool call(Step<double> step);
  void connect_inputs(const Call<double>& original);
  void connect_outputs(const Call<double>& original);
  void connect_memory(const Call<double>& original);

  const Plan::Block& block_;
  const Kernels<double>& methods_;
  const Instant now_;
  const Call<double>& original_;
  Call<double> call_;
  FaultReport fault_;
  std::vector<double> inputs_, states_, rates_, computed_, buffers_;
  std::vector<const double*> many_;
  std::vector<Port<double>> in_, out_, buffer_ports_;
  std::vector<std::max_align_t> memory_, mode_;
  std::vector<double*> remembered_;
};

}  // namespace loopwright
