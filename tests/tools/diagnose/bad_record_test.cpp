// Records that cannot support a verdict are named, with the consequence.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed_plant.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tests/tools/diagnose/recorded_axis.h"
#include "tools/diagnose/diagnose.h"

namespace loopwright::bad_record_test {
namespace {

using testing::Contains;
using testing::Field;
using testing::HasSubstr;

Diagnosis spoilt(const std::function<void(std::vector<double>&, std::vector<double>&)>& how,
                 double duration_s = 6) {
  Truth truth;
  truth.duration_s = duration_s;
  RecordedAxis axis(truth);
  axis.spoil(how);
  return diagnose(axis.diagram(), {axis.experiment()});
}

auto finds(const char* words) { return Contains(Field(&RecordFinding::what, HasSubstr(words))); }

TEST(BadRecord, AWrongSignIsToldAndNothingIsNamed) {
  const Diagnosis d = spoilt([](auto& force, auto&) {
    for (double& f : force) f = -f;
  });
  EXPECT_THAT(d.findings, finds("pushes against the motion"));
  EXPECT_TRUE(d.effects.empty());
  EXPECT_EQ(d.verdict, Verdict::unexplained);
}

TEST(BadRecord, MillimetresTakenForMetresAreTold) {
  const Diagnosis d = spoilt([](auto&, auto& position) {
    for (double& x : position) x *= 1000;
  });
  EXPECT_THAT(d.findings, finds("times the force that the model needs"));
  EXPECT_TRUE(d.effects.empty());
}

TEST(BadRecord, ColumnsThatAreNotSynchronousAreTold) {
  const Diagnosis d =
      spoilt([](auto& force, auto&) { std::rotate(force.begin(), force.end() - 30, force.end()); });
  EXPECT_THAT(d.findings, finds("fit best when shifted by -"));
}

TEST(BadRecord, TooFewRowsGiveNoVerdict) {
  const Diagnosis d = spoilt([](auto&, auto&) {}, 0.6);
  EXPECT_THAT(d.findings, finds("the machine moves for"));
  EXPECT_TRUE(d.effects.empty());
  EXPECT_EQ(d.verdict, Verdict::unexplained);
}

TEST(BadRecord, OutliersAreCounted) {
  const Diagnosis d = spoilt([](auto&, auto& position) { position[2000] += 1e-3, position[3500] -= 1e-3; });
  EXPECT_THAT(d.findings, finds("2 readings are not those of their rows"));
}

TEST(BadRecord, OldReadingsAreCounted) {
  const Diagnosis d = spoilt([](auto&, auto& position) { position[2000] = position[1999]; });
  EXPECT_THAT(d.findings, finds("1 reading is not that of its row"));
}

TEST(BadRecord, LeapsOfAnyDiagramCountAsMissing) {
  Plant plant = motor({}, 5);
  plant.outputs = [row = 0](const Numbers& x) mutable {
    constexpr double leap_rad = 0.5;
    return Numbers{x[0], ++row % 101 == 0 ? x[1] + leap_rad : x[1]};
  };
  const Diagnosis d = diagnosed(plant);
  EXPECT_EQ(name_of(d.verdict), "nothing_missing") << to_text(d);
  EXPECT_THAT(d.findings, finds("24 readings are not those of their rows"));
}

TEST(BadRecord, LostSamplesAreCountedAndTakenForNoDeadTime) {
  for (const size_t every : {1500, 60}) {
    SCOPED_TRACE(every);
    HiddenMachine machine;
    machine.loses_every = every;
    HiddenAxis axis(machine);
    Physics truth = axis.nominal();
    truth.added_damping_n_s_per_m = 2;
    const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(0.2, 0.4))});
    EXPECT_THAT(names(d), testing::ElementsAre("viscous_friction"));
    EXPECT_EQ(name_of(d.verdict), "explained");
    expect_parameter(d.effects[0], "damping", 2, 0.5, "N*s/m");
    EXPECT_THAT(d.findings, finds("missing at"));
  }
}

}  // namespace
}  // namespace loopwright::bad_record_test
