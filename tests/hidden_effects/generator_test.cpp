#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

extern "C" {
#include "tests/hidden_effects/scenario.h"
}

namespace generator_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int substeps = 10;

// ---- The plant, compared with analytic solutions

struct Open {
  Physics physics{};
  Plant plant{};
  double time_s = 0;
  explicit Open(const Physics& p, double sample_time = 0.001) : physics(p) {
    plant = plant_at_rest(&physics, sample_time, substeps);
  }
  Open(const Open&) = delete;
  void push(double force_n, double seconds) {
    const int samples = static_cast<int>(std::lround(seconds / plant.sample_time_s));
    for (int i = 0; i < samples; ++i) plant_sample(&plant, force_n, 0);
  }
  double position() const { return plant.state[POSITION]; }
  double velocity() const { return plant.state[VELOCITY]; }
};

Physics body(double mass_kg = 0.25) {
  Physics physics{};
  physics.mass_kg = mass_kg;
  return physics;
}

TEST(Plant, ViscousFrictionGivesAnExponential) {
  Physics physics = body();
  physics.damping_n_s_per_m = 3;
  Open axis(physics);
  axis.push(0.6, 0.2);
  const double tau = 0.25 / 3;
  EXPECT_NEAR(axis.velocity(), 0.2 * (1 - std::exp(-0.2 / tau)), 1e-12);
  EXPECT_NEAR(axis.position(), 0.2 * (0.2 - tau * (1 - std::exp(-0.2 / tau))), 1e-12);
}

TEST(Plant, DryFrictionHoldsUpToItsLevelAndNoFurther) {
  Physics physics = body();
  physics.coulomb_n = 0.3;
  Open axis(physics);
  axis.push(0.299, 0.5);
  EXPECT_EQ(axis.position(), 0);
  axis.push(0.35, 0.5);
  EXPECT_NEAR(axis.position(), 0.5 * (0.05 / 0.25) * 0.25, 1e-12);
}

TEST(Plant, DryFrictionStopsWhatSlides) {
  Physics physics = body();
  physics.coulomb_n = 0.3;
  Open axis(physics);
  axis.plant.direction = -1;
  axis.plant.state[VELOCITY] = -0.1234;
  axis.push(0, 0.3);
  EXPECT_NEAR(axis.position(), -0.1234 * 0.1234 * 0.25 / (2 * 0.3), 1e-11);
  EXPECT_EQ(axis.velocity(), 0);
}

TEST(Plant, StribeckFrictionHoldsAtItsStaticLevelAndFallsWithSpeed) {
  Physics physics = body();
  physics.stribeck = {0.1, 0.25, 0.01, 2};
  Open axis(physics);
  axis.push(0.249, 0.1);
  EXPECT_EQ(axis.position(), 0);
  EXPECT_NEAR(plant_dry_friction(&physics, 0.01, 0), 0.1 + 0.15 * std::exp(-1.0), 1e-15);
  axis.push(0.251, 2);
  EXPECT_GT(axis.velocity(), 0.5);  // off, with a force slightly above the level
}

TEST(Plant, DelayIsExactBetweenSamples) {
  Physics physics = body();
  physics.delay_s = 0.0013;
  Open axis(physics);
  axis.push(0.5, 0.1);
  EXPECT_NEAR(axis.position(), 0.5 * 2 * std::pow(0.1 - 0.0013, 2), 1e-13);
}

TEST(Plant, LagIsOfFirstOrder) {
  Physics physics = body();
  physics.lag_s = 0.003;
  Open axis(physics);
  axis.push(0.5, 0.02);
  EXPECT_NEAR(axis.velocity(), 2 * (0.02 - 0.003 * (1 - std::exp(-0.02 / 0.003))), 1e-10);
}

TEST(Plant, LoadOnASpringSwingsAtItsFrequency) {
  Physics physics = body();
  physics.load_kg = 0.1;
  physics.gap_m = -1;
  physics.coupling_n_per_m = 400;
  Open axis(physics);
  axis.plant.state[LOAD_POSITION] = -0.001;
  axis.push(0, 0.1);
  const double swing = std::sqrt(400 * (1 / 0.15 + 1 / 0.1));
  EXPECT_NEAR(axis.position() - axis.plant.state[LOAD_POSITION], 0.001 * std::cos(swing * 0.1), 1e-9);
  EXPECT_NEAR(0.15 * axis.velocity() + 0.1 * axis.plant.state[LOAD_VELOCITY], 0, 1e-12);
}

