#include "tools/linearize/block_slopes.h"
#include <fmt/format.h>
#include <cmath>
#include "tools/linearize/block_bench.h"
#include "tools/linearize/slope.h"
#include "tools/linearize/quantizer_slope.h"

namespace loopwright {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using NoteKind = LinearizationNote::Kind;

/// Blocks that remember more samples than this are rejected: matrices are dense.
constexpr size_t most_states = 2000;

class BlockSlopes {
 public:
  BlockSlopes(const Run<double>& run, int index, std::vector<LinearizationNote>& notes)
      : bench_(run, index), plan_(run.plan()), block_(bench_.block()), notes_(notes) {
    for (const auto& port : block_.inputs)
      linear_.inputs.insert(linear_.inputs.end(), port.begin(), port.end());
    linear_.outputs = bench_.computed_numbers();
    for (size_t o = 0; o < block_.outputs.size(); ++o)
      if (const int group = block_.type->info.outputs[o].group; group >= 0)
        linear_.group_of_output.insert(linear_.group_of_output.end(), size_t(block_.output_lengths[o]),
                                       group);
    linear_.D = MatrixXd::Zero(rows(), columns());
    linear_.A.resize(0, 0), linear_.B.resize(0, columns()), linear_.C.resize(rows(), 0);
  }

  LinearBlock find() {
    if (block_.type->info.type == "TransportDelay")
      find_transport_delay();
    else if (bench_.has_derivatives())
      find_continuous();
    else if (bench_.has_update() && !linear_.inputs.empty())
      find_sampled();
    else
      find_outputs();
    return std::move(linear_);
  }

 private:
  Index rows() const { return Index(linear_.outputs.size()); }
  Index columns() const { return Index(linear_.inputs.size()); }

  void note(NoteKind kind, std::string text, double size = 0) {
    notes_.push_back({kind, block_.path, std::move(text), size});
  }

  std::string input_name(Index column) const {
    for (size_t i = 0; i < block_.inputs.size(); ++i) {
      const Index length = Index(block_.inputs[i].size());
      const std::string_view port = block_.type->info.inputs[i].name;
      if (column < length)
        return length == 1 ? fmt::format("{}.{}", block_.path, port)
                           : fmt::format("{}.{}[{}]", block_.path, port, column);
      column -= length;
    }
    return block_.path;
  }
  std::string output_name(Index row) const { return plan_.name_of(linear_.outputs[size_t(row)]); }

  /// Slopes of `value` when `number`, which belongs to the bench, changes; one column for each number that
  /// `store` takes.
  template <class F, class Name>
  void differentiate(double& number, size_t size, F&& value, const Name& name, MatrixXd& into, Index column) {
    const double at = number;
    const Slope found = slope(
        [&](double x, std::span<double> y) {
          number = x;
          return value(y);
        },
        at, size);
    number = at;
    for (size_t row = 0; row < size; ++row) {
      into(Index(row), column) = std::isfinite(found.value[row]) ? found.value[row] : 0.0;
      if (found.has_corner(row))
        note(NoteKind::corner,
             fmt::format("stands on a corner with respect to {}: slope {:.4g} below and {:.4g} "
                         "above, {:.4g} is taken",
                         name(), found.left[row], found.right[row], found.value[row]));
      else if (!(found.error[row] <= 1e-6 * std::abs(found.value[row]) + 1e-9 * found.size[row] + 1e-12))
        note(NoteKind::inaccurate, fmt::format("the slope with respect to {} is uncertain: {:.6g} ± {:.1g}",
                                               name(), found.value[row], found.error[row]));
    }
  }

  bool is_fed(Index row, Index column) const {
    const int group = linear_.group_of_output[size_t(row)];
    size_t port = 0;
    for (Index left = column; left >= Index(block_.inputs[port].size()); ++port)
      left -= Index(block_.inputs[port].size());
    for (const PortInfo& output : block_.type->info.outputs)
      if (output.group == group) return output.fed_by >> port & 1;
    return false;
  }

