#include <fmt/format.h>
#include "engine/plan/plan.h"
#include "tools/command/command.h"

namespace loopwright {

/// Every problem of every diagram at once.
static int check(const std::vector<std::string>& paths, const LoadOptions& options) {
  int wrong = 0;
  for (const std::string& path : paths) {
    Problems problems;
    const auto diagram = load_diagram(path, options, problems);
    const bool is_part = diagram && !diagram->inputs.empty();
    std::shared_ptr<const Plan> plan;
    if (is_part)
      check_part(*diagram, problems);
    else if (diagram)
      plan = compile(*diagram, problems);
    if (!problems.list().empty()) fmt::print(stderr, "{}\n", problems.text());
    if (problems.has_errors() || !diagram)
      ++wrong;
    else if (is_part)
      fmt::print(stderr, "{}: fine, a subdiagram of {} blocks\n", path, diagram->blocks.size());
    else
      fmt::print(stderr, "{}: fine, {} blocks, {} states\n", path, plan->blocks.size(), plan->states);
  }
  return wrong ? input_wrong : done;
}

void add_check(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("check", "Say all that is wrong with diagrams");
  struct Arguments {
    std::vector<std::string> paths;
    DiagramArguments diagram;
  };
  auto arguments = std::make_shared<Arguments>();
  command->add_option("diagrams", arguments->paths, "Diagram files (JSON)")->required();
  command->add_option("--set", arguments->diagram.set, "Change a parameter or setting")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  command->add_option("--variant", arguments->diagram.variants, "Choose a block's variant")
      ->type_name("BLOCK=NAME")
      ->allow_extra_args(false);
  command->add_option("--blocks", arguments->diagram.libraries, "Shared library with more blocks")
      ->type_name("FILE.so")
      ->allow_extra_args(false);
  command->callback([=] { choose([=] { return check(arguments->paths, arguments->diagram.options()); }); });
}

}  // namespace loopwright
