#include <fmt/format.h>
#include <filesystem>
#include "tools/command/command.h"
#include "tools/gp/gp_page.h"

namespace loopwright {
namespace {

struct TrainArguments {
  std::string training, model, report, json;
  std::vector<std::string> set;
};
struct ShowArguments {
  std::string model, report, json;
  std::vector<std::string> on, set;
};

std::vector<std::pair<std::string, std::string>> changes(const std::vector<std::string>& set) {
  Problems problems;
  std::vector<std::pair<std::string, std::string>> result;
  for (const std::string& text : set) {
    const size_t equals = text.find('=');
    if (equals == text.npos || equals == 0)
      problems.error({}, "", "", fmt::format("--set {}", text)).expected = "--set NAME=VALUE";
    else
      result.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  if (problems.has_errors()) throw InputError(std::move(problems));
  return result;
}

void throw_errors(Problems& problems) {
  if (problems.has_errors()) throw InputError(std::move(problems));
}
void print_warnings(const Problems& problems) {
  if (!problems.list().empty()) tell("{}\n", problems.text());
}

void write_results(const LearnedModel& learned, const std::vector<ShownSamples>& shown,
                   const std::vector<std::string>& notes, const std::string& json, const std::string& report,
                   const std::string& model) {
  if (!report.empty()) report::write_html(report, model_page(learned, shown, notes));
  std::string summary = model_summary(learned, shown);
  for (const std::string& note : notes) summary += fmt::format("  {}\n", note);
  give_answer(
      summary, json, [&] { return model_json(learned, shown); }, model.empty() ? report : model);
}

int run_train(const TrainArguments& a) {
  require_writable_file(a.model, "--model");
  require_writable_file(a.report, "--report");
  require_writable(a.json, "--json");
  Problems problems;
  const auto training = load_training(a.training, changes(a.set), problems);
  throw_errors(problems);
  Progress progress("gp train");
  const auto& stop = interruption();
  const auto trained = train(*training, problems, [&](double done, double total) {
    progress.show(done, total);
    return !stop;
  });
  progress.finish();
  throw_errors(problems);
  if (!trained) return interrupted;
  print_warnings(problems);
  write_model(a.model, trained->learned);
  const ShownSamples own{"training", trained->samples->samples,
                         score(trained->learned.model, trained->samples->samples)};
  write_results(trained->learned, {own}, trained->notes, a.json, a.report, a.model);
  return done;
}

int run_show(const ShowArguments& a) {
  require_writable_file(a.report, "--report");
  require_writable(a.json, "--json");
  Problems problems;
  const LearnedModel learned = read_model(a.model, {}, problems);
  throw_errors(problems);
  std::vector<ShownSamples> shown;
  for (const std::string& path : a.on) {
    const auto training = load_training(path, changes(a.set), problems);
    throw_errors(problems);
    const auto collected = collect_samples(*training, problems);
    throw_errors(problems);
    shown.push_back({std::filesystem::path(path).filename().string(), collected->samples,
                     score(learned.model, collected->samples)});
  }
  print_warnings(problems);
  write_results(learned, shown, {}, a.json, a.report, "");
  return done;
}

}  // namespace

void add_gp(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command =
      app.add_subcommand("gp", "Learn disturbances from recordings, and look at what was learned");
  command->require_subcommand(1);

  CLI::App* train_command = command->add_subcommand("train", "Train a Gaussian process on recordings");
  auto t = std::make_shared<TrainArguments>();
  train_command->add_option("training", t->training, "Training file (JSON)")->required();
  train_command->add_option("--model", t->model, "Write the model, for the block Gpr")->required();
  train_command->add_option("--report", t->report, "Write an HTML page");
  train_command->add_option("--json", t->json, "Write the figures as JSON; - for stdout");
  train_command->add_option("--set", t->set, "Change the training file, as in --set kernel=ds")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  train_command->callback([=] { choose([=] { return run_train(*t); }); });

  CLI::App* show_command = command->add_subcommand("show", "Show a model");
  auto s = std::make_shared<ShowArguments>();
  show_command->add_option("model", s->model, "Model file")->required();
  show_command->add_option("--on", s->on, "Score it on the samples of this training file")
      ->type_name("TRAINING")
      ->allow_extra_args(false);
  show_command->add_option("--set", s->set, "Change these training files, as in --set window_length=0")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  show_command->add_option("--report", s->report, "Write an HTML page");
  show_command->add_option("--json", s->json, "Write the figures as JSON; - for stdout");
  show_command->callback([=] { choose([=] { return run_show(*s); }); });
}

}  // namespace loopwright
