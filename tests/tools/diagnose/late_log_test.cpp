// A command that the log wrote some rows late. The records are made by an integration of their own.
#include <gmock/gmock.h>
#include <cmath>
#include <numbers>
#include <random>
#include "tests/tools/diagnose/diagnosed_plant.h"
#include "tests/tools/diagnose/plain_axis.h"

namespace loopwright::late_log_test {
namespace {

constexpr double mass = 0.5, damping = 7, coulomb = 1.5, count = 1e-7, sample_time = 5e-4;

/// 8 s of a controller at 2 kHz that follows two sines, with every command written so many rows late.
std::string record(size_t rows_late) {
  constexpr double force_noise = 0.05, stiffness = 4000, gain = 80;
  constexpr size_t rows = 16000;
  constexpr int substeps = 20;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0, 1);
  std::vector<double> position, command;
  double x = 0, v = 0, before = 0;
  for (size_t k = 0; k < rows; ++k) {
    const double t = double(k) * sample_time;
    const double read = count * std::round(x / count);
    const double wanted = 0.05 * std::sin(5 * t) + 0.02 * std::sin(11 * t) - 0.07 * t * std::exp(-t);
    const double u = stiffness * (wanted - read) - gain * (read - before) / sample_time;
    position.push_back(read), command.push_back(u), before = read;
    const double force = u + force_noise * normal(random);
    for (int i = 0; i < substeps; ++i) {  // semi-implicit Euler
      const double h = sample_time / substeps;
      v += h * (force - damping * v - coulomb * std::tanh(v / 1e-4)) / mass, x += h * v;
    }
  }
  std::string text = "t,u [N],x [m]\n";
  for (size_t k = 0; k < rows; ++k)
    text += fmt::format("{:.8g},{:.12g},{:.12g}\n", double(k) * sample_time,
                        k < rows_late ? 0 : command[k - rows_late], position[k]);
  return text;
}

/// `stated`: what the experiment says of it.
Diagnosis diagnosed(size_t rows_late, size_t stated = 0) {
  DiagramFolder folder;
  const std::string columns =
      stated > 0 ? fmt::format(R"(, "columns": {{"u": {{"rows_late": {}}}}})", stated) : "";
  write_plain_axis(folder, {record(rows_late), count, sample_time, 0.25, columns});
  return diagnose(folder.path("axis.json"), {folder.path("e.json")}, {});
}

void expect_friction_alone(const Diagnosis& d) {
  ASSERT_THAT(names(d), testing::ElementsAre("coulomb_friction")) << to_text(d);
  EXPECT_EQ(name_of(d.verdict), "explained") << to_text(d);
  expect_parameter(d.effects[0], "level", coulomb, 0.02, "N");
}

TEST(LateLog, IsReadEarlierAndSaid) {
  for (const size_t rows : {1, 2}) {
    const Diagnosis d = diagnosed(rows);
    expect_friction_alone(d);
    const std::string said = fmt::format("before the record has it: the log wrote each value {} row", rows);
    EXPECT_THAT(findings(d), testing::Contains(testing::HasSubstr(said))) << to_text(d);
  }
}

TEST(LateLog, IsNotFoundWhereTheLogIsRight) {
  const Diagnosis d = diagnosed(0);
  expect_friction_alone(d);
  EXPECT_THAT(findings(d), testing::Not(testing::Contains(testing::HasSubstr("late")))) << to_text(d);
}

TEST(LateLog, MayBeStatedByTheExperiment) {
  const Diagnosis d = diagnosed(1, 1);
  expect_friction_alone(d);
  EXPECT_THAT(findings(d), testing::Not(testing::Contains(testing::HasSubstr("late")))) << to_text(d);
}

}  // namespace
}  // namespace loopwright::late_log_test
