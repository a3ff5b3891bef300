#include "tools/command/command.h"
#include "tools/look/look.h"

namespace loopwright {
namespace {

struct LookArguments {
  std::string recording, time, json, report;
};

int run(const LookArguments& a) {
  require_writable(a.json, "--json");
  require_writable_file(a.report, "--report");
  const Look look = look_at(a.recording, a.time);
  if (!a.report.empty()) report::write_html(a.report, look_page(look));
  give_answer(
      to_text(look), a.json, [&] { return to_json(look); }, a.report);
  return done;
}

}  // namespace

void add_look(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command =
      app.add_subcommand("look", "Say what a recording contains: columns, rates, gaps, noise");
  auto a = std::make_shared<LookArguments>();
  command->add_option("recording", a->recording, "Recording (.csv, .txt, .tsv, .dat, .mat)")->required();
  command->add_option("--time", a->time, "Column with the time");
  command->add_option("--json", a->json, "Write the figures as JSON; - for stdout");
  command->add_option("--report", a->report, "Write an HTML page with a plot of every column");
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright
