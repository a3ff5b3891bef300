// The missing force, on records from closed forms: the omitted force must be recovered.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include "tests/engine/written_diagram.h"
#include "tools/compare/compare.h"

namespace loopwright::force_test {
namespace {

constexpr double mass = 2, damping = 5, dt = 1e-3;

/// Forward and back over 0.2 m by sines of changing speed; the force that a machine with one additional
/// effect needs.
struct Record {
  double duration = 12;
  std::function<double(double x, double v, double a, double t)> extra = [](double, double, double, double) {
    return 0.0;
  };
  std::function<double(double t)> phase = [](double t) { return 3 * t + 1.5 * std::sin(0.9 * t); };
  double offset_per_second = 0;  ///< m/s: one way only
  double unit_error = 1;
  double scale = 1;       ///< of the column of the position
  int late = 0;           ///< delay of the force column in samples
  std::vector<int> lost;  ///< samples without a row
  std::function<double(double)> shown = [](double force) { return force; };  ///< in its column

  double x(double t) const { return 0.1 - 0.1 * std::cos(phase(t)) + offset_per_second * t; }
  /// Mean force over the sample after t: the value of a held command.
  double force(double t) const {
    double sum = 0;
    constexpr int parts = 4;
    for (int i = 0; i < parts; ++i) {
      const double s = t + dt * (i + 0.5) / parts, h = 1e-4;
      const double v = (x(s + h) - x(s - h)) / (2 * h), a = (x(s + h) - 2 * x(s) + x(s - h)) / (h * h);
      sum += (mass * a + damping * v + extra(x(s), v, a, s)) / parts;
    }
    return sum * unit_error;
  }
  Comparison compared() const {
    DiagramFolder folder;
    std::string text = "t,F,x\n";
    for (int k = 0; k * dt < duration; ++k)
      if (std::ranges::find(lost, k) == lost.end())
        text +=
            fmt::format("{:.3f},{:.12g},{:.12g}\n", k * dt, shown(force((k - late) * dt)), scale * x(k * dt));
    folder.with("data.csv", text);
    folder.with("axis.json", diagram(R"("push": {"type": "Constant", "value": {"value": 0, "unit": "N"}},
      "viscous": {"type": "ViscousFriction", "damping": 5, "in": {"velocity": "mass.velocity"}},
      "net_force": {"type": "Sum", "signs": "+-", "in": {"terms": ["motor.y", "viscous.force"]}},
      "motor": {"type": "Gain", "gain": {"value": 1, "unit": "1"}, "in": {"u": "push.y"}},
      "mass": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "initial_position": {"value": 0, "unit": "m"}, "in": {"force": "net_force.sum"}})",
                                     R"("method": "rk4", "step": 0.0005, "stop": 1)"));
    folder.with("e.json", R"({"loopwright": 1, "data": "data.csv", "time": "t",
      "drive": {"motor.u": {"column": "F", "unit": "N"}},
      "compare": {"mass.position": {"column": "x", "unit": "m"}},
      "roles": {"position": "mass.position", "velocity": "mass.velocity", "force": "net_force.sum", "input": "motor.u"}})");
    return compare(folder.path("axis.json"), folder.path("e.json"));
  }
};

double share(const Comparison& c, const std::string& variable) {
  for (const Dependence& d : c.force->dependence)
    if (d.variable == variable) return d.share;
  return -1;
}
bool has_fault(const Comparison& c, const std::string& name) {
  return std::ranges::any_of(c.force->faults, [&](const RecordFault& f) { return f.name == name; });
}

TEST(ForceResidual, IsZeroForTheTrueModel) {
  const Comparison c = Record{}.compared();
  ASSERT_TRUE(c.force) << c.why_no_force;
  EXPECT_NEAR(c.force->mass, mass, 1e-4);
  EXPECT_LT(c.force->residual.rmse, 2e-4) << "the input is " << c.force->content.sizes.force_level << " N";
  EXPECT_TRUE(c.force->faults.empty()) << c.force->faults.front().text;
}

TEST(ForceResidual, IsTheForceThatTheModelLacksInItsUnit) {
  Record record;
  record.extra = [](double x, double, double, double) { return 3 * std::sin(40 * x); };
  const Comparison c = record.compared();
  const ForceAnalysis& f = *c.force;
  for (size_t k = 500; k + 500 < f.motion.rows(); k += 37)
    EXPECT_NEAR(f.residual.value[k], 3 * std::sin(40 * f.motion.position[k]), 0.03) << k;
  EXPECT_GT(share(c, "position"), 0.95);
  EXPECT_LT(share(c, "time"), 0.2);
  EXPECT_LT(f.residual.noise_floor, 0.2 * f.residual.rmse);
}

