// What the engine requires of every block: declared feedthrough is the actual one, methods are pure, the
// arena contains all memory, crossings report every change of mode.
#include <algorithm>
#include <cmath>
#include <cstring>
#include "tests/conformance/registered.h"

namespace loopwright::behaviour_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool feeds(const PortInfo& output, size_t input) {
  return output.state < 0 && (output.fed_by >> input & 1) != 0;
}

class Behaviour : public EveryBlock {};

TEST_P(Behaviour, HasAnExample) {
  EXPECT_FALSE(specimens().empty()) << "no diagram in diagrams/ uses this block";
}

TEST_P(Behaviour, EveryByteOfItsMemoryIsDetermined) {
  EXPECT_FALSE(kernels().memory_has_gaps) << "equal memories would differ in bits: make a flag a number";
}

TEST_P(Behaviour, OutputsFollowTheDeclaredInputsAndNoOthers) {
  std::vector<uint64_t> seen(info().outputs.size(), 0);
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    std::mt19937_64 random(1);
    auto block = bench(specimen);
    for (int step = 0; step < 400; ++step) {
      if (step % 50 == 0) block->restart();
      if (!random_step(*block, specimen, step, random)) block->restart();
      const auto settled = block->snapshot();
      const double time = time_of_step(specimen, step + 1);
      randomize_inputs(*block, random);
      block->evaluate(time, step + 1);
      std::vector<std::vector<double>> before;
      for (const PortInfo& output : info().outputs) before.push_back(block->outputs(output.name));
      for (size_t i = 0; i < info().inputs.size(); ++i) {
        auto& input = block->inputs(info().inputs[i].name);
        const std::vector<double> kept = input;
        for (double& number : input) number = random_number(random);
        block->restore(settled);
        block->evaluate(time, step + 1);
        for (size_t o = 0; o < before.size(); ++o) {
          const PortInfo& output = info().outputs[o];
          const bool changed = !equal_bits(block->outputs(output.name), before[o]);
          if (changed) seen[o] |= uint64_t(1) << i;
          const bool is_declared = feeds(output, i) || output.state >= 0;
          ASSERT_TRUE(is_declared || !changed)
              << output.name << " follows " << info().inputs[i].name << ", which it does not declare";
        }
        input = kept;
      }
      block->restore(settled);
    }
  }
  if (info().input_ports) return;  // the settings decide which inputs an output follows
  for (size_t o = 0; o < seen.size(); ++o)
    for (size_t i = 0; i < info().inputs.size(); ++i)
      EXPECT_TRUE(!feeds(info().outputs[o], i) || (seen[o] >> i & 1))
          << info().outputs[o].name << " never follows " << info().inputs[i].name;
}

TEST_P(Behaviour, UndeclaredInputsMayBeNotANumber) {
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    std::mt19937_64 random(2);
    auto block = bench(specimen);
    for (int step = 0; step < 50; ++step) {
      if (!random_step(*block, specimen, step, random)) block->restart();
      const double time = time_of_step(specimen, step + 1);
      block->evaluate(time, step + 1);
      const std::vector<double> before = all_outputs(*block);
      for (const PortInfo& output : info().outputs) {
        const std::vector<double> expected = block->outputs(output.name);
        std::vector<std::vector<double>> kept;
        for (size_t i = 0; i < info().inputs.size(); ++i) {
          auto& input = block->inputs(info().inputs[i].name);
          kept.push_back(input);
          if (!feeds(output, i)) std::ranges::fill(input, nan);
        }
        block->evaluate_held(time);
        ASSERT_TRUE(equal_bits(block->outputs(output.name), expected)) << output.name;
        for (size_t i = 0; i < kept.size(); ++i) block->inputs(info().inputs[i].name) = kept[i];
        block->evaluate_held(time);
      }
      ASSERT_TRUE(equal_bits(all_outputs(*block), before));
    }
  }
}

