// Terms that are added at any port of a diagram.
#include "tools/effects/insert_term.h"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include "engine/diagram/in_memory.h"
#include "engine/plan/plan.h"

namespace loopwright::insert_term_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* machine = R"json({"loopwright": 1,
  "solver": {"method": "rk4", "step": 0.01, "stop": 1},
  "blocks": {
    "none":   {"type": "Constant", "value": {"value": 1, "unit": "N"}},
    "motor":  {"type": "Gain", "gain": 1, "in": {"u": "none.y"}},
    "spring": {"type": "Spring", "stiffness": {"value": 20, "unit": "N/m"}, "in": {"position": "mass.position"}},
    "net":    {"type": "Sum", "signs": "+-", "in": {"terms": ["motor.y", "spring.force"]}},
    "mass":   {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "net.sum"}},
    "pair":   {"type": "TwoMass", "motor_mass": {"value": 2, "unit": "kg"}, "load_mass": {"value": 1, "unit": "kg"},
               "stiffness": {"value": 90, "unit": "N/m"}, "damping": {"value": 1, "unit": "N*s/m"}, "in": {"force": "motor.y"}},
    "inner":  {"in": {"force": "motor.y"}, "diagram": {
      "inputs": {"force": {}}, "outputs": {"speed": "body.velocity"},
      "blocks": {
        "total": {"type": "Sum", "in": {"terms": "force"}},
        "body":  {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "in": {"force": "total.sum"}}}}}
  }})json";

Term drag(const std::string& port, const std::string& speed) {
  return {"drag", "Drag", port, {speed}, R"("type": "Gain", "gain": {"value": -3, "unit": "N*s/m"})", "u"};
}
Term push(const std::string& port) {
  return {"push", "A push", port, {}, R"("type": "Constant", "value": {"value": 3, "unit": "N"})", ""};
}

struct Inserted {
  InsertedTerms terms;
  std::string text = machine, problems;
  nlohmann::json json() const { return nlohmann::json::parse(text); }
  const nlohmann::json block(const std::string& name) const { return json()["blocks"][name]; }

  void add(const Term& term) {
    Problems found;
    const auto file = std::make_shared<SourceFile>(SourceFile{"machine.json", text});
    const auto with = insert_term(file, {}, term, terms, found);
    problems = found.text();
    if (with) text = *with;
  }
  /// Loads, and every wire has a unit.
  void expect_sound() const {
    Problems found;
    const auto diagram =
        load_diagram_text(std::make_shared<SourceFile>(SourceFile{"machine.json", text}), {}, found);
    const auto plan = diagram ? compile(*diagram, found) : nullptr;
    EXPECT_EQ(found.text(), "") << text;
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->without_unit.count, 0u) << to_string(plan->without_unit);
  }
};

