#include <cmath>
#include <numeric>
#include <set>
#include "tools/linearize/linear_diagram.h"
#include "tools/linearize/linear_step.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Kind = LinearBlock::Kind;

constexpr int pade_order = 6;

std::string unit_text(const Plan& plan, Number number) {
  const auto unit = plan.unit_of(number);
  return unit ? to_string(*unit) : "";
}

void name_ports(const Plan& plan, const Taps& taps, LinearSystem& system) {
  for (const PortNumber& port : taps.from())
    system.inputs.push_back(port.name), system.input_units.push_back(unit_text(plan, port.number));
  for (const PortNumber& port : taps.to())
    system.outputs.push_back(port.name), system.output_units.push_back(unit_text(plan, port.number));
}

/// Inserts the rows of a block's states at their index in a matrix of all states.
class StatePlaces {
 public:
  StatePlaces(const LinearDiagram& diagram, Kind kind) {
    for (size_t b = 0; b < diagram.blocks.size(); ++b)
      if (diagram.blocks[b].kind == kind) {
        places_.push_back({int(b), total, diagram.blocks[b].A.rows()});
        total += diagram.blocks[b].A.rows();
      }
  }
  struct Place {
    int block;
    Index first, count;
  };
  const std::vector<Place>& places() const { return places_; }
  Index total = 0;

 private:
  std::vector<Place> places_;
};

/// The continuous part over the coordinates: continuous states | outputs of the delays | added signals | held
/// numbers (those computed by sampled blocks).
struct Continuous {
  Index states = 0, delays = 0, added = 0, held = 0;
  MatrixXd rates;        ///< of the states
  MatrixXd into_delays;  ///< inputs of the delays
  MatrixXd outputs;      ///< rows of `to`
  std::vector<Number> held_numbers;

  MatrixXd A() const { return rates.leftCols(states); }
  MatrixXd B() const { return rates.rightCols(rates.cols() - states); }
};

std::vector<Number> sampled_numbers(const LinearDiagram& diagram) {
  std::set<Number> numbers;
  const auto add = [&](const Plan::Entry& entry) {
    const LinearBlock& block = diagram.blocks[size_t(entry.block)];
    for (size_t o = 0; o < block.outputs.size(); ++o)
      if (block.group_of_output[o] == entry.group) numbers.insert(block.outputs[o]);
  };
  for (const Plan::Entry& entry : diagram.plan->order) {
    if (entry.rate.kind != Rate::Kind::sampled) continue;
    if (entry.kind == Plan::Entry::Kind::outputs) add(entry);
    if (entry.kind == Plan::Entry::Kind::algebraic_loop)
      for (const Plan::Entry& inner : diagram.plan->algebraic_loops[size_t(entry.block)].entries)
        if (inner.kind == Plan::Entry::Kind::outputs) add(inner);
  }
  return {numbers.begin(), numbers.end()};
}

Continuous find_continuous(const LinearDiagram& diagram, const Taps& taps) {
  const StatePlaces states(diagram, Kind::continuous);
  Continuous part;
  part.held_numbers = sampled_numbers(diagram);
  part.states = states.total, part.added = Index(taps.from().size()),
  part.held = Index(part.held_numbers.size());
  for (const LinearBlock& block : diagram.blocks) part.delays += block.kind == Kind::delay;
  const Index width = part.states + part.delays + part.added + part.held;
  LinearStep step(diagram, taps, width);
  const MatrixXd unit = MatrixXd::Identity(width, width);
  for (const auto& place : states.places())
    step.memory[size_t(place.block)] = unit.middleRows(place.first, place.count);
  step.delayed = unit.middleRows(part.states, part.delays);
  step.added = unit.middleRows(part.states + part.delays, part.added);
  for (Index h = 0; h < part.held; ++h)
    step.numbers.row(part.held_numbers[size_t(h)]) = unit.row(part.states + part.delays + part.added + h);
  step.evaluate([](const Rate&) { return false; });
  part.rates.resize(part.states, width);
  for (const auto& place : states.places())
    part.rates.middleRows(place.first, place.count) = step.next(place.block);
  part.into_delays.resize(part.delays, width);
  for (Index d = 0; d < part.delays; ++d) part.into_delays.row(d) = step.read(step.delays()[size_t(d)], 0);
  part.outputs.resize(Index(taps.to().size()), width);
  for (size_t i = 0; i < taps.to().size(); ++i)
    part.outputs.row(Index(i)) = step.numbers.row(taps.to()[i].number);
  return part;
}