TEST(Plant, LoadBeyondAGapIsHitElastically) {
  Physics physics = body();
  physics.load_kg = 0.1;
  physics.gap_m = 0.002;
  physics.coupling_n_per_m = 0.1 * std::pow(2 * pi * 60, 2);
  Open axis(physics);
  axis.plant.direction = 1;
  axis.plant.state[VELOCITY] = 0.1;
  axis.push(0, 0.009);
  EXPECT_EQ(axis.plant.state[LOAD_VELOCITY], 0);
  axis.push(0, 0.016);
  EXPECT_NEAR(axis.velocity(), (0.15 - 0.1) / 0.25 * 0.1, 1e-9);
  EXPECT_NEAR(axis.plant.state[LOAD_VELOCITY], 2 * 0.15 / 0.25 * 0.1, 1e-9);
}

TEST(Plant, HysteresisFollowsDahlInPosition) {
  Physics physics = body(1);
  physics.dahl_n = 1e-13;
  physics.dahl_distance_m = 0.002;
  Open axis(physics);
  axis.plant.direction = 1;
  axis.plant.state[VELOCITY] = 0.05;
  axis.push(0, 0.1);
  const double z = 1 - std::exp(-0.005 / 0.002);
  EXPECT_NEAR(axis.plant.state[DAHL], z, 1e-9);
  axis.plant.direction = -1;
  axis.plant.state[VELOCITY] = -0.05;
  axis.push(0, 0.02);
  EXPECT_NEAR(axis.plant.state[DAHL], -1 + (1 + z) * std::exp(-0.001 / 0.002), 1e-9);
}

TEST(Plant, EndStopReturnsWhatHitsIt) {
  Physics physics = body();
  physics.stop_n_per_m = 900;
  physics.stop_m = 0.01;
  Open axis(physics);
  axis.plant.direction = 1;
  axis.plant.state[VELOCITY] = 0.2;
  axis.push(0, 0.12);
  const double contact_s = pi * std::sqrt(0.25 / 900);
  EXPECT_NEAR(axis.velocity(), -0.2, 1e-9);
  EXPECT_NEAR(axis.position(), 0.01 - 0.2 * (0.12 - 0.05 - contact_s), 1e-10);
}

TEST(Plant, EnergyIsAccountedFor) {
  Physics physics = body();
  physics.damping_n_s_per_m = 3;
  physics.coulomb_n = 0.1;
  physics.quadratic_n_s2_per_m2 = 4;
  physics.spring_n_per_m = 20;
  physics.cubic_n_per_m3 = 500;
  physics.cogging = {0.1, 0.0225, 0.4};
  physics.load_kg = 0.08;
  physics.gap_m = -1;
  physics.coupling_n_per_m = 800;
  physics.coupling_n_s_per_m = 0.2;
  Open axis(physics, 2e-5);
  double work_j = 0, heat_j = 0;
  auto heat_rate = [&] {
    const double* s = axis.plant.state;
    const double v = s[VELOCITY], slip = v - s[LOAD_VELOCITY];
    return 3 * v * v + 0.1 * std::fabs(v) + 4 * std::pow(std::fabs(v), 3) + 0.2 * slip * slip;
  };
  for (int k = 0; k < 50000; ++k) {
    const double force = 2 * std::sin(2 * pi * 1.3 * k * 2e-5) + std::sin(2 * pi * 9 * k * 2e-5);
    const double x = axis.position(), heat = heat_rate();
    plant_sample(&axis.plant, force, 0);
    work_j += force * (axis.position() - x);
    heat_j += 0.5 * 2e-5 * (heat + heat_rate());
  }
  const double* s = axis.plant.state;
  const double x = s[POSITION], wave = 2 * pi / 0.0225;
  const double stored_j = 0.5 * 0.17 * s[VELOCITY] * s[VELOCITY] +
                          0.5 * 0.08 * s[LOAD_VELOCITY] * s[LOAD_VELOCITY] + 0.5 * 20 * x * x +
                          0.25 * 500 * std::pow(x, 4) + 0.5 * 800 * std::pow(x - s[LOAD_POSITION], 2) +
                          0.1 / wave * (std::cos(0.4) - std::cos(wave * x + 0.4));
  EXPECT_GT(heat_j, 0.01);
  EXPECT_NEAR(work_j, stored_j + heat_j, 2e-6 * work_j);
}

// ---- Whole scenarios

struct Made {
  Record record;
  explicit Made(Record made) : record(made) {}
  Made(const Made&) = delete;
  ~Made() { record_free(&record); }
  const Record* operator->() const { return &record; }
};

Scenario hiding(Effect effect, Trajectory trajectory = PAPER, std::uint64_t seed = 7) {
  Scenario scenario;
  EXPECT_TRUE(scenario_hiding(seed, trajectory, &effect, 1, &scenario)) << effect_names[effect];
  return scenario;
}

Record run(const Scenario& scenario, const Noise* noise = nullptr, int steps = substeps) {
  return record_make(&scenario, scenario_truth(&scenario), &scenario.held_out, noise, 0, "test", steps);
}

