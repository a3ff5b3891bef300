/// A page with all elements, as a comparison would give it. The data are synthetic.
#pragma once
#include <stdexcept>
#include <tuple>
#include <algorithm>
#include <cmath>
#include <random>
#include "tools/report/graph.h"
#include "tools/report/report.h"

namespace loopwright::report {

/// A second-order servo loop on a linear stage, 2.6 s at 1 kHz: forward and back by 0.1 m, with friction and
/// cogging.
struct ServoRun {
  std::vector<double> time, reference, position, error, velocity, command, disturbance, residual;
};

inline ServoRun servo_run(double stop = 2.6) {
  ServoRun run;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 1.0);
  const double step = 1e-3, pi = 3.14159265358979;
  for (int k = 0; k * step <= stop; ++k) {
    const double t = k * step, phase = std::fmod(t, 2.6);
    // Smooth moves of 0.8 s that end in a rest: a sine in acceleration.
    const auto move = [&](double start) {
      const double s = std::clamp((phase - start) / 0.8, 0.0, 1.0);
      return s - std::sin(2 * pi * s) / (2 * pi);
    };
    const auto speed = [&](double start) {
      const double s = std::clamp((phase - start) / 0.8, 0.0, 1.0);
      return (1 - std::cos(2 * pi * s)) / 0.8;
    };
    const double reference = 0.1 * (move(0.2) - move(1.4)), velocity = 0.1 * (speed(0.2) - speed(1.4));
    const double friction = 1.9 * std::tanh(velocity / 0.004) + 3.0 * velocity;
    const double cogging = 0.55 * std::sin(2 * pi * reference / 0.024 + 0.4);
    const double error = 2.6e-6 * friction + 5e-6 * cogging + 2.4e-7 * noise(random);
    run.time.push_back(t);
    run.reference.push_back(reference);
    run.velocity.push_back(velocity);
    run.error.push_back(error);
    run.position.push_back(reference - error);
    run.command.push_back(friction + cogging + 0.05 * noise(random));
    run.disturbance.push_back(friction + cogging);
    run.residual.push_back(0.6 * std::tanh(velocity / 0.01) + 0.3 * cogging + 0.06 * noise(random));
  }
  return run;
}

/// Adds a node with ports by name.
inline void add_node(Graph& graph, std::string path, std::string type, std::string room,
                     const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
  GraphNode node{std::move(path), std::move(type), std::move(room), {}, {}, {}, ""};
  for (const std::string& name : inputs) node.inputs.push_back({name, "", "", -1});
  for (const std::string& name : outputs) node.outputs.push_back({name, "", "", 0});
  graph.nodes.push_back(std::move(node));
}

/// "stage>command": an input of the subdiagram stage as seen from inside, or an output of it.
inline GraphEnd graph_end(const Graph& graph, std::string_view text, GraphEnd::Side side) {
  const std::size_t inner = text.find('>'), cut = inner != text.npos ? inner : text.rfind('.');
  if (inner != text.npos)
    side = side == GraphEnd::Side::output ? GraphEnd::Side::input : GraphEnd::Side::output;
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    const auto& ports = side == GraphEnd::Side::input ? graph.nodes[n].inputs : graph.nodes[n].outputs;
    for (std::size_t p = 0; p < ports.size(); ++p)
      if (graph.nodes[n].path == text.substr(0, cut) && ports[p].name == text.substr(cut + 1))
        return {n, side, p};
  }
  throw std::invalid_argument("no port " + std::string(text));
}

inline void add_wire(Graph& graph, std::string_view from, std::string_view to, const std::string& unit) {
  const GraphEnd source = graph_end(graph, from, GraphEnd::Side::output);
  GraphNode& node = graph.nodes[source.node];
  (source.side == GraphEnd::Side::output ? node.outputs : node.inputs)[source.port].unit = unit;
  graph.edges.push_back({source, graph_end(graph, to, GraphEnd::Side::input)});
}

inline Graph servo_graph() {
  Graph graph{"Linear motor stage with feedforward and disturbance observer", {"1 ms"}, {}, {}};
  add_node(graph, "reference", "MotionProfile", "sources", {}, {"position", "velocity", "acceleration"});
  add_node(graph, "feedback", "PdController", "control", {"reference", "measured"}, {"command"});
  add_node(graph, "feedforward", "Feedforward", "control", {"velocity", "acceleration"}, {"command"});
  add_node(graph, "observer", "DisturbanceObserver", "control", {"command", "position"}, {"disturbance"});
  add_node(graph, "command", "Sum", "math", {"terms[0]", "terms[1]", "terms[2]"}, {"sum"});
  add_node(graph, "stage", "stage.json", "subdiagram", {"command"}, {"position"});
  add_node(graph, "stage.motor", "LinearMotor", "mechanics", {"command"}, {"force"});
  add_node(graph, "stage.friction", "ViscousFriction", "mechanics", {"velocity"}, {"force"});
  add_node(graph, "stage.net_force", "Sum", "math", {"terms[0]", "terms[1]"}, {"sum"});
  add_node(graph, "stage.mass", "Mass", "mechanics", {"force"}, {"position", "velocity"});
  add_node(graph, "encoder", "Encoder", "sensors", {"position"}, {"measured"});
  GraphNode& sum = graph.nodes[8];
  sum.face.shape = GraphFace::Shape::circle;
  sum.inputs[0].sign = "+", sum.inputs[1].sign = "−";
  graph.nodes[7].face.strokes = {{{-1, -1}, {1, 1}}};
  graph.nodes[9].face.numerator = "1", graph.nodes[9].face.denominator = "m s²";
  for (const auto& [from, to, unit] : std::vector<std::tuple<const char*, const char*, const char*>>{
           {"reference.position", "feedback.reference", "m"},
           {"reference.velocity", "feedforward.velocity", "m/s"},
           {"reference.acceleration", "feedforward.acceleration", "m/s^2"},
           {"encoder.measured", "feedback.measured", "m"},
           {"feedback.command", "command.terms[0]", "V"},
           {"feedforward.command", "command.terms[1]", "V"},
           {"observer.disturbance", "command.terms[2]", "V"},
           {"command.sum", "stage.command", "V"},
           {"command.sum", "observer.command", "V"},
           {"encoder.measured", "observer.position", "m"},
           {"stage>command", "stage.motor.command", "V"},
           {"stage.motor.force", "stage.net_force.terms[0]", "N"},
           {"stage.friction.force", "stage.net_force.terms[1]", "N"},
           {"stage.net_force.sum", "stage.mass.force", "N"},
           {"stage.mass.velocity", "stage.friction.velocity", "m/s"},
           {"stage.mass.position", "stage>position", "m"},
           {"stage.position", "encoder.position", "m"}})
    add_wire(graph, from, to, unit);
  return graph;
}

