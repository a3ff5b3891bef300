#include "tools/stability/nonlinearities.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "engine/run/require_finished.h"
#include "tools/linearize/block_bench.h"
#include "tools/linearize/slope.h"

namespace loopwright {
namespace {

using Eigen::Index;

/// The `index`-th number of Halton's sequence to a prime base, in (0, 1).
double halton(int index, int base) {
  double value = 0, digit = 1.0 / base;
  for (int i = index; i > 0; i /= base, digit /= base) value += digit * (i % base);
  return value;
}
constexpr int primes[] = {2, 3, 5, 7, 11, 13, 17, 19};

struct Box {
  std::vector<size_t> inputs;  ///< those that change
  std::vector<double> low, high;
};

Box box_of(const LinearBlock& block, const VisitedRanges& visited) {
  Box box;
  for (size_t i = 0; i < block.inputs.size(); ++i) {
    const double low = visited.low[size_t(block.inputs[i])], high = visited.high[size_t(block.inputs[i])];
    const double margin = 0.1 * (high - low);
    if (!(margin > 0) || box.inputs.size() == std::size(primes)) continue;
    box.inputs.push_back(i), box.low.push_back(low - margin), box.high.push_back(high + margin);
  }
  return box;
}

/// Slopes and values of one output of a block over a box.
struct Sampled {
  std::vector<double> lowest, highest;      ///< slopes, one per input of the box
  std::vector<std::vector<double>> points;  ///< inputs of the box
  std::vector<double> values;
  bool depends_on_past = false;  ///< the same inputs gave another output after other points: hysteresis
};

Sampled sample(BlockBench& bench, BlockBench& wandering, const Box& box, size_t output, int count) {
  Sampled sampled;
  sampled.lowest.assign(box.inputs.size(), infinity), sampled.highest.assign(box.inputs.size(), -infinity);
  std::vector<double> y(bench.outputs()), after_others = y;
  for (int p = 1; p <= count; ++p) {
    bench.restore();
    std::vector<double> point;
    for (size_t i = 0; i < box.inputs.size(); ++i) {
      point.push_back(box.low[i] + (box.high[i] - box.low[i]) * halton(p, primes[i]));
      bench.inputs()[box.inputs[i]] = wandering.inputs()[box.inputs[i]] = point[i];
    }
    if (!bench.decide() || !bench.compute(y)) continue;
    if (wandering.decide() && wandering.compute(after_others))
      sampled.depends_on_past |= std::abs(after_others[output] - y[output]) > 1e-9 * std::abs(y[output]);
    sampled.values.push_back(y[output]);
    for (size_t i = 0; i < box.inputs.size(); ++i) {
      double& input = bench.inputs()[box.inputs[i]];
      const double at = input;
      const auto value = [&](double x, std::span<double> out) {
        input = x;
        return bench.compute(out);
      };
      const Slope found = slope(value, at, y.size());
      input = at;
      if (!std::isfinite(found.value[output])) continue;
      sampled.lowest[i] = std::min({sampled.lowest[i], found.left[output], found.right[output]});
      sampled.highest[i] = std::max({sampled.highest[i], found.left[output], found.right[output]});
    }
    sampled.points.push_back(std::move(point));
  }
  bench.restore();
  return sampled;
}

/// Whether values differ by more than slopes within their bounds allow.
bool jumps(const Sampled& s) {
  if (s.depends_on_past) return true;
  double size = 0;
  for (double value : s.values) size = std::max(size, std::abs(value));
  for (size_t p = 1; p < s.points.size(); ++p) {
    double allowed = 1e-9 * size;
    for (size_t i = 0; i < s.lowest.size(); ++i)
      allowed += 1.02 * std::max(std::abs(s.lowest[i]), std::abs(s.highest[i])) *
                 std::abs(s.points[p][i] - s.points[p - 1][i]);
    if (std::abs(s.values[p] - s.values[p - 1]) > allowed) return true;
  }
  return false;
}

bool is_staircase(const LinearDiagram& linear, const std::string& block) {
  return std::ranges::any_of(linear.notes, [&](const LinearizationNote& note) {
    return note.block == block && note.kind == LinearizationNote::Kind::staircase;
  });
}

std::string input_port(const Plan::Block& block, size_t input) {
  for (size_t i = 0; i < block.inputs.size(); ++i) {
    if (input < block.inputs[i].size())
      return block.inputs[i].size() == 1
                 ? fmt::format("{}.in.{}", block.path, block.type->info.inputs[i].name)
                 : fmt::format("{}.in.{}[{}]", block.path, block.type->info.inputs[i].name, input);
    input -= block.inputs[i].size();
  }
  return block.path;
}

}  // namespace

VisitedRanges visit(const Plan& plan, const RunOptions& options,
                    const std::function<void(Run<double>&)>& at_stop) {
  Plan recorded = plan;
  recorded.log.clear();
  for (Number n = 0; n < plan.signals + plan.states; ++n)
    recorded.log.push_back({fmt::format("number {}", n), {}, false, n, {}});
  RunOptions with_stop = options;
  with_stop.at_stop = at_stop;
  const RunResult result = simulate(recorded, with_stop);
  require_finished(result);
  VisitedRanges visited;
  for (size_t c = 1; c < result.recording.columns.size(); ++c) {
    const auto [low, high] = std::ranges::minmax(result.recording.columns[c].values);
    visited.low.push_back(low), visited.high.push_back(high);
  }
  return visited;
}

std::vector<Nonlinearity> find_nonlinearities(const Run<double>& run, const VisitedRanges& visited,
                                              LinearDiagram& linear, int points) {
  const Plan& plan = *linear.plan;
  std::vector<Nonlinearity> found;
  for (size_t b = 0; b < linear.blocks.size(); ++b) {
    LinearBlock& block = linear.blocks[b];
    if (block.kind != LinearBlock::Kind::algebraic) continue;
    if (is_staircase(linear, plan.blocks[b].path)) continue;
    const Box box = box_of(block, visited);
    if (box.inputs.empty()) continue;
    BlockBench bench(run, int(b)), wandering(run, int(b));
    for (size_t o = 0; o < block.outputs.size(); ++o) {
      const Sampled coarse = sample(bench, wandering, box, o, 32);
      const auto is_straight = [&](const Sampled& s) {
        for (size_t i = 0; i < box.inputs.size(); ++i)
          if (s.highest[i] - s.lowest[i] > 1e-9 * std::max(std::abs(s.highest[i]), std::abs(s.lowest[i])))
            return false;
        return !jumps(s);
      };
      if (is_straight(coarse)) continue;
      const Sampled fine = sample(bench, wandering, box, o, points);
      Nonlinearity nonlinearity;
      nonlinearity.block = plan.blocks[b].path, nonlinearity.output = plan.name_of(block.outputs[o]);
      nonlinearity.source = fmt::format("{} points of what the run visited", points);
      nonlinearity.has_jumps = jumps(fine);
      for (size_t i = 0; i < box.inputs.size(); ++i) {
        // A discontinuous function is excluded: its slopes, steep where it holds, do not describe it.
        const double middle = nonlinearity.has_jumps ? 0 : 0.5 * (fine.lowest[i] + fine.highest[i]);
        block.D(Index(o), Index(box.inputs[i])) = middle;
        nonlinearity.inputs.push_back({input_port(plan.blocks[b], box.inputs[i]), middle,
                                       0.5 * (fine.highest[i] - fine.lowest[i]), box.low[i], box.high[i]});
      }
      for (size_t p = 0; p < fine.values.size(); ++p) {
        double rest = fine.values[p];
        for (size_t i = 0; i < box.inputs.size(); ++i)
          rest -= nonlinearity.inputs[i].slope * fine.points[p][i];
        nonlinearity.bound = std::max(nonlinearity.bound, std::abs(rest));
      }
      found.push_back(std::move(nonlinearity));
    }
  }
  return found;
}

}  // namespace loopwright