/// Finer steps change the result by less than a tenth of the encoder's noise, for every hidden effect.
TEST(Scenario, RecordsHaveConverged) {
  for (int effect = 0; effect < EFFECTS; ++effect) {
    const Scenario scenario = hiding(static_cast<Effect>(effect), FORWARD, 11);
    const Made coarse(run(scenario)), fine(run(scenario, nullptr, 3 * substeps));
    double worst = 0;
    for (int k = 0; k < coarse->count; ++k)
      worst = std::fmax(worst, std::fabs(coarse->true_position_m[k] - fine->true_position_m[k]));
    EXPECT_LT(worst, 0.1 * scenario.noise.encoder_m) << effect_names[effect];
  }
}

/// Force that the nominal model cannot explain, from the record alone: central differences and the mean of
/// the held forces, which act together.
double residual(const Scenario& s, const Record& r, int k) {
  const Physics& nominal = s.stages[0];
  const double T = sample_time_s;
  const double v = (r.position_m[k + 1] - r.position_m[k - 1]) / (2 * T);
  const double a = (r.position_m[k + 1] - 2 * r.position_m[k] + r.position_m[k - 1]) / (T * T);
  return 0.5 * (r.force_n[k - 1] + r.force_n[k]) - nominal.mass_kg * a - nominal.damping_n_s_per_m * v -
         periodic(nominal.nominal_cogging, r.position_m[k]);
}

/// The expected form of each effect in that residual, written independently.
double signature(Effect effect, const Physics& p, double x, double v, double a, double u, double t) {
  const double direction = v < 0 ? -1 : 1, speed = std::fabs(v);
  auto wave = [&](const Periodic& w) { return w.amplitude * std::sin(2 * pi * x / w.pitch_m + w.phase_rad); };
  const double drifted = p.drift * (1 - std::exp(-t / (p.drift != 0 ? p.drift_time_s : 1)));
  switch (effect) {
    case INERTIA:
      return p.added_mass_kg * a;
    case VISCOUS_FRICTION:
      return p.added_damping_n_s_per_m * v;
    case COULOMB_FRICTION:
      return p.coulomb_n * direction;
    case STRIBECK_FRICTION:
      return direction * (p.stribeck.level_n +
                          (p.stribeck.static_level_n - p.stribeck.level_n) *
                              std::exp(-std::pow(speed / p.stribeck.speed_m_per_s, p.stribeck.exponent)));
    case DIRECTION_DEPENDENT_FRICTION:
      return p.direction_damping_n_s_per_m * speed;
    case QUADRATIC_DRAG:
      return p.quadratic_n_s2_per_m2 * v * speed;
    case EDDY_CURRENT_DRAG:
      return p.eddy_n_s_per_m * v / (1 + v * v / (p.eddy_speed_m_per_s * p.eddy_speed_m_per_s));
    case COGGING:
      return wave(p.cogging);
    case VELOCITY_DEPENDENT_COGGING:
      return speed * wave(p.moving_cogging);
    case FORCE_RIPPLE:
      return -u * wave(p.ripple);
    case FORCE_GAIN:
      return -u * p.gain;
    case FORCE_SATURATION:
      return u * std::fabs(u) * p.saturation_per_n;
    case CONSTANT_FORCE:
      return p.offset_n;
    case SPRING:
      return p.spring_n_per_m * (x - p.spring_rest_m);
    case HARDENING_SPRING:
      return p.cubic_n_per_m3 * std::pow(x - p.cubic_rest_m, 3);
    case END_STOP:
      return p.stop_n_per_m * std::fmax(0, x - p.stop_m);
    case THERMAL_DRIFT:
      return p.drift_of == DRIFT_OF_OFFSET    ? drifted
             : p.drift_of == DRIFT_OF_DAMPING ? drifted * v
                                              : -u * drifted;
    default:
      return 0;
  }
}

TEST(Scenario, EachEffectLeavesItsSignatureAndNothingElse) {
  for (int i = 0; i < CATALOGUE; ++i) {
    const auto effect = static_cast<Effect>(i);
    if (effect == PRESLIDING_HYSTERESIS || (effect >= BACKLASH && effect != THERMAL_DRIFT))
      continue;  // have a memory
    const Scenario scenario = hiding(effect);
    const Made record(run(scenario));
    const Record& r = record.record;
    double rest = 0, all = 0;
    for (int k = 1; k + 1 < r.count; ++k) {
      if (std::fabs(r.true_velocity_m_per_s[k]) < 0.005) continue;
      const double measured = residual(scenario, r, k), u = 0.5 * (r.force_n[k - 1] + r.force_n[k]);
      const double a =
          (r.true_velocity_m_per_s[k + 1] - r.true_velocity_m_per_s[k - 1]) / (2 * sample_time_s);
      const double expected = signature(effect, *scenario_truth(&scenario), r.true_position_m[k],
                                        r.true_velocity_m_per_s[k], a, u, r.time_s[k]);
      rest += std::pow(measured - expected, 2);
      all += measured * measured;
    }
    EXPECT_LT(rest, 1e-3 * all) << effect_names[effect];
    EXPECT_GT(scenario.effect_force_n[0], 0.005) << effect_names[effect];
  }
}

