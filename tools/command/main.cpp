/// The `loopwright` program: one subcommand a file.
#include <fmt/format.h>
#include <exception>
#include "tools/command/command.h"
#include "tools/command/command_line.h"

int main(int count, char** arguments) {
  using namespace loopwright;
  CLI::App app{"Loopwright simulates block diagrams of motion control, and holds them against measurements."};
  app.require_subcommand(1);
  app.set_version_flag("--version", "loopwright " LOOPWRIGHT_VERSION);
  app.footer(
      "Exit codes: 0 done; 1 a run failed, or a check of a machine did; 2 wrong input, nothing was written;\n"
      "130 interrupted, what was computed is kept. Results go to stdout or where -o, --json and --report "
      "say;\n"
      "summaries go to stdout, or to stderr where results take it; problems and progress go to stderr.");
  std::function<int()> action;
  const auto choose = [&](std::function<int()> chosen) { action = std::move(chosen); };
  add_check(app, choose);
  add_run(app, choose);
  add_plan(app, choose);
  add_blocks(app, choose);
  add_schema(app, choose);
  add_compare(app, choose);
  add_fit(app, choose);
  add_gp(app, choose);
  add_diagnose(app, choose);
  add_sweep(app, choose);
  add_deploy(app, choose);
  add_recover(app, choose);
  add_probe(app, choose);
  add_linearize(app, choose);
  add_stability(app, choose);
  try {
    app.parse(count, arguments);
    return action();
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    fmt::print(stderr, "{}\n", explain(app, e).text());
    return input_wrong;
  } catch (const InputError& e) {
    fmt::print(stderr, "{}\n", e.what());
    return input_wrong;
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return run_failed;
  }
}
