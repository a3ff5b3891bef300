#include <fmt/format.h>
#include "engine/record/atomic_file.h"
#include "tools/command/command.h"
#include "tools/run/run_page.h"

namespace loopwright {
namespace {

void write_picture(const Plan& plan, const std::string& path) {
  for (const report::Item& item : report::graph_picture(graph_of(plan))) {
    if (const auto* picture = std::get_if<report::Picture>(&item)) write_file(path, picture->svg);
    if (const auto* notice = std::get_if<report::Notice>(&item)) tell("{}\n", notice->text);
  }
}

}  // namespace

void add_plan(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command =
      app.add_subcommand("plan", "Show order, rates, states and algebraic loops of a diagram");
  struct Arguments {
    DiagramArguments diagram;
    std::string svg;
  };
  auto a = std::make_shared<Arguments>();
  a->diagram.add_to(*command);
  command->add_option("--svg", a->svg, "Draw the diagram into this file");
  command->callback([=] {
    choose([=]() -> int {
      require_writable_file(a->svg, "--svg");
      const auto plan = load_plan(a->diagram.path, a->diagram.options());
      tell_text(to_text(plan->warnings));
      answer("{}", describe(*plan));
      if (!a->svg.empty()) write_picture(*plan, a->svg);
      return done;
    });
  });
}

}  // namespace loopwright