  /// D, with modes held; then quantizers as straight lines, and notes for the reader.
  void find_outputs() {
    const size_t size = linear_.outputs.size();
    const auto value = [&](std::span<double> y) { return bench_.compute(y); };
    for (Index i = 0; i < columns(); ++i)
      if (size > 0)
        differentiate(
            bench_.inputs()[size_t(i)], size, value, [&] { return input_name(i); }, linear_.D, i);
    for (Index o = 0; o < rows(); ++o)
      for (Index i = 0; i < columns(); ++i)
        if (!is_fed(o, i)) linear_.D(o, i) = 0;
    if (bench_.has_decide() && columns() > 0) straighten_staircases();
    const bool is_piecewise = bench_.has_decide() || bench_.block().type->kernels.crossings;
    if (!is_piecewise) return;
    for (Index o = 0; o < rows(); ++o) {
      std::string unheard;
      for (Index i = 0; i < columns(); ++i)
        if (linear_.D(o, i) == 0 && is_fed(o, i) && plan_.source_of(linear_.inputs[size_t(i)]).first >= 0)
          unheard += (unheard.empty() ? "" : " and ") + input_name(i);
      if (!unheard.empty())
        note(NoteKind::flat, fmt::format("{} does not follow {} here", output_name(o), unheard));
    }
  }

  void straighten_staircases() {
    for (Index i = 0; i < columns(); ++i) {
      if (!linear_.D.col(i).isZero(0)) continue;
      const Staircase stairs = find_staircase(bench_, size_t(i));
      if (stairs.slope.empty()) continue;
      for (Index o = 0; o < rows(); ++o) linear_.D(o, i) = stairs.slope[size_t(o)];
      note(NoteKind::staircase,
           fmt::format("steps {:.4g} wide in {}, taken as a straight line of slope {:.6g}", stairs.width,
                       input_name(i), linear_.D.col(i).cwiseAbs().maxCoeff()),
           stairs.width * linear_.D.col(i).cwiseAbs().maxCoeff());
    }
    if (!linear_.D.isZero(0)) note_held();
  }
  void note_held() {
    for (const LinearizationNote& other : notes_)
      if (other.block == block_.path && other.kind == NoteKind::staircase) return;
    note(NoteKind::held, fmt::format("{} keeps the mode that it is in", block_.type->info.type));
  }

  void find_continuous() {
    find_outputs();
    linear_.kind = LinearBlock::Kind::continuous;
    const size_t n = size_t(block_.states);
    linear_.A.resize(Index(n), Index(n)), linear_.B.resize(Index(n), columns()),
        linear_.C.resize(rows(), Index(n));
    const auto rates = [&](std::span<double> y) { return bench_.derivatives(y); };
    const auto value = [&](std::span<double> y) { return bench_.compute(y); };
    linear_.states = state_names();
    for (size_t j = 0; j < n; ++j) {
      const auto name = [&] { return linear_.states[j]; };
      differentiate(bench_.states()[j], n, rates, name, linear_.A, Index(j));
      if (rows() > 0) differentiate(bench_.states()[j], size_t(rows()), value, name, linear_.C, Index(j));
    }
    for (Index i = 0; i < columns(); ++i)
      differentiate(
          bench_.inputs()[size_t(i)], n, rates, [&] { return input_name(i); }, linear_.B, i);
  }
  std::vector<std::string> state_names() const {
    std::vector<std::string> names;
    for (int j = 0; j < block_.states; ++j)
      names.push_back(block_.states == 1 ? block_.path : fmt::format("{}[{}]", block_.path, j));
    for (const PortInfo& output : block_.type->info.outputs)
      if (output.state >= 0 && output.state < block_.states)
        names[size_t(output.state)] = fmt::format("{}.{}", block_.path, output.name);
    return names;
  }

  void find_sampled() {
    linear_.kind = LinearBlock::Kind::sampled;
    if (bench_.remembered().size() > most_states) {
      note(NoteKind::inaccurate, fmt::format("remembers {} numbers, more than {}: its outputs are held",
                                             bench_.remembered().size(), most_states));
      linear_.kind = LinearBlock::Kind::algebraic;
      return;
    }
    if (bench_.update_moves_index() && find_finite_response()) return;
    find_outputs();
    const size_t n = bench_.remembered().size();
    linear_.A.resize(Index(n), Index(n)), linear_.B.resize(Index(n), columns()),
        linear_.C.resize(rows(), Index(n));
    for (size_t j = 0; j < n; ++j) linear_.states.push_back(fmt::format("{}[{}]", block_.path, j));
    const auto outputs = [&](std::span<double> y) { return bench_.compute(y); };
    for (size_t j = 0; j < n; ++j) {
      const auto name = [&] { return linear_.states[j]; };
      double moved = *bench_.remembered()[j];
      const auto next = [&](std::span<double> y) {
        return next_memory(y, [&] { *bench_.remembered()[j] = moved; });
      };
      differentiate(moved, n, next, name, linear_.A, Index(j));
      bench_.restore();
      if (rows() > 0)
        differentiate(*bench_.remembered()[j], size_t(rows()), outputs, name, linear_.C, Index(j));
    }
    for (Index i = 0; i < columns() && n > 0; ++i) {
      double moved = bench_.inputs()[size_t(i)];
      const auto next = [&](std::span<double> y) {
        return next_memory(y, [&] { bench_.inputs()[size_t(i)] = moved; });
      };
      differentiate(
          moved, n, next, [&] { return input_name(i); }, linear_.B, i);
    }
    bench_.restore();
    drop_idle_states();
  }
  template <class Move> bool next_memory(std::span<double> y, Move&& move) {
    bench_.restore();
    move();
    if (!bench_.update()) return false;
    for (size_t k = 0; k < y.size(); ++k) y[k] = *bench_.remembered()[k];
    return true;
  }