TEST(ForceResidual, FindsThePitchOfAFinePattern) {
  Record record;
  record.extra = [](double x, double, double, double) { return std::sin(2 * M_PI * x / 0.012 + 1); };
  const Comparison c = record.compared();
  for (const Dependence& d : c.force->dependence)
    if (d.variable == "spatial_frequency") {
      EXPECT_GT(d.share, 0.9);
      EXPECT_NEAR(1 / d.at, 0.012, 2e-5);
    }
}

TEST(ForceResidual, NamesTheVariableOnWhichItDepends) {
  struct Case {
    const char* variable;
    std::function<double(double, double, double, double)> extra;
  };
  for (const Case& one :
       {Case{"velocity", [](double, double v, double, double) { return 8 * v * std::abs(v); }},
        Case{"direction", [](double, double v, double, double) { return v > 0 ? 1.0 : -1.0; }},
        Case{"acceleration", [](double, double, double a, double) { return 0.3 * a; }},
        Case{"time", [](double, double, double, double t) { return 0.3 * t; }}}) {
    Record record;
    record.extra = one.extra;
    EXPECT_GT(share(record.compared(), one.variable), 0.85) << one.variable;
  }
}

TEST(ForceResidual, ACommandAtItsLimitIsAFaultAndOneInStepsIsNot) {
  Record record;
  record.shown = [](double force) { return std::clamp(force, -1.5, 1.5); };
  EXPECT_TRUE(has_fault(record.compared(), "saturated"));
  Record resting = record;
  resting.phase = [](double t) { return t < 6 ? 0 : 3 * t + 1.5 * std::sin(0.9 * t); };
  EXPECT_TRUE(has_fault(resting.compared(), "saturated")) << "beside a long rest";
  record.shown = [](double force) { return force < 0 ? -1.5 : 1.5; };
  EXPECT_FALSE(has_fault(record.compared(), "saturated")) << "two levels";
  record.shown = [](double force) { return 1.5 * std::round(std::clamp(force / 1.5, -1.0, 1.0)); };
  EXPECT_FALSE(has_fault(record.compared(), "saturated")) << "three levels";
}

/// A constant is a function of every variable, and none of them explains it.
TEST(ForceResidual, AConstantIsCreditedToNoVariable) {
  Record record;
  record.extra = [](double, double, double, double) { return 2.0; };
  const Comparison constant = record.compared();
  for (const Dependence& d : constant.force->dependence)
    EXPECT_NEAR(d.share, d.variable == "offset" ? 1 : 0, 0.01) << d.variable;
  record.extra = [](double, double v, double, double) { return 2.0 + (v > 0 ? 1 : -1); };
  const Comparison both = record.compared();
  EXPECT_NEAR(share(both, "offset"), 0.8, 0.05);
  EXPECT_GT(share(both, "direction"), 0.85);
}

TEST(ForceResidual, ARepeatedMotionTellsItsNoiseFloor) {
  Record record;
  record.phase = [](double t) { return 2 * M_PI * t / 3; };  // repeats every three seconds
  record.extra = [](double x, double, double, double t) { return 3 * x + 0.05 * std::sin(38.2 * t); };
  const Comparison c = record.compared();
  EXPECT_NEAR(c.force->residual.repeat_s, 3, 0.01);
  EXPECT_NEAR(c.force->residual.noise_floor, 0.05 / std::sqrt(2), 0.02);
}

