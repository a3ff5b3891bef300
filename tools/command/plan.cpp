#include <fmt/format.h>
#include <optional>
#include "engine/plan/load.h"
#include "engine/record/atomic_file.h"
#include "tools/command/command.h"
#include "tools/draw/diagram_graph.h"
#include "tools/report/graph_picture.h"

namespace loopwright {
namespace {

struct PlanArguments {
  DiagramArguments diagram;
  std::string svg, png;
  std::optional<size_t> depth;
};

void require_sense(const PlanArguments& a) {
  Problems problems;
  if (!a.svg.empty() && a.svg == a.png)
    problems.error({}, "", "", fmt::format("--svg and --png both name {}", a.svg)).expected = "two files";
  if (a.depth && a.svg.empty() && a.png.empty())
    problems.error({}, "", "", "--depth is that of a picture").expected = "--svg FILE or --png FILE";
  if (problems.has_errors()) throw InputError(std::move(problems));
}

/// Draws before it writes: a picture that cannot be made leaves no file. Returns whether it was written.
bool write_picture(const std::string& path, const report::GraphPicture& picture) {
  if (picture.bytes.empty())
    tell("{}: {}\n", path, picture.failure);
  else
    write_file(path, picture.bytes);
  return !picture.bytes.empty();
}

int plan(const PlanArguments& a) {
  require_writable_file(a.svg, "--svg");
  require_writable_file(a.png, "--png");
  require_sense(a);
  const auto [diagram, plan] = load_diagram_and_plan(a.diagram.path, a.diagram.options());
  tell_text(to_text(plan->warnings));
  answer("{}", describe(*plan));
  if (a.svg.empty() && a.png.empty()) return done;
  const report::Graph graph = diagram_graph(*diagram, *plan);
  report::GraphOptions options;
  if (a.depth) options.depth = *a.depth;
  bool written = true;
  if (!a.svg.empty()) written &= write_picture(a.svg, report::draw_svg(graph, options));
  if (!a.png.empty()) written &= write_picture(a.png, report::draw_png(graph, options));
  return written ? done : run_failed;
}

}  // namespace

void add_plan(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command =
      app.add_subcommand("plan", "Show order, rates, states and algebraic loops of a diagram");
  auto a = std::make_shared<PlanArguments>();
  a->diagram.add_to(*command);
  command->add_option("--svg", a->svg, "Draw the diagram into this file (needs node or chromium)");
  command->add_option("--png", a->png, "Draw the diagram into this file (needs chromium)");
  command->add_option("--depth", a->depth, "Open subdiagrams down to this depth in the picture; 0: none")
      ->check(CLI::NonNegativeNumber);
  command->callback([=] { choose([=] { return plan(*a); }); });
}

}  // namespace loopwright