inline std::vector<Item> servo_plots(const ServoRun& run) {
  const Axis time{"Time", "s"};
  std::vector<double> coarse_time, coarse_command;
  for (std::size_t i = 0; i < run.time.size(); i += 20) {
    coarse_time.push_back(run.time[i]);
    coarse_command.push_back(run.command[i]);
  }
  return {
      Plot{"Position",
           time,
           {"Position", "m"},
           {{"reference", run.time, run.reference}, {"measured", run.time, run.position}},
           "run",
           ""},
      Plot{
          "Tracking error", time, {"Error", "m"}, {{"reference − measured", run.time, run.error}}, "run", ""},
      Plot{"Command and what the observer makes of it",
           time,
           {"Command", "V"},
           {{"command", run.time, run.command},
            {"observer.disturbance", run.time, run.disturbance},
            {"command every 20 ms", coarse_time, coarse_command, Series::Shape::steps}},
           "run",
           "The three plots share their time axis."}};
}

inline Plot bode_plot() {
  Plot plot{"Open loop, magnitude", {"Frequency", "Hz", true}, {"Magnitude", "1", true}, {}, "", ""};
  Series model{"model", {}, {}}, measured{"measured", {}, {}, Series::Shape::points};
  for (double f = 0.5; f < 480; f *= 1.06) {
    const double w = f / 30;
    model.x.push_back(f);
    model.y.push_back(1 / (w * std::sqrt(1 + w * w)));
    measured.x.push_back(f);
    measured.y.push_back(model.y.back() * (1 + 0.12 * std::sin(9 * f)));
  }
  plot.series = {model, measured};
  return plot;
}

inline Page sample_page() {
  const ServoRun run = servo_run();
  Page page{"Linear motor stage: model against measurement",
            "PD with feedforward and disturbance observer, moves of 100 mm in 0.8 s",
            {{"Diagram", "diagrams/linear_motor/stage.json"},
             {"Experiment", "stage.experiment.json"},
             {"Solver", "rk4, step 0.1 ms"},
             {"Data", "2 601 samples at 1 kHz"}},
            {}};

  Section summary{"Summary", {}};
  summary.items.push_back(KeyNumbers{{{"Tracking error, RMS", "4.31", "um", "was 14.2 µm"},
                                      {"Largest error", "9.87", "um", "at 0.412 s"},
                                      {"Fit", "99.2", "%", "on held-out data"},
                                      {"Force residual", "0.47", "N", "noise floor 0.06 N"}}});
  summary.items.push_back(
      Paragraph{"The model explains the motion but not all of the force: what is left follows the direction "
                "of motion and the "
                "position with a period of 24 mm, the pole pitch of the motor."});
  summary.items.push_back(
      Notice{Notice::Severity::warning,
             "The experiment never moves faster than 0.25 m/s; terms with the square of the speed cannot "
             "be told from viscous friction."});

  Section diagram{"Diagram", {servo_graph()}};
  Section signals{"Signals", servo_plots(run)};

  Section residual{"What the model leaves", {}};
  residual.items.push_back(Plot{"Force residual against velocity",
                                {"Velocity", "m/s"},
                                {"Residual", "N"},
                                {{"residual", run.velocity, run.residual, Series::Shape::points}},
                                "",
                                "The step at zero speed is dry friction."});
  residual.items.push_back(bode_plot());
  residual.items.push_back(Table{{"Effect", "Parameter", "Value", "Unit", "95 % interval", "Inclusion"},
                                 {{"Coulomb friction", "level", "0.612", "N", "0.604 … 0.620", "1.00"},
                                  {"Cogging, 24 mm", "amplitude", "0.165", "N", "0.158 … 0.172", "1.00"},
                                  {"Cogging, 24 mm", "phase", "0.41", "rad", "0.36 … 0.46", "1.00"},
                                  {"Drag", "coefficient", "-0.03", "N*s^2/m^2", "-0.21 … 0.15", "0.04"}},
                                 "Effects that were tried"});
  residual.items.push_back(
      Notice{Notice::Severity::good, "Two effects bring the residual to the noise floor."});
  residual.items.push_back(
      Code{"\"friction\": {\"type\": \"CoulombFriction\", \"level\": {\"value\": 0.612, \"unit\": \"N\"},\n"
           "             \"in\": {\"velocity\": \"mass.velocity\"}}",
           "improved.json"});
  page.sections = {summary, diagram, signals, residual};
  return page;
}

}  // namespace loopwright::report