TEST(ForceResidual, LostRowsShiftNothing) {
  Record few, many;
  few.lost = {2000, 2001, 2002, 5000};
  for (int k = 500; k < 11'500; k += 37) many.lost.push_back(k);
  for (int k = 6000; k < 6300; ++k) many.lost.push_back(k);
  for (const Record& record : {few, many}) {
    const Comparison c = record.compared();
    ASSERT_TRUE(c.force) << c.why_no_force;
    EXPECT_EQ(c.force->motion.rows(), 12'000u) << "every row in its place";
    EXPECT_NEAR(c.force->mass, mass, 1e-3);
    EXPECT_LT(c.force->residual.rmse, 0.02) << "of some 20 N";
    EXPECT_FALSE(has_fault(c, "unsynchronised"));
    EXPECT_TRUE(has_fault(c, "gaps"));
    EXPECT_EQ(c.missing_samples, 12'000 - int64_t(c.time.size()));
    EXPECT_THAT(to_text(c), testing::HasSubstr(fmt::format("{} samples between the", c.missing_samples)));
    EXPECT_LT(c.force->open_loop.restarted[0].second, 1e-4);
  }
}

TEST(ForceResidual, WhereNoRowCountsIsNotZero) {
  Record record;
  for (int k = 5; k < 12'000; k += 8) record.lost.push_back(k);
  const Comparison c = record.compared();
  EXPECT_FALSE(c.force);
  EXPECT_THAT(c.why_no_force, testing::HasSubstr("no row counts"));
}

TEST(RecordFaults, AreNamed) {
  Record one_way;
  one_way.offset_per_second = 1;
  EXPECT_TRUE(has_fault(one_way.compared(), "one_direction"));
  Record grams;
  grams.unit_error = 1000;
  EXPECT_TRUE(has_fault(grams.compared(), "wrong_unit"));
  Record turned;
  turned.unit_error = -1;
  EXPECT_TRUE(has_fault(turned.compared(), "wrong_sign"));
  Record late;
  late.late = 20;
  late.phase = [](double t) { return 8 * t + 3 * std::sin(2 * t); };
  EXPECT_TRUE(has_fault(late.compared(), "unsynchronised"));
  Record brief;
  brief.duration = 1.2;
  EXPECT_TRUE(has_fault(brief.compared(), "too_short"));
}

/// The input of a lift mostly holds its weight, whatever the units are.
TEST(RecordFaults, AreNamedBesideAWeight) {
  Record lift;
  lift.extra = [](double, double, double, double) { return 300.0; };
  EXPECT_FALSE(has_fault(lift.compared(), "wrong_unit"));
  EXPECT_FALSE(has_fault(lift.compared(), "wrong_sign"));
  lift.scale = 180 / std::numbers::pi;
  EXPECT_TRUE(has_fault(lift.compared(), "wrong_unit"));
  lift.scale = -1;
  EXPECT_TRUE(has_fault(lift.compared(), "wrong_sign"));
}

TEST(Excitation, SaysWhatARecordCannotTell) {
  Record one_way;
  one_way.offset_per_second = 1;
  const Comparison c = one_way.compared();
  for (const Identifiability& entry : c.force->identifiable)
    if (entry.effect == "coulomb_friction" || entry.effect == "constant_force") {
      EXPECT_FALSE(entry.can_be_found);
      EXPECT_TRUE(has(entry.lacks, "both directions")) << entry.lacks;
    }
}

TEST(ForceResidual, IsInTheJsonByItsKeys) {
  Record record;
  record.extra = [](double x, double, double, double) { return 3 * std::sin(40 * x); };
  const auto json = nlohmann::json::parse(to_json(record.compared()));
  for (const char* key : {"rmse", "relative_percent", "noise_floor", "unit"})
    EXPECT_TRUE(json.at("force_residual").contains(key)) << key;
  for (const char* key : {"position", "velocity", "acceleration", "direction", "input", "time"})
    EXPECT_TRUE(json.at("dependence").contains(key)) << key;
  double shares = 0;
  for (const auto& entry : json.at("where")) {
    for (const char* key : {"axis", "from", "to", "share"}) EXPECT_TRUE(entry.contains(key)) << key;
    if (entry.at("axis") == "position") shares += entry.at("share").get<double>();
  }
  EXPECT_NEAR(shares, 1, 1e-9);
}

TEST(ForceResidual, WithoutRolesTheReasonIsGiven) {
  DiagramFolder folder;
  folder.with("d.csv", "t,x\n0,0\n0.1,0\n0.2,0\n");
  folder.with("d.json", diagram(R"("mass": {"type": "Mass", "mass": 1, "in": {"force": "push.y"}},
                                   "push": {"type": "Constant", "value": {"value": 0, "unit": "N"}})"));
  folder.with(
      "e.json",
      R"({"loopwright": 1, "data": "d.csv", "compare": {"mass.position": {"column": "x", "unit": "m"}}})");
  const Comparison c = compare(folder.path("d.json"), folder.path("e.json"));
  EXPECT_FALSE(c.force);
  EXPECT_TRUE(has(c.why_no_force, "no roles")) << c.why_no_force;
}

}  // namespace
}  // namespace loopwright::force_test
