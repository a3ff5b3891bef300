// The prediction errors, and the filters that describe their response to forces.
#include "tools/diagnose/predict/responses.h"
#include <cmath>
#include "engine/run/run.h"
#include "tests/engine/written_diagram.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tests/tools/diagnose/recorded_axis.h"

namespace loopwright::diagnosis::predictor_test {
namespace {

Noise noise_of_record() {
  Noise noise;
  noise.white = 0.01, noise.memory = 0.967, noise.step = 0.003 * std::sqrt(1 - 0.967 * 0.967);
  noise.measurement = {7.6e-8};
  return noise;
}

constexpr Pace waits{0.002, 15, 50};

struct Predicted {
  RecordedAxis files;
  AxisModel model;
  LinearAxis axis;
  Gains gains;
  Drives drives;

  explicit Predicted(const Truth& truth)
      : files(truth),
        model(files.diagram(), files.experiment(), {}),
        axis(model.linearize()),
        gains(gains_of(axis, noise_of_record(), model.nominal_inertia())),
        drives{model.record().input, std::vector<double>(model.record().rows(), 0.0), {}, {}, {}} {}
  Prediction run() { return predict(model, axis, gains, drives, waits); }
};

Truth short_record() {
  Truth truth;
  truth.duration_s = 4;
  return truth;
}

TEST(Predictor, InertiaAndDampingAreReadOffTheDiagram) {
  Predicted p(short_record());
  EXPECT_NEAR(p.axis.inertia, 0.2621, 1e-6);
  EXPECT_NEAR(p.axis.damping, 3, 1e-3);
}

TEST(Predictor, ErrorsOfARightDiagramAreWhiteAndAsLargeAsTheNoiseSays) {
  Predicted p(short_record());
  std::vector<double> e = p.run().error;
  whiten(e, p.gains);
  double square = 0, next = 0;
  for (size_t k = 400; k < e.size(); ++k) square += e[k] * e[k], next += e[k] * e[k - 1];
  EXPECT_NEAR(square / double(e.size() - 400), 1, 0.06);
  EXPECT_NEAR(next / square, 0, 0.05);
}

/// A force that rises by one unit within a sample, around zero: v' = (f - D v) / M, integrated finely.
TEST(Predictor, AForceThatRisesWithinASampleMovesADampedAxisToo) {
  HiddenMachine machine;
  machine.damping = 60;
  HiddenAxis axis(machine);
  AxisModel model(axis.diagram(), axis.record("damped", axis.nominal(), there_and_back(0.1, 0.2)), {});
  const LinearAxis linear = model.linearize();
  constexpr int parts = 100000;
  constexpr double dt = hidden_sample_time / parts;
  double x = 0, v = 0;
  for (int i = 0; i < parts; ++i) {
    const double force = (i + 0.5) / parts - 0.5;
    v += dt * (force - machine.damping * v) / machine.mass, x += dt * v;
  }
  const Eigen::VectorXd moved = linear.slope_share.cwiseProduct(linear.push);
  const Eigen::Index position = std::abs(linear.push[0]) < std::abs(linear.push[1]) ? 0 : 1;
  EXPECT_NEAR(moved[position], x, 1e-3 * std::abs(x));
  EXPECT_NEAR(moved[1 - position], v, 1e-3 * std::abs(v));
}

TEST(Predictor, AForceChangesTheErrorsAsItsFilterSays) {
  Predicted p(short_record());
  const Prediction without = p.run();
  std::vector<float> mean, slope;
  for (size_t k = 0; k < p.drives.force.size(); ++k) {
    mean.push_back(float(0.01 * std::sin(0.02 * double(k))));
    slope.push_back(float(0.05 * std::cos(0.03 * double(k))));
    p.drives.force[k] = double(mean.back());
    p.drives.force_slope.push_back(double(slope.back()));
  }
  std::vector<double> change = p.run().error;
  for (size_t k = 0; k < change.size(); ++k) change[k] -= without.error[k];
  whiten(change, p.gains);
  const Columns columns{Column(mean, slope)};
  const std::vector<double> expected =
      responses(p.axis, p.gains, without.path, Acts::force, pointers(columns)).front();
  double off = 0, size = 0;
  for (size_t k = 0; k < change.size(); ++k)
    off += std::pow(change[k] + expected[k], 2), size += expected[k] * expected[k];
  EXPECT_LT(off, 1e-4 * size) << "consumed by the model instead of by the axis: the other sign";
}

/// As many masses as a belt in parts has, and more than the sizes that are known at compile time.
TEST(Predictor, AnAxisWithManyStatesAnswersLikeItsMatrices) {
  constexpr Eigen::Index states = 31;
  Predicted p(short_record());
  const Path path = p.run().path;
  LinearAxis axis = p.axis;
  std::srand(1);
  axis.A = Eigen::MatrixXd::Random(states, states) * 0.1;
  axis.C = Eigen::MatrixXd::Random(1, states);
  axis.push = axis.noise_push = Eigen::VectorXd::Random(states);
  axis.slope_share = Eigen::VectorXd::Random(states);
  const Gains gains = gains_of(axis, noise_of_record(), axis.inertia);
  std::vector<float> mean, slope;
  for (size_t k = 0; k < path.samples(); ++k)
    mean.push_back(float(std::sin(0.02 * double(k)))), slope.push_back(float(std::cos(0.03 * double(k))));
  const Columns columns{Column(mean, slope)};
  const std::vector<double> response = responses(axis, gains, path, Acts::force, pointers(columns)).front();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(states);
  double slow = 0, off = 0, size = 0;
  for (size_t k = 0; k < path.samples(); ++k) {
    const double error = axis.C.row(0).dot(x), white = gains.whiten(0, 0) * error;
    off += std::pow(response[k] - white, 2), size += white * white;
    x -= gains.K.col(0).head(states) * error, slow -= gains.K(states, 0) * error;
    if (path.forgets(k)) slow = 0;
    x = axis.A * x + axis.push * (slow - double(mean[k])) -
        axis.slope_share.cwiseProduct(axis.push) * double(slope[k]);
    slow *= gains.memory;
  }
  EXPECT_GT(size, 0);
  EXPECT_LT(off, 1e-20 * size);
}

TEST(Predictor, OtherGainsNeedNoOtherRun) {
  Predicted p(short_record());
  const Prediction first = p.run();
  Noise other = noise_of_record();
  other.white *= 3, other.measurement[0] *= 0.5, other.memory = 1, other.step = 0.002;
  const Gains gains = gains_of(p.axis, other, p.model.nominal_inertia());
  const std::vector<double> expected = predict(p.model, p.axis, gains, p.drives, waits).error;
  std::vector<double> error;
  with_gains(p.axis, first, p.gains, gains, error);
  double off = 0, size = 0;
  for (size_t k = 0; k < error.size(); ++k)
    off += std::pow(error[k] - expected[k], 2), size += expected[k] * expected[k];
  EXPECT_LT(off, 1e-3 * size) << "the same but for samples near rest, where the two see other speeds";
}

TEST(Predictor, GainsFoundRowByRowAreTheSteadyOnesWhereNothingChanges) {
  Predicted p(short_record());
  const auto steps = GainSteps::of(p.axis, {}, noise_of_record(), p.model.nominal_inertia());
  Gains::Rows rows;
  constexpr size_t count = 2000;
  for (size_t k = 0; k < count; ++k) steps->correct(rows), steps->advance(p.axis.A);
  const size_t size = size_t(p.gains.K.size());
  for (const size_t row : {size_t(0), count - 1}) {
    for (size_t i = 0; i < size; ++i)
      EXPECT_NEAR(rows.K[row * size + i] / p.gains.K.data()[i], 1, 1e-6) << "row " << row << ", " << i;
    EXPECT_NEAR(rows.whiten[row] / p.gains.whiten(0, 0), 1, 1e-6);
    EXPECT_NEAR(rows.log_determinant[row], p.gains.log_determinant, 1e-6);
  }
}

/// A record may need several steps in a sample, or have samples of any length. A delayed command still
/// arrives.
TEST(Predictor, SampledBlocksRunAtTheirSamplesWhateverTheStep) {
  const auto plan = plan_of(R"({"loopwright": 1, "solver": {"step": 0.001, "stop": 1}, "blocks": {
    "command": {"type": "Constant", "value": 3},
    "late": {"type": "FractionalDelay", "delay": 0.0025, "sample_time": 0.001, "in": {"u": "command.y"}},
    "way": {"type": "Integrator", "in": {"u": "late.y"}}}})");
  AxisRecord record;
  record.sample_time = 0.001;
  for (const int steps : {1, 4}) {
    Plan shorter = *plan;
    const double ticks = step_by_samples(shorter, record, steps);
    loopwright::Run<double> run(shorter);
    run.reset({plan->seed, 0});
    constexpr int samples = 10;
    const int64_t end = std::llround(samples * ticks);
    while (run.now().tick < end) run.step_fixed(end, false, [] {});
    EXPECT_NEAR(run.number(plan->find("way.y").front()), 3 * (0.010 - 0.0025), 1e-12) << steps << " steps";
  }
}

}  // namespace
}  // namespace loopwright::diagnosis::predictor_test
