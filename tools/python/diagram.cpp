#include "tools/python/diagram.h"
#include "tools/python/interruptible.h"
#include "tools/draw/diagram_graph.h"
#include "tools/python/module.h"
#include "tools/run/judged_run.h"
#include "tools/run/run_page.h"

namespace loopwright::python {
namespace {

namespace py = pybind11;

/// A run keeps its diagram and plan: the page needs the blocks and wires.
struct FinishedRun {
  std::shared_ptr<const Diagram> diagram;
  std::shared_ptr<const Plan> plan;
  std::shared_ptr<JudgedRun> judged;

  const RunResult& result() const { return judged->result; }
};

FinishedRun run(const LoadedDiagram& diagram, int64_t number, const std::optional<py::function>& progress) {
  if (number < 0) throw py::value_error("the number of a run is not negative");
  auto judged = std::make_shared<JudgedRun>(interruptible([&](const std::atomic<bool>& interrupt) {
    RunOptions options;
    options.run = number;
    options.interrupt = &interrupt;
    if (progress) options.progress = progress_to(*progress);
    return run_and_judge(diagram.diagram.get(), *diagram.plan, options);
  }));
  return {diagram.diagram, diagram.plan, std::move(judged)};
}

report::Page page_of(const FinishedRun& run) {
  return run_page(run.diagram.get(), *run.plan, run.result(), run.judged->figures);
}

/// The columns live in the result and keep it alive.
std::shared_ptr<Recording> columns(const FinishedRun& run) {
  return {run.judged, &run.judged->result.recording};
}

std::string_view to_name(RunStatus status) {
  switch (status) {
    case RunStatus::finished:
      return "finished";
    case RunStatus::failed:
      return "failed";
    case RunStatus::interrupted:
      return "interrupted";
  }
  return "";
}

py::dict statistics(const FinishedRun& run) {
  const RunStatistics& s = run.result().statistics;
  py::dict events;
  for (const CrossingCount& count : s.events) events[py::str(count.name)] = count.events;
  using py::literals::operator""_a;
  return py::dict("steps"_a = s.steps, "rejected_steps"_a = s.rejected_steps,
                  "derivative_evaluations"_a = s.derivative_evaluations, "restarts"_a = s.restarts,
                  "rows"_a = s.rows, "wall_s"_a = s.wall_seconds, "largest_pole"_a = s.largest_pole,
                  "events"_a = events);
}

/// The diagram alone on a page, as a notebook shows it.
report::Page diagram_page(const LoadedDiagram& diagram) {
  report::Page page;
  page.title = diagram.plan->title.empty() ? diagram.path : diagram.plan->title;
  page.sections.push_back({"Diagram", {diagram_graph(*diagram.diagram, *diagram.plan)}});
  return page;
}

}  // namespace

LoadedDiagram load(const std::string& path, LoadOptions options) {
  const py::gil_scoped_release release;
  auto [diagram, plan] = load_diagram_and_plan(path, options);
  return {path, std::move(options), std::move(diagram), std::move(plan)};
}

void add_diagram(py::module_& module) {
  py::class_<FinishedRun>(module, "FinishedRun")
      .def_property_readonly("status", [](const FinishedRun& r) { return to_name(r.result().status); })
      .def_property_readonly("message", [](const FinishedRun& r) { return r.result().message; })
      .def_property_readonly("time", [](const FinishedRun& r) { return r.result().time; })
      .def_property_readonly("warnings", [](const FinishedRun& r) { return r.result().warnings; })
      .def_property_readonly("columns", &columns)
      .def("statistics", &statistics)
      .def("summary",
           [](const FinishedRun& r) { return run_summary(*r.plan, r.result(), r.judged->figures); })
      .def("html", [](const FinishedRun& r) { return report::to_html(page_of(r)); })
      .def("report",
           [](const FinishedRun& r, const std::string& path) { report::write_html(path, page_of(r)); });
  py::class_<LoadedDiagram>(module, "LoadedDiagram")
      .def_readonly("path", &LoadedDiagram::path)
      .def_property_readonly("set", [](const LoadedDiagram& d) { return d.options.set; })
      .def_property_readonly("variants", [](const LoadedDiagram& d) { return d.options.variants; })
      .def_property_readonly("title", [](const LoadedDiagram& d) { return d.plan->title; })
      .def_property_readonly("hash", [](const LoadedDiagram& d) { return d.plan->hash; })
      .def_property_readonly("parameters",
                             [](const LoadedDiagram& d) { return py::dict(py::cast(d.plan->parameters)); })
      .def_property_readonly("warnings", [](const LoadedDiagram& d) { return d.plan->warnings; })
      .def_property_readonly("log",
                             [](const LoadedDiagram& d) {
                               std::vector<std::string> names;
                               for (const Plan::Logged& logged : d.plan->log) names.push_back(logged.name);
                               return names;
                             })
      .def_property_readonly("ports",
                             [](const LoadedDiagram& d) {
                               std::vector<std::string> names;
                               for (const Plan::Port& port : d.plan->ports) names.emplace_back(port.name);
                               return names;
                             })
      .def("describe", [](const LoadedDiagram& d) { return describe(*d.plan); })
      .def("html", [](const LoadedDiagram& d) { return report::to_html(diagram_page(d)); })
      .def("run", &run, py::arg("run"), py::arg("progress"));
  module.def(
      "load",
      [](const std::string& path, Settings set, std::map<std::string, std::string> variants) {
        LoadOptions options;
        options.set = std::move(set), options.variants = std::move(variants);
        return load(path, std::move(options));
      },
      py::arg("path"), py::arg("set"), py::arg("variants"));
}

}  // namespace loopwright::python