/// The exact solution over a sample reproduces the noise force from the true velocities.
std::vector<double> noise_force(const Scenario& scenario, const Record& r) {
  const Physics& p = scenario.stages[0];
  const double decay = std::exp(-p.damping_n_s_per_m / p.mass_kg * sample_time_s);
  std::vector<double> noise;
  for (int k = 0; k + 1 < r.count; ++k)
    noise.push_back((r.true_velocity_m_per_s[k + 1] - decay * r.true_velocity_m_per_s[k]) / (1 - decay) *
                        p.damping_n_s_per_m -
                    r.force_n[k]);
  return noise;
}

double covariance(const std::vector<double>& values, std::size_t lag) {
  double sum = 0;
  for (std::size_t k = 0; k + lag < values.size(); ++k) sum += values[k] * values[k + lag];
  return sum / static_cast<double>(values.size() - lag);
}

TEST(Scenario, NoiseIsAsLoudAndAsColouredAsSaid) {
  Scenario scenario;
  ASSERT_TRUE(scenario_hiding(5, CONSTANT_SPEEDS, nullptr, 0, &scenario));
  scenario.stages[0].nominal_cogging.amplitude = 0;
  Noise noise = scenario.noise;
  noise.white_n = 0.01;
  noise.coloured_n = 0.006;
  const Made record(
      record_make(&scenario, scenario_truth(&scenario), &scenario.motion, &noise, 0, "test", substeps));
  const std::vector<double> force = noise_force(scenario, record.record);
  EXPECT_NEAR(covariance(force, 0), 1e-4 + 3.6e-5, 0.05 * 1.36e-4);
  for (std::size_t lag : {10, 30}) {
    const double expected = 3.6e-5 * std::exp(-static_cast<double>(lag) / 30);
    EXPECT_NEAR(covariance(force, lag), expected, 4.5e-6) << lag;
  }
  std::vector<double> seen;
  for (int k = 0; k < record->count; ++k) seen.push_back(record->position_m[k] - record->true_position_m[k]);
  EXPECT_NEAR(std::sqrt(covariance(seen, 0)), noise.encoder_m, 0.02 * noise.encoder_m);
  EXPECT_NEAR(covariance(seen, 1), 0, 0.03 * covariance(seen, 0));
}

TEST(Scenario, SeedsDecideEverythingAndStreamsAreApart) {
  const Scenario one = scenario_draw(3), again = scenario_draw(3);
  ASSERT_EQ(one.effect_count, again.effect_count);
  const Made first(run(one, &one.noise)), second(run(again, &again.noise));
  for (int k = 0; k < first->count; k += 97) ASSERT_EQ(first->position_m[k], second->position_m[k]);
  Random train = random_stream(3, "train"), held_out = random_stream(3, "held out"),
         other = random_stream(4, "train");
  const double drawn = random_unit(&train);
  EXPECT_NE(drawn, random_unit(&held_out));
  EXPECT_NE(drawn, random_unit(&other));
}

TEST(Motion, DerivativesBelongTogether) {
  for (int i = 0; i < TRAJECTORIES; ++i) {
    Random random = random_stream(1, "motion");
    const Motion motion = motion_make(static_cast<Trajectory>(i), &random);
    const double h = 1e-5;
    for (double t = 0.01; t < motion.stop_s - 0.01; t += 0.0137) {
      const Wanted early = motion_at(&motion, t - h), now = motion_at(&motion, t),
                   late = motion_at(&motion, t + h);
      ASSERT_NEAR((late.position_m - early.position_m) / (2 * h), now.velocity_m_per_s, 1e-5)
          << trajectory_names[i] << t;
      ASSERT_NEAR((late.velocity_m_per_s - early.velocity_m_per_s) / (2 * h), now.acceleration_m_per_s2, 1e-2)
          << trajectory_names[i] << t;
    }
    EXPECT_NEAR(motion_at(&motion, motion.stop_s).velocity_m_per_s, 0, 1e-12);
    EXPECT_NEAR(motion.end_m, i == FORWARD ? 0.6 : 0, 1e-9) << trajectory_names[i];
  }
}

}  // namespace

}  // namespace generator_test
