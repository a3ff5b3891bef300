/// Comparisons, fits, diagnoses, sweeps and linear systems: each as its text, JSON and page.
#include <pybind11/eigen.h>
#include <filesystem>
#include "tools/compare/several.h"
#include "tools/diagnose/diagnose.h"
#include "tools/fit/fit.h"
#include "tools/linearize/analysis.h"
#include "tools/python/diagram.h"
#include "tools/python/interruptible.h"
#include "tools/python/module.h"
#include "tools/sweep/run_sweep.h"
#include "tools/sweep/sweep_page.h"

namespace loopwright::python {
namespace {

namespace py = pybind11;

/// What the commands print, write with --json and show with --report.
struct Answer {
  std::string text, json;
  std::function<std::string()> html;  // empty: there is no page
};

Answer compare_with(const LoadedDiagram& diagram, const std::vector<std::string>& experiments) {
  return interruptible([&](const std::atomic<bool>& interrupt) {
    RunOptions options;
    options.interrupt = &interrupt;
    auto found =
        std::make_shared<SeveralComparisons>(compare(diagram.path, experiments, diagram.options, options));
    return Answer{to_text(*found), to_json(*found), [found] {
                    return report::to_html(comparison_page(*found, found->records.front().plan->title));
                  }};
  });
}

std::pair<Answer, std::string> fit_to(const LoadedDiagram& diagram,
                                      const std::vector<std::string>& experiments,
                                      const std::vector<std::string>& parameters, FitOptions options) {
  return interruptible([&](const std::atomic<bool>& interrupt) {
    options.interrupt = &interrupt;
    auto found = std::make_shared<Fit>(fit(diagram.path, experiments, parameters, diagram.options, options));
    Problems problems;
    std::string text = with_fitted_values(diagram.path, *found, problems);
    if (problems.has_errors()) text.clear();  // values in other files or expressions: there is no such text
    const std::string title = std::filesystem::path(diagram.path).filename().string();
    return std::pair(Answer{to_text(*found), to_json(*found),
                            [found, title] { return report::to_html(fit_page(*found, title)); }},
                     std::move(text));
  });
}

Answer diagnose_with(const LoadedDiagram& diagram, const std::vector<std::string>& experiments,
                     const std::string& improved, bool writes_all) {
  return interruptible([&](const std::atomic<bool>& interrupt) {
    DiagnoseOptions options;
    options.load = diagram.options, options.improved_diagram = improved, options.writes_all = writes_all;
    options.interrupt = &interrupt;
    auto found = std::make_shared<Diagnosis>(diagnose(diagram.path, experiments, options));
    if (found->was_interrupted) return Answer{};
    return Answer{to_text(*found), to_json(*found),
                  [found] { return report::to_html(diagnosis_page(*found)); }};
  });
}

struct SweepAnswer {
  std::shared_ptr<Recording> table;
  std::vector<std::pair<int64_t, std::string>> failures;
  int64_t missing = 0;
  std::vector<std::string> notes;
  std::string html;
};

SweepAnswer sweep(const std::string& file, const std::string& folder, int threads, bool resume,
                  const std::optional<py::function>& progress) {
  return interruptible([&](const std::atomic<bool>& interrupt) {
    Problems problems;
    auto read = load_sweep(file, problems);
    if (!read) throw InputError(std::move(problems));
    const SweepPlan plan(std::move(read));
    SweepOptions options;
    options.threads = threads, options.resume = resume, options.interrupt = &interrupt;
    if (progress)
      options.progress = [tell = progress_to(*progress)](int64_t done, int64_t total) {
        tell(double(done), double(total));
      };
    const SweepOutcome outcome = run_sweep(plan, folder, options);
    SweepResults results = read_results(plan, folder);
    SweepAnswer answer{
        {}, results.failures, results.missing, outcome.notes, report::to_html(sweep_page(plan, results))};
    answer.table = std::make_shared<Recording>(std::move(results.table));
    return answer;
  });
}

std::shared_ptr<LinearAnalysis> linearize(const LoadedDiagram& diagram, LinearizeRequest request) {
  return interruptible([&](const std::atomic<bool>& interrupt) {
    RunOptions options;
    options.interrupt = &interrupt;
    return std::make_shared<LinearAnalysis>(analyse(*diagram.plan, request, options));
  });
}

}  // namespace

void add_answers(py::module_& module) {
  py::class_<Answer>(module, "Answer")
      .def_readonly("text", &Answer::text)
      .def_readonly("json", &Answer::json)
      .def("html", [](const Answer& a) { return a.html ? a.html() : std::string(); });
  module.def("compare", &compare_with);
  module.def("fit", [](const LoadedDiagram& diagram, const std::vector<std::string>& experiments,
                       const std::vector<std::string>& parameters, int iterations,
                       std::vector<std::string> of_each, std::vector<std::string> held_out,
                       const std::map<std::string, std::pair<double, double>>& ranges, bool offsets) {
    FitOptions options;
    options.most_iterations = iterations, options.takes_offsets_out = offsets;
    options.of_each = std::move(of_each), options.held_out = std::move(held_out);
    for (const auto& [path, range] : ranges) options.ranges.push_back({path, range.first, range.second});
    return fit_to(diagram, experiments, parameters, std::move(options));
  });
  module.def("diagnose", &diagnose_with);

  py::class_<SweepAnswer>(module, "SweepAnswer")
      .def_readonly("table", &SweepAnswer::table)
      .def_readonly("failures", &SweepAnswer::failures)
      .def_readonly("missing", &SweepAnswer::missing)
      .def_readonly("notes", &SweepAnswer::notes)
      .def("html", [](const SweepAnswer& a) { return a.html; });
  module.def("sweep", &sweep);

  py::class_<LinearAnalysis, std::shared_ptr<LinearAnalysis>>(module, "LinearAnalysis")
      .def_property_readonly("A", [](const LinearAnalysis& a) { return a.system.matrices.A; })
      .def_property_readonly("B", [](const LinearAnalysis& a) { return a.system.matrices.B; })
      .def_property_readonly("C", [](const LinearAnalysis& a) { return a.system.matrices.C; })
      .def_property_readonly("D", [](const LinearAnalysis& a) { return a.system.matrices.D; })
      .def_property_readonly("dt", [](const LinearAnalysis& a) { return a.system.matrices.sample_time; })
      .def_property_readonly("delays", [](const LinearAnalysis& a) { return a.system.matrices.delays; })
      .def_property_readonly("text", [](const LinearAnalysis& a) { return to_text(a); })
      .def_property_readonly("json", [](const LinearAnalysis& a) { return to_json(a); })
      .def("html", [](const LinearAnalysis& a) { return report::to_html(linear_page(a)); });
  module.def("linearize",
             [](const LoadedDiagram& diagram, std::vector<std::string> from, std::vector<std::string> to,
                std::vector<std::string> open, const std::string& break_point, std::optional<double> at,
                bool continuous, double sample_time) {
               LinearizeRequest request;
               request.access.from = std::move(from), request.access.to = std::move(to),
               request.access.open = std::move(open);
               request.break_point = break_point, request.at = at, request.continuous = continuous;
               request.sample_time = sample_time;
               return linearize(diagram, request);
             });
}

}  // namespace loopwright::python
