// Inputs that get to the machine late: a delay, or the lag of an amplifier.
#include <gmock/gmock.h>
#include <cmath>
#include <random>
#include "tests/judgement.h"
#include "tests/tools/diagnose/diagnosed_plant.h"
#include "tools/diagnose/predict/input_lines.h"

namespace loopwright::late_input_test {
namespace {

using namespace diagnosis;
using testing::ElementsAre, testing::IsEmpty;

/// Two records with irregular time stamps.
SignalRecord irregular(BetweenRows between) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0.2, 1.8), level(-3, 5);
  SignalRecord record;
  record.sample_time = 0.01;
  record.inputs.resize(1), record.inputs[0].between_rows = between;
  for (int part = 0; part < 2; ++part) {
    double t = part ? 0.7 : -0.2;
    for (int k = 0; k < 40; ++k, t += 0.01 * uniform(random)) {
      record.time.push_back(t), record.begins.push_back(k == 0);
      record.inputs[0].value.push_back(level(random));
    }
  }
  return record;
}

/// The same by small steps: mean and first moment of f over [t, t + h].
template <class F> InputLine by_small_steps(F&& f, double t, double h) {
  constexpr int steps = 4000;
  double mean = 0, moment = 0;
  for (int i = 0; i < steps; ++i) {
    const double at = (i + 0.5) / steps, value = f(t + at * h);
    mean += value / steps, moment += value * (at - 0.5) / steps;
  }
  const double slope = 12 * moment / h;
  return {mean - slope * h / 2, slope};
}

/// The input at a time; before the record that begins at the row `first` 0.7.
double input_at(const SignalRecord& record, const InputLines& lines, size_t first, size_t last, double time) {
  if (time < record.time[first]) return 0.7;
  size_t row = first;
  while (row < last && record.time[row + 1] <= time) ++row;
  return lines[row].value + lines[row].slope * (time - record.time[row]);
}

class InputLinesOf : public testing::TestWithParam<BetweenRows> {};

TEST_P(InputLinesOf, ADelayHasItsMeansAndMoments) {
  const SignalRecord record = irregular(GetParam());
  const InputLines lines = lines_of(record, record.inputs[0]);
  for (const double delay : {0.0004, 0.003, 0.0271, 0.4}) {
    const InputLines late = delayed(record, lines, delay, 0.7);
    for (size_t row = 0; row < record.rows(); ++row) {
      const size_t first = row < 40 ? 0 : 40;
      const double h = record.step(row);
      const InputLine expected = by_small_steps(
          [&](double t) { return input_at(record, lines, first, row, t - delay); }, record.time[row], h);
      EXPECT_NEAR(late[row].value, expected.value, 2e-2) << row << " " << delay;
      EXPECT_NEAR(late[row].slope * h, expected.slope * h, 4e-2) << row << " " << delay;
    }
  }
}

TEST_P(InputLinesOf, ALagHasItsMeansAndMoments) {
  const SignalRecord record = irregular(GetParam());
  const InputLines lines = lines_of(record, record.inputs[0]);
  for (const double time_constant : {1e-4, 0.004, 0.03, 2.0}) {
    const InputLines late = lagged(record, lines, time_constant, 0.7);
    double z = 0;
    for (size_t row = 0; row < record.rows(); ++row) {
      if (record.begins_at(row)) z = 0.7;
      constexpr int steps = 4000;
      const double h = record.step(row), step = h / steps, kept = std::exp(-step / time_constant);
      const InputLine expected = by_small_steps(
          [&](double t) {
            const double u = lines[row].value + lines[row].slope * (t - record.time[row]);
            const double middle = u + (z - u) * std::sqrt(kept);
            z = u + (z - u) * kept;
            return middle;
          },
          record.time[row], h);
      EXPECT_NEAR(late[row].value, expected.value, 1e-2) << row << " " << time_constant;
      EXPECT_NEAR(late[row].slope * h, expected.slope * h, 2e-2) << row << " " << time_constant;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Inputs, InputLinesOf,
                         testing::Values(BetweenRows::hold, BetweenRows::linear, BetweenRows::band_limited),
                         [](const auto& input) {
                           return std::string(names_of(input.param)[size_t(input.param)]);
                         });

/// What is found: its site, its name and its time. Its interval is narrower than what the mean over a sample
/// leaves open.
void expect_found(const Diagnosis& d, const std::string& what, double time) {
  EXPECT_THAT(terms(d), ElementsAre(what)) << to_text(d);
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  ASSERT_EQ(d.effects.size(), 1u);
  const DiagnosedParameter& p = d.effects.front().parameters.at(0);
  EXPECT_EQ(p.unit, "s");
  EXPECT_NEAR(p.value, time, 0.005 * time);
}

TEST(LateInput, ADelayIsNamed) {
  Plant plant = motor({}, 62);
  plant.delay = 2.4e-3, plant.rows = 1200;
  expect_found(diagnosed(plant), "amplifier.u: delay()", 2.4e-3);
}
TEST(LateInput, ADelayOfAnInputOnLinesIsNamed) {
  Plant plant = motor({}, 63);
  plant.delay = 4e-3, plant.between_rows = BetweenRows::linear, plant.rows = 1200;
  plant.drive = R"("amplifier.u": {"column": "u", "unit": "V", "interpolation": "linear"})";
  expect_found(diagnosed(plant), "amplifier.u: delay()", 4e-3);
}
TEST(LateInput, IsToldApartFromDryFrictionBesideIt) {
  IS_A_JUDGEMENT();
  Motor m;
  m.torque = [](double speed, double) { return 0.004 * std::tanh(speed / 0.5); };
  Plant plant = motor(m, 64);
  plant.delay = 3e-3, plant.rows = 1500;
  const Diagnosis d = diagnosed(plant);
  EXPECT_THAT(terms(d),
              testing::UnorderedElementsAre("amplifier.u: delay()", "torques.sum: sign(rotor.velocity)"))
      << to_text(d);
}
TEST(LateInput, OfAMotorThatGetsItAtOnceNothingIsSaid) {
  const Diagnosis d = diagnosed(motor({}, 65));
  EXPECT_THAT(terms(d), IsEmpty()) << to_text(d);
  EXPECT_EQ(d.verdict, Verdict::nothing_missing);
}

}  // namespace
}  // namespace loopwright::late_input_test
