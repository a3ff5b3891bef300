#include <fmt/format.h>
#include "engine/record/atomic_file.h"
#include "tools/command/command.h"
#include "tools/design/design.h"

namespace loopwright {
namespace {

struct DesignArguments {
  DiagramArguments diagram;
  DesignRequest request;
  double at = -1;
  std::string output, json;
};

int run(const DesignArguments& a) {
  require_writable(a.json, "--json");
  require_writable_file(a.output, "--output");
  const auto plan = load_plan(a.diagram.path, a.diagram.options());
  tell_text(to_text(plan->warnings));
  RunOptions options;
  options.interrupt = &interruption();
  DesignRequest request = a.request;
  if (a.at >= 0) request.at = a.at;
  const Design result = design(*plan, request, options);
  if (!a.output.empty()) write_file(a.output, controller_diagram(result));
  write_json(a.json, [&] { return to_json(result); });
  give_summary(to_text(result), {a.json, a.output});
  return done;
}

void add_kind(CLI::App& design, DesignKind kind, const std::function<void(std::function<int()>)>& choose) {
  const bool is_filter = kind == DesignKind::filter;
  CLI::App* command =
      is_filter
          ? design.add_subcommand("kalman", "The Kalman filter that estimates the states from measurements")
          : design.add_subcommand("lqr", "The state feedback that minimizes a sum of weighted squares");
  auto a = std::make_shared<DesignArguments>();
  a->request.kind = kind;
  a->diagram.add_to(*command);
  command
      ->add_option("--from", a->request.from,
                   is_filter ? "Ports of known inputs, which are cut there"
                             : "Ports that it drives, which are cut there")
      ->type_name("PORT");
  if (is_filter) command->add_option("--to", a->request.to, "Ports that are measured")->type_name("PORT");
  command
      ->add_option(
          "--Q", a->request.Q,
          is_filter ? "Variance of the noise at a state or a port" : "Weight of a state or a port, squared")
      ->type_name("NAME=NUMBER");
  command
      ->add_option("--R", a->request.R,
                   is_filter ? "Variance of a measurement" : "Weight of a command, squared")
      ->type_name("PORT=NUMBER");
  command
      ->add_option(is_filter ? "--deviation" : "--allow", a->request.sizes,
                   is_filter ? "Instead of --Q or --R: the standard deviation, \"NAME=2 um\""
                             : "Instead of --Q or --R: the deviation that counts 1, \"NAME=2 um\"")
      ->type_name("NAME=NUMBER");
  command->add_option("--without", a->request.without, "Blocks or states that do not belong to the plant")
      ->type_name("NAME");
  command->add_flag("--keep-loops", a->request.keeps_loops, "Do not cut the ports of --from");
  command->add_option("--at", a->at, "Time of the operating point in s; the start when left out")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--continuous", a->request.continuous,
                    "The continuous part alone, discrete signals held");
  command->add_option("--sample-time", a->request.sample_time, "Sample a continuous system every so many s")
      ->check(CLI::PositiveNumber);
  command->add_option("-o,--output", a->output, "Write a subdiagram");
  command->add_option("--json", a->json, "Write everything as JSON; - for stdout");
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace

void add_design(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("design", "State feedback or a Kalman filter for a diagram");
  command->require_subcommand(1);
  add_kind(*command, DesignKind::regulator, choose);
  add_kind(*command, DesignKind::filter, choose);
}

}  // namespace loopwright