/// The diagram with transport delays of non-held signals replaced by approximations, as additional continuous
/// blocks.
LinearDiagram with_rational_delays(const LinearDiagram& diagram, const std::vector<bool>& is_exact) {
  LinearDiagram result = diagram;
  for (size_t b = 0; b < result.blocks.size(); ++b) {
    LinearBlock& block = result.blocks[b];
    if (block.kind != Kind::delay || is_exact[b]) continue;
    StateSpace pure;
    pure.A.resize(0, 0), pure.B.resize(0, 2), pure.C.resize(2, 0);
    pure.D.resize(2, 2), pure.D << 0, 1, 1, 0;
    pure.delays = {block.delay};
    const StateSpace rational = with_approximate_delays(pure, pade_order);
    block.kind = Kind::continuous;
    block.A = rational.A, block.B = rational.B, block.C = rational.C, block.D = rational.D;
    for (int i = 0; i < pade_order; ++i)
      block.states.push_back(diagram.plan->blocks[b].path + " (approximation)");
  }
  return result;
}

/// Whether the input of a transport delay is constant between samples.
std::vector<bool> exact_delays(const LinearDiagram& diagram) {
  const Plan& plan = *diagram.plan;
  std::vector<bool> is_held(size_t(plan.signals + plan.states), false);
  for (Number n : sampled_numbers(diagram)) is_held[size_t(n)] = true;
  std::vector<bool> result;
  for (const LinearBlock& block : diagram.blocks)
    result.push_back(block.kind == Kind::delay && is_held[size_t(block.inputs[0])]);
  return result;
}

/// A transport delay of whole samples and a fraction: between samples its output changes at the fraction
/// `change` of a period after the sample, and `line` holds the delayed values, the latest last.
struct DelayLine {
  int block;
  int whole;      ///< samples
  double change;  ///< 0 … 1
  Index first = 0, length = 0;
};

class Sampler {
 public:
  Sampler(const LinearDiagram& original, const Access& access, double sample_time, int subdivisions)
      : diagram_(with_rational_delays(original, exact_delays(original))),
        plan_(*original.plan),
        taps_(plan_, access),
        subdivisions_(subdivisions),
        continuous_(find_continuous(diagram_, taps_)),
        continuous_places_(diagram_, Kind::continuous),
        sampled_places_(diagram_, Kind::sampled) {
    find_period(sample_time);
    find_delay_lines();
    find_segments();
    find_held_states();
    width_ = continuous_.states + sampled_places_.total + line_length_ + Index(held_states_.size()) +
             Index(lifted_) * continuous_.added;
  }

  SampledSystem sample() {
    LinearStep step(diagram_, taps_, width_);
    begin(step);
    const Index outputs = Index(taps_.to().size()), states = width_ - lifted_ * continuous_.added;
    SampledSystem system;
    system.matrices.C.resize(outputs * lifted_, states);
    system.matrices.D.resize(outputs * lifted_, width_ - states);
    for (int k = 0; k < lifted_; ++k) {
      const bool is_tick = k % subdivisions_ == 0;
      const int64_t tick = k / subdivisions_ * base_ticks_;
      const auto is_due = [&](const Rate& rate) {
        return is_tick && (tick - rate.offset) % rate.period == 0;
      };
      step.added =
          MatrixXd::Identity(width_, width_).middleRows(states + k * continuous_.added, continuous_.added);
      show_delays(step);
      step.evaluate(is_due);
      for (Index o = 0; o < outputs; ++o) {
        const auto row = step.numbers.row(taps_.to()[size_t(o)].number);
        system.matrices.C.row(k * outputs + o) = row.head(states);
        system.matrices.D.row(k * outputs + o) = row.tail(width_ - states);
      }
      update(step, is_due);
    }
    const MatrixXd end = state_rows(step);
    system.matrices.A = end.leftCols(states), system.matrices.B = end.rightCols(width_ - states);
    system.matrices.sample_time = lifted_ * base_period_;
    system.lifted = lifted_, system.base_period = base_period_;
    system.states = state_names();
    name_ports(plan_, taps_, system);
    return system;
  }