  /// States that nothing reads, or that nothing drives, not even themselves.
  void drop_idle_states() {
    std::vector<Index> kept;
    for (Index j = 0; j < linear_.A.rows(); ++j) kept.push_back(j);
    for (bool dropped = true; dropped;) {
      dropped = false;
      for (size_t k = 0; k < kept.size() && !dropped; ++k) {
        const Index j = kept[k];
        bool is_read = !linear_.C.col(j).isZero(0), is_driven = !linear_.B.row(j).isZero(0);
        for (Index other : kept) {
          is_read |= other != j && linear_.A(other, j) != 0;
          is_driven |= linear_.A(j, other) != 0;
        }
        if (is_read && is_driven) continue;
        kept.erase(kept.begin() + std::ptrdiff_t(k));
        dropped = true;
      }
    }
    std::vector<std::string> names;
    for (Index j : kept) names.push_back(linear_.states[size_t(j)]);
    linear_.A = MatrixXd(linear_.A(kept, kept)), linear_.B = MatrixXd(linear_.B(kept, Eigen::all));
    linear_.C = MatrixXd(linear_.C(Eigen::all, kept)), linear_.states = names;
  }

  /// A ring buffer does the same at every sample but at different indices. Its response to one pulse
  /// determines its behavior; its states are the last inputs. False when the response does not end.
  bool find_finite_response() {
    const size_t length = bench_.remembered().size() + 2, samples = 2 * length, size = size_t(rows());
    std::vector<MatrixXd> response(samples, MatrixXd::Zero(rows(), columns()));
    MatrixXd column(Index(samples * size), 1);
    for (Index i = 0; i < columns(); ++i) {
      const double rest = bench_.inputs()[size_t(i)];
      double pulse = rest;
      const auto run = [&](std::span<double> y) {
        bench_.restore();
        for (size_t k = 0; k < samples; ++k) {
          bench_.inputs()[size_t(i)] = k == 0 ? pulse : rest;
          if (!bench_.compute(y.subspan(k * size, size)) || !bench_.update()) return false;
        }
        return true;
      };
      differentiate(
          pulse, samples * size, run, [&] { return input_name(i); }, column, 0);
      for (size_t k = 0; k < samples; ++k) response[k].col(i) = column.block(Index(k * size), 0, rows(), 1);
    }
    bench_.restore();
    size_t last = samples - 1;
    while (last > 0 && response[last].isZero(1e-12)) --last;
    if (last > length) return false;
    keep_inputs(response, last);
    return true;
  }
  void keep_inputs(const std::vector<MatrixXd>& response, size_t last) {
    const Index m = columns(), n = m * Index(last);
    linear_.A = MatrixXd::Zero(n, n), linear_.B = MatrixXd::Zero(n, m), linear_.C.resize(rows(), n);
    for (Index j = m; j < n; ++j) linear_.A(j, j - m) = 1;
    if (last > 0) linear_.B.topRows(m).setIdentity();
    for (size_t k = 1; k <= last; ++k) {
      linear_.C.middleCols(Index(k - 1) * m, m) = response[k];
      for (Index i = 0; i < m; ++i) linear_.states.push_back(fmt::format("{}[{}]", block_.path, k - 1));
    }
    linear_.D = response[0];
  }

  void find_transport_delay() {
    linear_.kind = LinearBlock::Kind::delay;
    linear_.D = MatrixXd::Identity(1, 1);
    linear_.delay = *bench_.parameter("delay");
  }

  BlockBench bench_;
  const Plan& plan_;
  const Plan::Block& block_;
  std::vector<LinearizationNote>& notes_;
  LinearBlock linear_;
};

}  // namespace

LinearBlock linearize_block(const Run<double>& run, int index, std::vector<LinearizationNote>& notes) {
  return BlockSlopes(run, index, notes).find();
}

}  // namespace loopwright
