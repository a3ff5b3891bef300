/// The `loopwright` program: one subcommand a file.
#include <fmt/format.h>
#include <exception>
#include "tools/command/command.h"

int main(int count, char** arguments) {
  using namespace loopwright;
  CLI::App app{"Loopwright simulates block diagrams of motion control, and holds them against measurements."};
  app.require_subcommand(1);
  app.set_version_flag("--version", "loopwright " LOOPWRIGHT_VERSION);
  app.failure_message(CLI::FailureMessage::help);
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
  add_probe(app, choose);
  add_linearize(app, choose);
  add_stability(app, choose);
  try {
    app.parse(count, arguments);
    return action();
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? done : input_wrong;
  } catch (const InputError& e) {
    fmt::print(stderr, "{}\n", e.what());
    return input_wrong;
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return run_failed;
  }
}
