#include "engine/diagram/diagram.h"
#include <cmath>
#include <gtest/gtest.h>
#include "tests/engine/diagram/diagram_folder.h"

namespace loopwright::diagram_test {
namespace {

const double pi = std::acos(-1.0);

constexpr std::string_view servo = R"({
  "loopwright": 1,
  "title": "Servo", "description": "A cart under PD control",
  "parameters": {
    "nominal_mass": {"value": 0.2621, "unit": "V*s^2/m", "description": "of the model"},
    "cutoff": {"value": "=2*pi*40", "unit": "rad/s"},
    "travel": {"value": 25, "unit": "mm"},
    "stiffness": "=nominal_mass*cutoff^2",
    "half": 0.5, "file": "measured.csv", "limits": {"value": [-10, "=2*5"], "unit": "mm"}, "smooth": true
  },
  "solver": {"method": "dopri5", "start": 0.5, "stop": "=4*half", "relative_tolerance": 1e-8, "seed": 7},
  "blocks": {
    "reference": {"type": "MotionProfile", "distance": "=travel", "file": "=file", "limits": "=limits", "smooth": "=smooth",
                  "nested": [{"amplitude": "=2*half", "name": "first"}], "amplitude": {"value": 3, "unit": "kN"}},
    "feedback": {"type": "PdController", "sample_time": 0.001, "sample_offset": 0.0005, "Kp": 4056.6, "description": "position loop",
                 "in": {"reference": "reference.position", "measured": "stage.position"}},
    "command": {"type": "Sum", "signs": "+-", "in": {"terms": ["feedback.command", "gain.y[2]"]}},
    "stage": {"diagram": "plants/stage.json", "parameters": {"payload": "=half"}, "in": {"command": "command.sum"}}
  },
  "log": ["reference.position", "stage.mass.velocity", "stage.*"]
})";

constexpr std::string_view stage = R"({
  "loopwright": 1,
  "parameters": {"payload": {"value": 10, "unit": "g"}, "body": {"value": 2, "unit": "kg"}, "total": "=payload+body"},
  "inputs": {"command": "V", "load": {"unit": "N", "description": "pushes"}},
  "outputs": {"position": "mass.position", "speed": {"source": "mass.velocity", "unit": "m/s", "description": "of the cart"}},
  "blocks": {"mass": {"type": "Mass", "mass": "=total", "in": {"force": "command"}}},
  "solver": {"stop": 3}, "log": ["mass.position"]
})";

TEST(Diagram, KeepsTitleBlocksWiresAndPlaces) {
  DiagramFolder folder;
  folder.with("top.json", servo).with("plants/stage.json", stage);
  const auto diagram = folder.load();
  EXPECT_EQ(diagram->title, "Servo");
  EXPECT_EQ(diagram->description, "A cart under PD control");
  EXPECT_EQ(diagram->path, folder.path("top.json"));
  ASSERT_EQ(diagram->blocks.size(), 4u);
  const BlockEntry& feedback = block_of(*diagram, "feedback");
  EXPECT_EQ(feedback.type, "PdController");
  EXPECT_EQ(feedback.place.pointer(), "/blocks/feedback");
  EXPECT_EQ(line_column(feedback.place).line, 15);
  EXPECT_EQ(line_column(feedback.type_place).column, 26);
  EXPECT_EQ(feedback.sample_time->number, 0.001);
  EXPECT_EQ(feedback.sample_offset->number, 0.0005);
  ASSERT_EQ(feedback.settings.members.size(), 1u);  // the engine's own keys are removed
  EXPECT_EQ(feedback.settings.members[0].name, "Kp");
  EXPECT_EQ(source_of(feedback, "measured"), "stage.position");
  const BlockEntry& command = block_of(*diagram, "command");
  EXPECT_TRUE(command.in[0].is_list);
  EXPECT_EQ(source_of(command, "terms", 1), "gain.y[2]");
  EXPECT_EQ(command.in[0].wires[1].place.pointer(), "/blocks/command/in/terms/1");
  EXPECT_FALSE(feedback.in[0].is_list);
  EXPECT_EQ(diagram->log[2].source, "stage.*");
}