TEST_P(Behaviour, FiniteInputsGiveFiniteNumbersOrAFault) {
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    std::mt19937_64 random(3);
    auto block = bench(specimen);
    int good = 0;
    for (int step = 0; step < 400; ++step) {
      if (!random_step(*block, specimen, step, random)) {
        block->restart();
        continue;
      }
      ++good;
      for (double y : all_outputs(*block)) ASSERT_TRUE(std::isfinite(y)) << "at step " << step;
      for (double rate : block->rates()) ASSERT_TRUE(std::isfinite(rate)) << "a derivative at step " << step;
      for (double x : block->states()) ASSERT_TRUE(std::isfinite(x)) << "a state at step " << step;
      for (const CrossingInfo& crossing : info().crossings)
        ASSERT_FALSE(std::isnan(block->crossing(crossing.name))) << crossing.name << " at step " << step;
    }
    EXPECT_GT(good, 0) << "the block always refuses";
  }
}

TEST_P(Behaviour, ContinuesFromASnapshotBitForBit) {
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    std::mt19937_64 random(4);
    auto first = bench(specimen), second = bench(specimen);
    int step = 0;
    while (step < 30) random_step(*first, specimen, step++, random);
    if (!first->fault().empty()) continue;
    second->restore(first->snapshot());
    std::mt19937_64 same = random;
    for (; step < 60; ++step) {
      random_step(*first, specimen, step, random);
      random_step(*second, specimen, step, same);
      ASSERT_TRUE(equal_bits(all_outputs(*first), all_outputs(*second))) << "at step " << step;
      ASSERT_EQ(first->snapshot(), second->snapshot()) << "at step " << step;
    }
  }
}

TEST_P(Behaviour, ComputingOutputsAgainChangesNothing) {
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    std::mt19937_64 random(5);
    auto block = bench(specimen);
    for (int step = 0; step < 50; ++step) {
      random_step(*block, specimen, step, random);
      const double time = time_of_step(specimen, step + 1);
      randomize_inputs(*block, random);
      block->evaluate(time, step + 1);
      const auto memory = block->snapshot();
      const std::vector<double> outputs = all_outputs(*block);
      block->evaluate_held(time);
      block->derivatives();
      block->crossings();
      block->evaluate_held(time);
      ASSERT_TRUE(equal_bits(all_outputs(*block), outputs));
      ASSERT_EQ(block->snapshot(), memory);
    }
  }
}

TEST_P(Behaviour, StartsAlikeEveryTime) {
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    auto first = bench(specimen), second = bench(specimen);
    ASSERT_EQ(first->snapshot(), second->snapshot());
    std::mt19937_64 random(6), same(6);
    for (int step = 0; step < 20; ++step) random_step(*first, specimen, step, random);
    first->restart();
    ASSERT_EQ(first->snapshot(), second->snapshot()) << "a restart after a run";
    random.seed(7), same.seed(7);
    for (int step = 0; step < 20; ++step) {
      random_step(*first, specimen, step, random);
      random_step(*second, specimen, step, same);
      ASSERT_TRUE(equal_bits(all_outputs(*first), all_outputs(*second)));
    }
  }
}

TEST_P(Behaviour, StopsLieStrictlyAhead) {
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    auto block = bench(specimen);
    for (double begin : {-1.0, 0.0, 0.1, 1.0, 1.0 / 3, 1e3, 1e6, 1e9}) {
      double now = begin;
      for (int i = 0; i < 2000 && now < infinity; ++i) {
        const double next = block->next_stop(now);
        ASSERT_GT(next, now) << "stop " << i << " from " << begin;
        if (i % 7 == 3 && next < infinity) {  // also from times between the stops
          const double between = now + 0.5 * (next - now);
          // TransportDelay reports no discontinuity but keeps steps shorter than its delay.
          const bool is_between = between > now && between < next && info().type != "TransportDelay";
          ASSERT_TRUE(!is_between || block->next_stop(between) == next)
              << "not the stop that was announced before it";
        }
        now = next;
      }
    }
  }
}
LOOPWRIGHT_FOR_EVERY_BLOCK(Behaviour);

// ---- crossings
// --------------------------------------------------------------------------------------------------------

