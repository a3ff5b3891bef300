#include "tools/linearize/linear_step.h"
#include <Eigen/LU>

namespace loopwright {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;

Taps::Taps(const Plan& plan, const Access& access) : plan_(plan) {
  Problems problems;
  const auto find = [&](const std::vector<std::string>& names) {
    std::vector<PortNumber> found;
    for (const std::string& name : names)
      for (PortNumber& port : find_port(plan, name, problems)) found.push_back(std::move(port));
    return found;
  };
  from_ = find(access.from), to_ = find(access.to);
  const std::vector<PortNumber> open = find(access.open);
  if (problems.has_errors()) throw InputError(std::move(problems));
  for (const Plan::Block& block : plan.blocks) {
    size_t inputs = 0;
    for (const auto& port : block.inputs) inputs += port.size();
    readings_.emplace_back(inputs);
  }
  for (const PortNumber& port : open) visit(port, [](Reading& reading) { reading.is_cut = true; });
  for (size_t i = 0; i < from_.size(); ++i)
    visit(from_[i], [&](Reading& reading) { reading.added.push_back(int(i)); });
}

void Taps::visit(const PortNumber& port, const auto& change) {
  for (const auto& [block, input] : port.readers) change(readings_[size_t(block)][size_t(input)]);
  if (!port.is_output) return;
  for (size_t b = 0; b < plan_.blocks.size(); ++b) {
    size_t k = 0;
    for (const auto& input : plan_.blocks[b].inputs)
      for (Number n : input) {
        if (n == port.number) change(readings_[b][k]);
        ++k;
      }
  }
}

LinearStep::LinearStep(const LinearDiagram& diagram, const Taps& taps, Index width)
    : numbers(MatrixXd::Zero(diagram.plan->signals + diagram.plan->states, width)),
      added(MatrixXd::Zero(Index(taps.from().size()), width)),
      diagram_(diagram),
      taps_(taps) {
  for (size_t b = 0; b < diagram.blocks.size(); ++b) {
    memory.push_back(MatrixXd::Zero(diagram.blocks[b].A.rows(), width));
    delay_of_block_.push_back(int(delays_.size()));
    if (diagram.blocks[b].kind == LinearBlock::Kind::delay) delays_.push_back(int(b));
  }
  delayed = MatrixXd::Zero(Index(delays_.size()), width);
}

/// Outputs bound to states are wires to them.
void LinearStep::show_states() {
  for (size_t b = 0; b < diagram_.blocks.size(); ++b) {
    if (diagram_.blocks[b].kind != LinearBlock::Kind::continuous) continue;
    const Plan::Block& block = diagram_.plan->blocks[b];
    numbers.middleRows(diagram_.plan->signals + block.first_state, block.states) =
        memory[b].topRows(block.states);
  }
}

RowVectorXd LinearStep::read(int block, int k) const {
  const Taps::Reading& reading = taps_.at(block, k);
  RowVectorXd row = numbers.row(diagram_.blocks[size_t(block)].inputs[size_t(k)]);
  if (reading.is_cut) row.setZero();
  for (int i : reading.added) row += added.row(i);
  return row;
}

MatrixXd LinearStep::inputs_of(int block) const {
  MatrixXd rows(Index(diagram_.blocks[size_t(block)].inputs.size()), numbers.cols());
  for (Index k = 0; k < rows.rows(); ++k) rows.row(k) = read(block, int(k));
  return rows;
}

MatrixXd LinearStep::next(int block) const {
  const LinearBlock& linear = diagram_.blocks[size_t(block)];
  return linear.A * memory[size_t(block)] + linear.B * inputs_of(block);
}

void LinearStep::evaluate_entry(const Plan::Entry& entry) {
  if (entry.kind == Plan::Entry::Kind::decide) return;
  if (entry.kind == Plan::Entry::Kind::algebraic_loop)
    return solve_algebraic_loop(diagram_.plan->algebraic_loops[size_t(entry.block)]);
  const LinearBlock& block = diagram_.blocks[size_t(entry.block)];
  if (block.kind == LinearBlock::Kind::delay) {
    numbers.row(block.outputs[0]) = delayed.row(delay_of_block_[size_t(entry.block)]);
    return;
  }
  const MatrixXd inputs = inputs_of(entry.block);
  for (size_t o = 0; o < block.outputs.size(); ++o) {
    if (block.group_of_output[o] != entry.group) continue;
    RowVectorXd row = block.D.row(Index(o)) * inputs;
    if (block.A.rows() > 0) row += block.C.row(Index(o)) * memory[size_t(entry.block)];
    numbers.row(block.outputs[o]) = row;
  }
}

/// The tears t are temporary coordinates: t = P t + q has the solution (1 - P)⁻¹ q.
void LinearStep::solve_algebraic_loop(const Plan::AlgebraicLoop& loop) {
  const Index width = numbers.cols(), tears = Index(loop.tears.size());
  const auto widen = [&](MatrixXd& rows, Index by) {
    rows.conservativeResizeLike(MatrixXd::Zero(rows.rows(), width + by));
  };
  const auto widen_all = [&](Index by) {
    widen(numbers, by), widen(added, by), widen(delayed, by);
    for (MatrixXd& rows : memory) widen(rows, by);
  };
  widen_all(tears);
  for (Index t = 0; t < tears; ++t)
    numbers.row(loop.tears[size_t(t)]).setZero(), numbers(loop.tears[size_t(t)], width + t) = 1;
  for (const Plan::Entry& entry : loop.entries) evaluate_entry(entry);
  MatrixXd P(tears, tears), q(tears, width);
  for (Index t = 0; t < tears; ++t) {
    P.row(t) = numbers.row(loop.tears[size_t(t)]).tail(tears);
    q.row(t) = numbers.row(loop.tears[size_t(t)]).head(width);
  }
  const MatrixXd solution = (MatrixXd::Identity(tears, tears) - P).partialPivLu().solve(q);
  const MatrixXd shares = numbers.rightCols(tears);
  widen_all(0);
  numbers += shares * solution;
}

}  // namespace loopwright