TEST(Diagram, ConvertsParametersToSi) {
  DiagramFolder folder;
  folder.with("top.json", servo).with("plants/stage.json", stage);
  const auto diagram = folder.load();
  const Parameter& travel = parameter_of(*diagram, "travel");
  EXPECT_DOUBLE_EQ(travel.value.number, 0.025);
  EXPECT_EQ(to_string(*travel.value.unit), "m");
  EXPECT_EQ(to_string(*travel.unit), "mm");
  EXPECT_DOUBLE_EQ(parameter_of(*diagram, "cutoff").value.number, 80 * pi);
  EXPECT_EQ(parameter_of(*diagram, "nominal_mass").description, "of the model");
  EXPECT_FALSE(parameter_of(*diagram, "half").value.unit);
  EXPECT_EQ(to_string(*parameter_of(*diagram, "stiffness").unit), "V/m");
}

TEST(Diagram, EvaluatesExpressionsAnywhereInSettings) {
  DiagramFolder folder;
  folder.with("top.json", servo).with("plants/stage.json", stage);
  const auto diagram = folder.load();
  const Value& distance = setting_of(*diagram, "reference", "distance");
  EXPECT_DOUBLE_EQ(distance.number, 0.025);
  EXPECT_EQ(to_string(*distance.unit), "m");
  EXPECT_EQ(distance.text, "=travel");
  EXPECT_EQ(distance.place.pointer(), "/blocks/reference/distance");
  EXPECT_EQ(setting_of(*diagram, "reference", "nested").items[0].find("amplitude")->value.number, 1.0);
  EXPECT_EQ(setting_of(*diagram, "reference", "nested").items[0].find("name")->value.text, "first");
  EXPECT_EQ(setting_of(*diagram, "reference", "file").text, "measured.csv");
  EXPECT_TRUE(setting_of(*diagram, "reference", "smooth").boolean);
  EXPECT_DOUBLE_EQ(setting_of(*diagram, "reference", "limits").items[1].number, 0.01);
  EXPECT_DOUBLE_EQ(setting_of(*diagram, "reference", "amplitude").number, 3000);
  EXPECT_EQ(to_string(*setting_of(*diagram, "reference", "amplitude").unit), "N");
  EXPECT_FALSE(setting_of(*diagram, "feedback", "Kp").unit);
}

TEST(Diagram, ReadsSolverSettings) {
  DiagramFolder folder;
  folder.with("top.json", servo).with("plants/stage.json", stage);
  const SolverSettings solver = folder.load()->solver;
  EXPECT_EQ(solver.method.value, "dopri5");
  EXPECT_EQ(solver.start.value, 0.5);
  EXPECT_EQ(solver.stop.value, 2.0);
  EXPECT_EQ(solver.stop.place.pointer(), "/solver/stop");
  EXPECT_EQ(solver.relative_tolerance.value, 1e-8);
  EXPECT_EQ(solver.seed.value, 7u);
  EXPECT_FALSE(solver.step.is_given);
  EXPECT_EQ(solver.algebraic_loops.value, "error");
}

TEST(Subdiagram, TakesItsParametersFromOutside) {
  DiagramFolder folder;
  folder.with("top.json", servo).with("plants/stage.json", stage);
  const auto diagram = folder.load();
  const Diagram& inner = *block_of(*diagram, "stage").subdiagram;
  EXPECT_DOUBLE_EQ(parameter_of(inner, "payload").value.number,
                   0.0005);  // a bare 0.5 in the unit of the parameter, g
  EXPECT_DOUBLE_EQ(setting_of(inner, "mass", "mass").number, 2.0005);
  EXPECT_EQ(to_string(*setting_of(inner, "mass", "mass").unit), "kg");
  EXPECT_EQ(inner.path, folder.path("plants/stage.json"));
}

TEST(Subdiagram, DeclaresInputsAndOutputs) {
  DiagramFolder folder;
  folder.with("top.json", servo).with("plants/stage.json", stage);
  const auto diagram = folder.load();
  const Diagram& inner = *block_of(*diagram, "stage").subdiagram;
  ASSERT_EQ(inner.inputs.size(), 2u);
  EXPECT_EQ(inner.inputs[0].unit, "V");
  EXPECT_EQ(inner.inputs[1].unit, "N");
  EXPECT_EQ(inner.inputs[1].description, "pushes");
  EXPECT_EQ(inner.outputs[0].source.source, "mass.position");
  EXPECT_EQ(inner.outputs[1].unit, "m/s");
}