 private:
  void find_period(double sample_time) {
    if (plan_.rates.empty()) {
      base_period_ = sample_time / subdivisions_, lifted_ = subdivisions_;
      return;
    }
    int64_t base = 0, whole = 1;
    for (const Rate& rate : plan_.rates) {
      base = std::gcd(base, std::gcd(rate.period, rate.offset));
      whole = std::lcm(whole, rate.period);
    }
    base_ticks_ = base, lifted_ = int(whole / base) * subdivisions_;
    base_period_ =
        double(base * plan_.clock.base.numerator) / double(plan_.clock.base.denominator) / subdivisions_;
  }

  void find_delay_lines() {
    for (size_t b = 0; b < diagram_.blocks.size(); ++b) {
      if (diagram_.blocks[b].kind != Kind::delay) continue;
      const double samples = diagram_.blocks[b].delay / base_period_;
      DelayLine line{int(b), int(whole_count(std::floor(samples + 1e-9))), 0};
      line.change = std::max(0.0, samples - line.whole);
      if (line.change < 1e-9) line.change = 0;
      line.length = line.whole + (line.change > 0 ? 1 : 0);
      line.first = line_length_;
      line_length_ += line.length;
      lines_.push_back(line);
    }
  }
  /// Between samples the outputs of delays change: the continuous part advances from change to change.
  void find_segments() {
    std::set<double> ends{1.0};
    for (const DelayLine& line : lines_)
      if (line.change > 0) ends.insert(line.change);
    double begin = 0;
    for (double end : ends) {
      segments_.push_back({end, propagate(continuous_.A(), continuous_.B(), (end - begin) * base_period_)});
      begin = end;
    }
  }
  /// Sampled numbers that are not recomputed at the first sample of the period.
  void find_held_states() {
    std::vector<bool> is_new(size_t(plan_.signals), false);
    for (const Plan::Entry& entry : plan_.order) {
      if (entry.rate.kind != Rate::Kind::sampled || entry.rate.offset % entry.rate.period != 0) continue;
      const auto mark = [&](const Plan::Entry& inner) {
        const LinearBlock& block = diagram_.blocks[size_t(inner.block)];
        for (size_t o = 0; o < block.outputs.size(); ++o)
          if (block.group_of_output[o] == inner.group) is_new[size_t(block.outputs[o])] = true;
      };
      if (entry.kind == Plan::Entry::Kind::algebraic_loop)
        for (const Plan::Entry& inner : plan_.algebraic_loops[size_t(entry.block)].entries) mark(inner);
      else
        mark(entry);
    }
    for (Number n : continuous_.held_numbers)
      if (!is_new[size_t(n)]) held_states_.push_back(n);
  }

  void begin(LinearStep& step) const {
    const MatrixXd unit = MatrixXd::Identity(width_, width_);
    Index at = 0;
    for (const StatePlaces* places : {&continuous_places_, &sampled_places_}) {
      for (const auto& place : places->places())
        step.memory[size_t(place.block)] = unit.middleRows(at + place.first, place.count);
      at += places->total;
    }
    for (const DelayLine& line : lines_) queue_.push_back(unit.middleRows(at + line.first, line.length));
    at += line_length_;
    for (Number n : held_states_) step.numbers.row(n) = unit.row(at++);
  }
  MatrixXd state_rows(const LinearStep& step) const {
    MatrixXd rows(width_ - lifted_ * continuous_.added, width_);
    Index at = 0;
    for (const StatePlaces* places : {&continuous_places_, &sampled_places_}) {
      for (const auto& place : places->places())
        rows.middleRows(at + place.first, place.count) = step.memory[size_t(place.block)];
      at += places->total;
    }
    for (const MatrixXd& queue : queue_) rows.middleRows(at, queue.rows()) = queue, at += queue.rows();
    for (Number n : held_states_) rows.row(at++) = step.numbers.row(n);
    return rows;
  }
  std::vector<std::string> state_names() const {
    std::vector<std::string> names;
    for (const StatePlaces* places : {&continuous_places_, &sampled_places_})
      for (const auto& place : places->places())
        for (const std::string& name : diagram_.blocks[size_t(place.block)].states) names.push_back(name);
    for (const DelayLine& line : lines_)
      for (Index i = 0; i < line.length; ++i)
        names.push_back(plan_.blocks[size_t(line.block)].path + " (under way)");
    for (Number n : held_states_) names.push_back(plan_.name_of(n) + " (held)");
    return names;
  }