bool crosses(double from, double to, Crossing direction) {
  const bool rises = from <= 0 && to >= 0, falls = from >= 0 && to <= 0;
  return direction == Crossing::rising ? rises : direction == Crossing::falling ? falls : rises || falls;
}

/// The part of a mode that a solver sees.
std::vector<double> visible(BlockUnderTest& block, double time) {
  block.evaluate_held(time);
  block.derivatives();
  std::vector<double> all = all_outputs(block);
  all.insert(all.end(), block.rates().begin(), block.rates().end());
  return all;
}

/// Blocks whose mode also stores values that a solver sees only later, so that some changes need no event.
bool remembers(std::string_view type) {
  return type == "Backlash" ||           // the last output, which the present one follows in any case
         type == "Enable" ||             // the time of the last decision
         type == "Encoder" ||            // zero with its sign
         type == "Integrator" ||         // that the reset fired at the last event, and no more
         type == "MotionFeedforward" ||  // the direction, also where there is no Coulomb friction
         type == "Quantizer";            // zero with its sign
}

/// Blocks whose mode only stores when they started.
bool decides_once(std::string_view type) { return type == "ContinuousPidController"; }

/// Blocks whose output is a pulse of one instant, which ends without an event.
bool pulses(std::string_view type) { return type == "Enable"; }

/// Random walk of the inputs and states of a continuous block. Counts the changes of its mode, and fails if
/// one occurred without a crossing.
int walk(const Specimen& specimen, double stride, std::mt19937_64& random) {
  auto block = bench(specimen);
  const BlockInfo& info = block->info();
  std::uniform_real_distribution uniform(-1.0, 1.0);
  const auto settle = [&](double time, int step) {
    block->evaluate(time, step);
    for (int i = 0; i < 3 && block->jump(); ++i) block->evaluate(time, step);
    if (pulses(info.type)) block->evaluate(std::nextafter(time, 1e9), step);
    block->accept();
    block->crossings();
    block->derivatives();
  };
  int changes = 0;
  double time = 0;
  settle(time, 0);
  for (int step = 1; step < 1500; ++step) {
    std::vector<double> before;
    for (const CrossingInfo& crossing : info.crossings) before.push_back(block->crossing(crossing.name));
    const double stop = block->next_stop(time);
    time = step * 1e-3;
    for (const PortInfo& port : info.inputs)
      for (double& number : block->inputs(port.name)) number += stride * uniform(random);
    for (size_t i = 0; i < block->states().size(); ++i)  // a state that the mode holds does not move
      if (block->rates()[i] != 0) block->states()[i] += stride * uniform(random);
    const std::vector<double> held = visible(*block, time);
    block->crossings();
    bool crossed = stop <= time;
    for (size_t c = 0; c < before.size(); ++c)
      crossed |= crosses(before[c], block->crossing(info.crossings[c].name), info.crossings[c].direction);
    const auto mode = block->snapshot().mode;
    block->decide();
    const bool changed = block->snapshot().mode != mode;
    const bool matters = changed && (!remembers(info.type) || visible(*block, time) != held || block->jump());
    changes += changed;
    EXPECT_TRUE(crossed || !matters) << "the mode changed without a crossing at step " << step
                                     << " of a walk with stride " << stride;
    if (matters && !crossed) return changes;
    settle(time, step);
    if (!block->fault().empty()) return changes;
  }
  return changes;
}

class ModeChanges : public EveryBlock {};

TEST_P(ModeChanges, AreAnnouncedByACrossing) {
  if (!kernels().decide || info().is_sampled || decides_once(info().type))
    GTEST_SKIP() << "no modes that a solver would have to find";
  int changes = 0;
  std::mt19937_64 random(8);
  for (const Specimen& specimen : specimens()) {
    SCOPED_TRACE(specimen.where);
    for (double stride : {1e-6, 1e-4, 1e-2, 0.1, 1.0, 10.0, 1000.0})
      changes += walk(specimen, stride, random);
  }
  EXPECT_GT(changes, 0) << "the mode never changed";
}
LOOPWRIGHT_FOR_EVERY_BLOCK(ModeChanges);

}  // namespace
}  // namespace loopwright::behaviour_test