TEST(Subdiagram, OverrideInAUnitIsConverted) {
  DiagramFolder folder;
  folder.with("stage.json", stage)
      .with("top.json", R"({"loopwright": 1, "parameters": {"load": {"value": 0.3, "unit": "kg"}}, "blocks": {
      "a": {"diagram": "stage.json", "parameters": {"payload": "=2*load"}},
      "b": {"diagram": "stage.json", "parameters": {"payload": 100}},
      "c": {"diagram": "stage.json", "parameters": {"payload": {"value": 5, "unit": "mg"}, "total": 1}}}})");
  const auto diagram = folder.load();
  const auto payload = [&](std::string_view block) {
    return parameter_of(*block_of(*diagram, block).subdiagram, "payload").value.number;
  };
  EXPECT_DOUBLE_EQ(payload("a"), 0.6);
  EXPECT_DOUBLE_EQ(payload("b"), 0.1);
  EXPECT_DOUBLE_EQ(payload("c"), 5e-6);
  EXPECT_EQ(parameter_of(*block_of(*diagram, "c").subdiagram, "total").value.number, 1);
}

TEST(Subdiagram, FilesAreFoundFromTheFileThatNamesThem) {
  DiagramFolder folder;
  folder.with("top.json", R"({"loopwright": 1, "blocks": {"a": {"diagram": "x/middle.json"}}})")
      .with("x/middle.json", R"({"loopwright": 1, "blocks": {"b": {"diagram": "../y/inner.json"}}})")
      .with("y/inner.json",
            R"({"loopwright": 1, "blocks": {"c": {"type": "Table", "file": "data/table.csv"}}})");
  const auto diagram = folder.load();
  const Diagram& inner = *block_of(*block_of(*diagram, "a").subdiagram, "b").subdiagram;
  const Value& file = setting_of(inner, "c", "file");
  EXPECT_EQ(resolve_relative(file.place, file.text), folder.path("y/data/table.csv"));
  EXPECT_EQ(resolve_relative(file.place, "/abs.csv"), "/abs.csv");
  EXPECT_EQ(diagram->files, (std::vector{folder.path("top.json"), folder.path("x/middle.json"),
                                         folder.path("y/inner.json")}));
}

TEST(Subdiagram, OneFileIsReadOnceHoweverItIsSpelled) {
  DiagramFolder folder;
  folder.with("s/stage.json", stage).with("top.json", R"({"loopwright": 1, "blocks": {
      "a": {"diagram": "s/stage.json"}, "b": {"diagram": "s/../s/stage.json"}, "c": {"diagram": "./s/stage.json"}}})");
  EXPECT_EQ(folder.load()->files.size(), 2u);
}

TEST(Subdiagram, MayNestToTheLimit) {
  DiagramFolder folder;
  const auto chain = [&](int depth) {
    for (int i = 0; i < depth - 1; ++i)
      folder.with("d" + std::to_string(i) + ".json", R"({"loopwright": 1, "blocks": {"b": {"diagram": "d)" +
                                                         std::to_string(i + 1) + R"(.json"}}})");
    folder.with("d" + std::to_string(depth - 1) + ".json",
                R"({"loopwright": 1, "blocks": {"b": {"type": "T"}}})");
  };
  chain(32);
  EXPECT_EQ(folder.problems("d0.json"), "");
  chain(33);
  EXPECT_NE(folder.problems("d0.json").find("subdiagrams nest deeper than 32 levels"), std::string::npos);
}