TEST(InsertTerm, ASumGetsAFurtherTerm) {
  Inserted i;
  i.add(drag("net.sum", "mass.velocity"));
  EXPECT_EQ(i.block("net")["signs"], "+-+");
  EXPECT_THAT(i.block("net")["in"]["terms"], ElementsAre("motor.y", "spring.force", "drag_share.y"));
  EXPECT_EQ(i.block("drag")["in"]["u"], "mass.velocity");
  EXPECT_EQ(i.json()["parameters"]["with_drag"]["value"], 1);
  EXPECT_THAT(i.terms.taken_out_by, ElementsAre("with_drag"));
  i.add(drag("net.sum", "mass.velocity"));
  EXPECT_EQ(i.block("net")["in"]["terms"][3], "drag_2_share.y") << "a second one has a name of its own";
  i.expect_sound();
}
TEST(InsertTerm, ASumInASubdiagramWithASingleWireToo) {
  Inserted i;
  i.add(drag("inner.total.sum", "inner.body.velocity"));
  const auto inner = i.block("inner")["diagram"];
  EXPECT_THAT(inner["blocks"]["total"]["in"]["terms"], ElementsAre("force", "drag_share.y"));
  EXPECT_THAT(i.terms.taken_out_by, ElementsAre("inner.with_drag"));
  i.expect_sound();
}
TEST(InsertTerm, ReadsASubdiagramThroughItsOutput) {
  Inserted i;
  i.add(drag("net.sum", "inner.body.velocity"));
  EXPECT_EQ(i.block("drag")["in"]["u"], "inner.speed");
  i.expect_sound();
  Inserted hidden;
  hidden.add(drag("net.sum", "inner.body.position"));
  EXPECT_THAT(hidden.problems, HasSubstr("\"inner.body.position\" cannot be read there"));
}
TEST(InsertTerm, AllReadersOfAnOutputReadItWithTheTerm) {
  Inserted i;
  i.add(push("spring.force"));
  EXPECT_THAT(i.block("net")["in"]["terms"], ElementsAre("motor.y", "push_sum.sum"));
  EXPECT_THAT(i.block("push_sum")["in"]["terms"], ElementsAre("spring.force", "push_share.y"));
  i.add(push("spring.force"));
  EXPECT_EQ(i.block("push_sum")["in"]["terms"].size(), 3u) << "a second one is added to the same Sum";
  i.expect_sound();
}
TEST(InsertTerm, AnUnwiredForceGetsAWire) {
  Inserted i;
  i.add(push("pair.load_force"));
  EXPECT_EQ(i.block("pair")["in"]["load_force"], "push_share.y");
  i.expect_sound();
}
TEST(InsertTerm, ADrivenInputIsDrivenBeforeTheTermThatReadsIt) {
  Inserted i;
  i.terms.driven = {"motor.u"};
  Term cut = push("motor.u");
  cut.name = "cut", cut.reads = {"motor.u"}, cut.input = "u";
  cut.settings = R"("type": "Gain", "gain": -0.5)";
  i.add(cut);
  EXPECT_EQ(i.block("motor")["in"]["u"], "cut_sum.sum");
  EXPECT_THAT(i.block("cut_sum")["in"]["terms"], ElementsAre("motor_input.y", "cut_share.y"));
  EXPECT_EQ(i.block("motor_input")["in"]["u"], "none.y");
  ASSERT_EQ(i.terms.moved.size(), 1u);
  EXPECT_EQ(i.terms.moved[0].from, "motor.u");
  EXPECT_THAT(i.terms.moved[0].to, ElementsAre("motor_input.u"));
  i.add(push("motor.u"));
  EXPECT_EQ(i.block("cut_sum")["in"]["terms"].size(), 3u);
  EXPECT_EQ(i.terms.moved.size(), 1u) << "the experiment names one port";
  i.expect_sound();
}
TEST(InsertTerm, ADrivenWireOfAListIsDrivenBeforeTheTermThatReadsIt) {
  Inserted i;
  i.terms.driven = {"net.terms[0]"};
  Term gain = push("net.terms[0]");
  gain.name = "gain", gain.reads = {"net.terms[0]"}, gain.input = "u";
  gain.settings = R"("type": "Gain", "gain": -0.5)";
  i.add(gain);
  EXPECT_EQ(i.problems, "");
  EXPECT_THAT(i.block("net")["in"]["terms"], ElementsAre("gain_sum.sum", "spring.force"));
  EXPECT_THAT(i.block("gain_sum")["in"]["terms"], ElementsAre("net_input.y", "gain_share.y"));
  EXPECT_EQ(i.block("net_input")["in"]["u"], "motor.y");
  ASSERT_EQ(i.terms.moved.size(), 1u);
  EXPECT_EQ(i.terms.moved[0].from, "net.terms[0]");
  EXPECT_THAT(i.terms.moved[0].to, ElementsAre("net_input.u"));
  i.expect_sound();
}
TEST(InsertTerm, ADifferenceIsASumBeforeTheTerm) {
  Inserted i;
  Term slip = drag("net.sum", "mass.velocity");
  slip.reads = {"mass.velocity", "pair.load_velocity"};
  i.add(slip);
  EXPECT_EQ(i.block("drag_difference")["signs"], "+-");
  EXPECT_EQ(i.block("drag")["in"]["u"], "drag_difference.sum");
  i.expect_sound();
}
TEST(InsertTerm, APortThatIsNotThereIsAProblem) {
  Inserted i;
  i.add(push("nowhere.sum"));
  EXPECT_THAT(i.problems, HasSubstr("the term \"push\" cannot be added at \"nowhere.sum\""));
}

}  // namespace
}  // namespace loopwright::insert_term_test
