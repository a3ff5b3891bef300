#include "tools/command/command.h"
#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include "engine/block/registry.h"
#include "engine/json/file_kind.h"
#include "engine/record/atomic_file.h"

namespace loopwright {

void DiagramArguments::add_to(CLI::App& command) {
  command.add_option("diagram", path, "Diagram file (JSON)")->required();
  command
      .add_option("--set", set,
                  "Change a parameter or setting, as in --set stage.payload=2.1 or --set solver.stop=5")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  command.add_option("--variant", variants, "Choose a block's variant, as in --variant stage=quanser")
      ->type_name("BLOCK=NAME")
      ->allow_extra_args(false);
  command.add_option("--blocks", libraries, "Shared library with more blocks")
      ->type_name("FILE.so")
      ->allow_extra_args(false);
}

static std::pair<std::string, std::string> split(const std::string& text, std::string_view option,
                                                 Problems& problems) {
  const size_t equals = text.find('=');
  if (equals != text.npos && equals > 0) return {text.substr(0, equals), text.substr(equals + 1)};
  auto& p = problems.error({}, "", "", fmt::format("{} {}", option, text));
  p.expected = fmt::format("{} NAME=VALUE", option);
  return {};
}

LoadOptions DiagramArguments::options() const {
  LoadOptions options;
  Problems problems;
  for (const std::string& text : set) options.set.push_back(split(text, "--set", problems));
  for (const std::string& text : variants) options.variants.insert(split(text, "--variant", problems));
  for (const std::string& library : libraries) load_block_library(library, problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
  return options;
}

void DiagramArguments::warn_of_settings_left_out(std::string_view output,
                                                 const std::vector<std::string>& in_the_file) const {
  std::string settings;
  for (const std::string& text : set)
    if (std::ranges::find(in_the_file, text.substr(0, text.find('='))) == in_the_file.end())
      settings += " --set " + text;
  for (const std::string& text : variants) settings += " --variant " + text;
  if (!output.empty() && !settings.empty())
    tell("warning: {} was written from {} and does not contain{}: give it again with that file\n",
         output == "-" ? "the diagram" : output, path, settings);
}

void reject_swapped(const std::string& diagram, const std::vector<std::string>& experiments) {
  Problems unheard;  // problems of the files themselves are reported when they are loaded
  if (kind_of_file(diagram, unheard) != FileKind::experiment) return;
  for (const std::string& experiment : experiments) {
    if (kind_of_file(experiment, unheard) != FileKind::diagram) continue;
    Problems problems;
    auto& p = problems.error({}, "", "", "diagram and experiment stand in each other's place");
    p.expected = fmt::format("{} {}", experiment, diagram);
    p.found = fmt::format("{} is an experiment, {} a diagram", diagram, experiment);
    throw InputError(std::move(problems));
  }
}

static double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Progress::Progress(std::string what)
    : what_(std::move(what)), on_terminal_(isatty(STDERR_FILENO)), started_(now_s()), last_(started_) {}

void Progress::show(double done, double total) {
  const double now = now_s();
  if (now - last_ < 0.2 || now - started_ < 0.5 || total <= 0) return;
  last_ = now;
  const double share = std::clamp(done / total, 0.0, 1.0);
  const double left = share > 0 ? (now - started_) * (1 - share) / share : 0;
  if (on_terminal_) {
    const int filled = int(share * 30);
    tell_terminal(fmt::format("\r{} [{:█>{}}{:░>{}}] {:3.0f} %  {:.0f} s left ", what_, "", filled, "",
                              30 - filled, 100 * share, left));
    drawn_ = true;
  } else if (int(share * 10) > shown_tenths_) {
    shown_tenths_ = int(share * 10);
    tell("{}: {} %, about {:.0f} s left\n", what_, shown_tenths_ * 10, left);
  }
}

void Progress::finish() {
  if (drawn_) tell_terminal("\r\033[K");
}

void give_summary(const std::string& text, std::initializer_list<std::string_view> results) {
  const bool is_in_file = std::ranges::any_of(results, [](std::string_view path) { return !path.empty(); });
  if (std::ranges::find(results, "-") != results.end())
    tell_text(text);
  else
    is_in_file ? remark_text(text) : answer_text(text);
}

void write_json(const std::string& path, const std::function<std::string()>& json) {
  if (path == "-")
    answer_data(json());
  else if (!path.empty())
    write_file(path, json());
}

void give_answer(const std::string& text, const std::string& json_path,
                 const std::function<std::string()>& json, std::string_view page) {
  write_json(json_path, json);
  give_summary(text, {json_path, page});
}

void reject_two_on_stdout(std::initializer_list<std::pair<std::string_view, std::string_view>> options) {
  std::string names;
  for (const auto& [option, path] : options)
    if (path == "-") names += fmt::format("{}{} -", names.empty() ? "" : " and ", option);
  if (names.find(" and ") == names.npos) return;
  Problems problems;
  problems.error({}, "", "", fmt::format("{} both write to stdout", names)).hint = "give one of them a file";
  throw InputError(std::move(problems));
}

void require_writable_file(const std::string& path, std::string_view option) {
  if (path.empty()) return;
  if (path == "-") {
    Problems problems;
    problems.error({}, "", "", fmt::format("{} -: this is written to a file only", option)).expected =
        "the name of a file; ./- for one of that name";
    throw InputError(std::move(problems));
  }
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code code;
  const std::filesystem::path where = folder.empty() ? "." : folder;
  if (std::filesystem::is_directory(where, code) && access(where.c_str(), W_OK) == 0 &&
      !std::filesystem::is_directory(path, code))
    return;
  Problems problems;
  auto& p = problems.error({}, "", "", fmt::format("{} {}: nothing can be written there", option, path));
  p.expected = "a file in a folder that exists and may be written to";
  p.found = std::filesystem::is_directory(path, code) ? "a folder"
                                                      : fmt::format("the folder \"{}\"", where.string());
  throw InputError(std::move(problems));
}

void require_writable(const std::string& path, std::string_view option) {
  if (path != "-") require_writable_file(path, option);
}

}  // namespace loopwright