TEST(Variants, TheFirstIsActiveUnlessTheFileOrTheCallerSaysOtherwise) {
  const auto text = [](std::string_view chosen) {
    return R"({"loopwright": 1, "blocks": {"stage": {"variants": {
        "simulated": {"diagram": "stage.json", "parameters": {"payload": 3}},
        "quanser": {"type": "HardwareIo", "device": "qpid.json", "sample_time": 0.001}}, )" +
           std::string(chosen) + R"("in": {"command": "c.y"}}, "c": {"type": "Constant"}}})";
  };
  DiagramFolder folder;
  folder.with("stage.json", stage)
      .with("top.json", text(""))
      .with("other.json", text(R"("variant": "quanser", )"));
  auto diagram = folder.load();
  EXPECT_EQ(block_of(*diagram, "stage").variant, "simulated");
  EXPECT_TRUE(block_of(*diagram, "stage").subdiagram);
  EXPECT_EQ(source_of(block_of(*diagram, "stage"), "command"), "c.y");

  diagram = folder.load("other.json");
  EXPECT_EQ(block_of(*diagram, "stage").variant, "quanser");
  EXPECT_EQ(block_of(*diagram, "stage").type, "HardwareIo");
  EXPECT_EQ(block_of(*diagram, "stage").sample_time->number, 0.001);
  EXPECT_EQ(source_of(block_of(*diagram, "stage"), "command"), "c.y");
  EXPECT_EQ(diagram->files.size(), 1u);  // the simulated stage was not opened

  LoadOptions options;
  options.variants["stage"] = "simulated";
  EXPECT_TRUE(block_of(*folder.load("other.json", options), "stage").subdiagram);
}

TEST(Variants, FilesOfInactiveOnesMayBeAbsent) {
  DiagramFolder folder;
  folder.with("top.json", R"({"loopwright": 1, "blocks": {"stage": {"variants": {
      "simulated": {"type": "Mass"}, "quanser": {"diagram": "no/such.json"}}}}})");
  folder.load();
  LoadOptions options;
  options.variants["stage"] = "quanser";
  EXPECT_NE(folder.problems("top.json", options).find("no/such.json\" cannot be read: there is no such file"),
            std::string::npos);
}

TEST(Variants, AreChosenInsideSubdiagramsByPath) {
  DiagramFolder folder;
  folder
      .with(
          "inner.json",
          R"({"loopwright": 1, "blocks": {"motor": {"variants": {"a": {"type": "A"}, "b": {"type": "B"}}}}})")
      .with(
          "top.json",
          R"({"loopwright": 1, "blocks": {"x": {"diagram": "inner.json"}, "y": {"diagram": "inner.json"}}})");
  LoadOptions options;
  options.variants["y.motor"] = "b";
  const auto diagram = folder.load("top.json", options);
  EXPECT_EQ(block_of(*block_of(*diagram, "x").subdiagram, "motor").type, "A");
  EXPECT_EQ(block_of(*block_of(*diagram, "y").subdiagram, "motor").type, "B");
}

std::string many_blocks(int count) {
  std::string text = R"({"loopwright": 1, "parameters": {"gain": {"value": 2, "unit": "N/m"}}, "blocks": {)";
  for (int i = 0; i < count; ++i) {
    if (i > 0) text += ",\n";
    text += "\"b" + std::to_string(i) +
            R"(": {"type": "Gain", "gain": "=2*gain", "offset": 0.5, "in": {"u": "b)" +
            std::to_string(i / 2) + R"(.y"}})";
  }
  return text + "}}";
}

TEST(Diagram, TensOfThousandsOfBlocksAreRead) {
  DiagramFolder folder;
  folder.with("top.json", many_blocks(40000));
  const auto diagram = folder.load();
  ASSERT_EQ(diagram->blocks.size(), 40000u);
  EXPECT_EQ(diagram->blocks.back().settings.find("gain")->value.number, 4);
}

TEST(Diagram, LongChainsOfParametersNeedNoDeepStack) {
  DiagramFolder folder;
  std::string text = R"({"loopwright": 1, "parameters": {)";
  for (int i = 0; i < 50000; ++i)
    text += "\"p" + std::to_string(i) + "\": \"=p" + std::to_string(i + 1) + "+1\",\n";
  folder.with("top.json", text + "\"p50000\": 1}}");
  EXPECT_EQ(folder.load()->parameters[0].value.number, 50001);
}

TEST(Diagram, UnitsAndBlocksMayBeLeftOut) {
  DiagramFolder folder;
  folder.with("top.json", R"({"loopwright": 1})");
  const auto diagram = folder.load();
  EXPECT_TRUE(diagram->blocks.empty());
  EXPECT_FALSE(diagram->solver.stop.is_given);
}

}  // namespace
}  // namespace loopwright::diagram_test