  /// At a sample, the output of a delay is the oldest value of its line; without whole samples of delay, the
  /// last one.
  void show_delays(LinearStep& step) const {
    for (size_t d = 0; d < lines_.size(); ++d) step.delayed.row(Index(d)) = queue_[d].row(0);
  }

  template <class Due> void update(LinearStep& step, Due&& is_due) {
    std::vector<std::pair<size_t, MatrixXd>> next;
    for (const auto& place : sampled_places_.places()) {
      const Plan::Block& block = plan_.blocks[size_t(place.block)];
      if (is_due(Rate{Rate::Kind::sampled, block.period, block.offset}))
        next.emplace_back(size_t(place.block), step.next(place.block));
    }
    for (size_t d = 0; d < lines_.size(); ++d) {
      MatrixXd longer(queue_[d].rows() + 1, width_);
      longer << queue_[d], step.read(lines_[d].block, 0);
      queue_[d] = longer;
    }
    for (auto& [block, memory] : next) step.memory[block] = memory;
    advance(step);
    for (MatrixXd& queue : queue_) queue = MatrixXd(queue.bottomRows(queue.rows() - 1));
  }

  void advance(LinearStep& step) const {
    MatrixXd x(continuous_.states, width_), held(continuous_.rates.cols() - continuous_.states, width_);
    for (const auto& place : continuous_places_.places())
      x.middleRows(place.first, place.count) = step.memory[size_t(place.block)];
    held.middleRows(continuous_.delays, continuous_.added) = step.added;
    for (Index h = 0; h < continuous_.held; ++h)
      held.row(continuous_.delays + continuous_.added + h) =
          step.numbers.row(continuous_.held_numbers[size_t(h)]);
    double begin = 0;
    for (const auto& [end, propagation] : segments_) {
      for (size_t d = 0; d < lines_.size(); ++d) {
        const bool has_changed = lines_[d].change > 0 && begin >= lines_[d].change;
        held.row(Index(d)) = queue_[d].row(has_changed ? 1 : 0);
      }
      x = (propagation.transition * x + propagation.input * held).eval();
      begin = end;
    }
    for (const auto& place : continuous_places_.places())
      step.memory[size_t(place.block)] = x.middleRows(place.first, place.count);
  }

  struct Segment {
    double end;  ///< as a fraction of the period
    Propagation propagation;
  };
  const LinearDiagram diagram_;
  const Plan& plan_;
  const Taps taps_;
  const int subdivisions_;
  const Continuous continuous_;
  const StatePlaces continuous_places_, sampled_places_;
  int64_t base_ticks_ = 1;
  int lifted_ = 1;
  double base_period_ = 0;
  std::vector<DelayLine> lines_;
  Index line_length_ = 0, width_ = 0;
  std::vector<Segment> segments_;
  std::vector<Number> held_states_;
  mutable std::vector<MatrixXd> queue_;
};

}  // namespace

LinearSystem continuous_part(const LinearDiagram& diagram, const Access& access) {
  const Taps taps(*diagram.plan, access);
  const Continuous part = find_continuous(diagram, taps);
  // Columns: states | delays | added | held; delays are the last inputs and outputs of a system, held numbers
  // are constant.
  const auto columns = [&](const MatrixXd& rows) {
    MatrixXd ordered(rows.rows(), part.added + part.delays);
    ordered << rows.middleCols(part.states + part.delays, part.added),
        rows.middleCols(part.states, part.delays);
    return ordered;
  };
  LinearSystem system;
  system.matrices.A = part.A(), system.matrices.B = columns(part.rates);
  system.matrices.C.resize(part.outputs.rows() + part.delays, part.states);
  system.matrices.C << part.outputs.leftCols(part.states), part.into_delays.leftCols(part.states);
  system.matrices.D.resize(part.outputs.rows() + part.delays, part.added + part.delays);
  system.matrices.D << columns(part.outputs), columns(part.into_delays);
  for (const LinearBlock& block : diagram.blocks) {
    if (block.kind == Kind::delay) system.matrices.delays.push_back(block.delay);
    if (block.kind == Kind::continuous)
      system.states.insert(system.states.end(), block.states.begin(), block.states.end());
  }
  name_ports(*diagram.plan, taps, system);
  return system;
}

SampledSystem sampled_system(const LinearDiagram& diagram, const Access& access, double sample_time,
                             int subdivisions) {
  refuse_other_sample_time(diagram, sample_time);
  return Sampler(diagram, access, sample_time, subdivisions).sample();
}

}  // namespace loopwright
