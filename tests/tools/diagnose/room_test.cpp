// Which effects are searched for: those of the catalogue that the diagram allows, and the user's own.
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tools/effects/effect.h"
#include "where.h"

namespace loopwright::room_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

WantedMotion there_and_back() {
  WantedMotion motion;
  motion.rest(0.2);
  for (double speed : {0.4, 0.1, 0.25})
    for (double way : {0.15, -0.15}) motion.stroke(way, speed, 0.1).rest(0.1);
  return motion;
}

std::vector<std::string> not_looked_for(const Diagnosis& d) {
  std::vector<std::string> list;
  for (const NotLookedFor& n : d.not_looked_for) list.insert(list.end(), n.effects.begin(), n.effects.end());
  return list;
}

/// The same axis built from integrators and gains: no block has a mass or a damping as its parameter.
HiddenMachine of_integrators() {
  HiddenMachine machine;
  machine.position_port = "position.y", machine.velocity_port = "velocity.y";
  machine.damping_port = "viscous.y";
  machine.viscous =
      R"("viscous": {"type": "Gain", "gain": {"value": 3, "unit": "N*s/m"}, "in": {"u": "velocity.y"}})";
  machine.further_blocks =
      R"("acceleration": {"type": "Gain", "gain": {"value": "=1/0.2621", "unit": "1/kg"}, "in": {"u": "net_force.sum"}},
    "velocity": {"type": "Integrator", "in": {"u": "acceleration.y"}},)";
  machine.moving = R"("position": {"type": "Integrator", "in": {"u": "velocity.y"}})";
  return machine;
}

TEST(Room, WithoutAMassAndADampingTheirCorrectionsAreNotLookedForAndTheReasonIsTold) {
  HiddenAxis axis(of_integrators());
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.15;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back())});
  ASSERT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
  expect_parameter(d.effects[0], "level", 0.15, 0.01, "N");
  EXPECT_THAT(not_looked_for(d),
              UnorderedElementsAre("inertia", "viscous_friction", "flexible_mode", "backlash"));
  for (const NotLookedFor& n : d.not_looked_for)
    EXPECT_THAT(n.why, HasSubstr("no block with the parameter that it changes")) << n.effects.front();
  EXPECT_THAT(
      to_text(d),
      HasSubstr("Not looked for: inertia; the effect \"inertia\" cannot be added: the machine has no block"));
  const auto json = nlohmann::json::parse(to_json(d));
  EXPECT_EQ(json["not_looked_for"].size(), 4u);
  EXPECT_EQ(json["not_looked_for"][2]["effect"], "inertia");
  EXPECT_EQ(json["not_looked_for"][2]["why"], d.not_looked_for[2].why);
}

TEST(Room, WhatHasNoRoomIsNotNamedEvenWhereItIsTheTruth) {
  HiddenAxis axis(of_integrators());
  Physics truth = axis.nominal();
  truth.added_mass_kg = 0.08;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back())});
  EXPECT_THAT(names(d), Not(Contains("inertia"))) << to_text(d);
  EXPECT_THAT(d.verdict, testing::AnyOf(Verdict::unexplained, Verdict::partly_explained)) << to_text(d);
  EXPECT_THAT(not_looked_for(d), Contains("inertia"));
}

TEST(Room, AnOrdinaryAxisHasRoomForTheWholeCatalogue) {
  HiddenAxis axis;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", axis.nominal(), there_and_back())});
  EXPECT_THAT(not_looked_for(d), IsEmpty());
}

/// Pushed once, then slowed down by friction alone: the ranges of effects do not follow from the input then.
TEST(Room, IsThereForFrictionThatTheInputDoesNotOvercome) {
  HiddenMachine machine;
  machine.has_controller = false;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.15;
  WantedMotion coasting;
  coasting.initial_speed = 0.8;
  coasting.rest(1);
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, coasting)});
  EXPECT_THAT(not_looked_for(d), Not(Contains("coulomb_friction"))) << to_text(d);
  EXPECT_THAT(not_looked_for(d), Not(Contains("viscous_friction")));
  EXPECT_EQ(d.verdict, Verdict::unexplained);  // 0.8 s of one speed are too little for a name
}

/// The effect file that docs/effects.md shows.
void write_bump(const std::string& path) {
  std::ifstream in(LOOPWRIGHT_SOURCE "/docs/effects.md");
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const size_t begin = text.find("```json\n") + 8;
  std::ofstream(path) << text.substr(begin, text.find("```", begin) - begin);
}

TEST(UsersCatalogue, ABumpIsNamedOnceItsFileIsThere) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.bump_n = 0.3, truth.bump_m = 0.06, truth.bump_width_m = 0.01;
  const std::string experiment = axis.record("record", truth, there_and_back());
  const Diagnosis without = diagnose(axis.diagram(), {experiment});
  EXPECT_THAT(without.verdict, testing::AnyOf(Verdict::unexplained, Verdict::partly_explained));

  std::filesystem::create_directory(axis.file("own"));
  write_bump(axis.file("own/bump.json"));
  DiagnoseOptions options;
  options.catalogues = {catalogue_folder(), axis.file("own")};
  options.improved_diagram = axis.file("improved.json");
  const Diagnosis d = diagnose(axis.diagram(), {experiment}, options);
  EXPECT_EQ(d.verdict, Verdict::explained);
  ASSERT_THAT(names(d), ElementsAre("bump")) << to_text(d);
  expect_parameter(d.effects[0], "height", 0.3, 0.02, "N");
  expect_parameter(d.effects[0], "place", 0.06, 5e-4, "m");
  expect_parameter(d.effects[0], "width", 0.01, 5e-4, "m");

  const Diagnosis improved = diagnose(d.improved, {experiment}, options);
  EXPECT_EQ(improved.verdict, Verdict::nothing_missing) << to_text(improved);
}

TEST(UsersCatalogue, MayBeAPartOfTheBuiltInOne) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.15;
  const std::string experiment = axis.record("record", truth, there_and_back());
  std::filesystem::create_directory(axis.file("part"));
  for (const char* name : {"coulomb_friction.json", "viscous_friction.json", "inertia.json"})
    std::filesystem::copy(catalogue_folder() + "/" + name, axis.file("part/" + std::string(name)));
  DiagnoseOptions options;
  options.catalogues = {axis.file("part")};
  const Diagnosis d = diagnose(axis.diagram(), {experiment}, options);
  EXPECT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
}

/// Such a file can be inserted into a diagram; there is nothing to look for.
TEST(UsersCatalogue, AnEffectOfWhichNothingIsFittedIsNotLookedFor) {
  HiddenAxis axis;
  const std::string experiment = axis.record("record", axis.nominal(), there_and_back());
  std::filesystem::create_directory(axis.file("own"));
  std::ofstream(axis.file("own/known.json")) << R"({
  "loopwright": 1, "effect": "known", "title": "Known", "physics": "Known from elsewhere.",
  "parameters": {"damping": {"unit": "$force*s/$position", "value": "=0.1*force_level/top_speed"}},
  "blocks": {"drag": {"type": "ViscousFriction", "damping": "=damping", "in": {"velocity": "velocity"}}},
  "attach": [{"to": "force", "from": "drag.force"}], "needs": {"text": ""}
})";
  DiagnoseOptions options;
  options.more_catalogues = {axis.file("own")};
  EXPECT_THAT(not_looked_for(diagnose(axis.diagram(), {experiment}, options)), Contains("known"));
}

}  // namespace
}  // namespace loopwright::room_test
