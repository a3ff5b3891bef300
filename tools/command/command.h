/// Code shared by the subcommands of `loopwright`: diagram arguments, exit codes, interruption, progress.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"
#include "tools/command/interruption.h"
#include "tools/command/output.h"

namespace loopwright {

enum ExitCode { done = 0, run_failed = 1, input_wrong = 2, interrupted = 130 };

/// A diagram on the command line, with the options that change it.
struct DiagramArguments {
  std::string path;
  std::vector<std::string> set, variants, libraries;

  void add_to(CLI::App& command);
  /// Loads block libraries. Throws InputError for malformed --set and --variant.
  LoadOptions options() const;
  /// Names the settings of the command line that a diagram written from the file at `path` does not have.
  /// `in_the_file`: paths of which the file has a value of its own, so that a setting of them was a start.
  void warn_of_settings_left_out(std::string_view output,
                                 const std::vector<std::string>& in_the_file = {}) const;
};

/// Adds a subcommand; `action` receives the exit code.
void add_check(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_run(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_report(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_plan(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_new(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_blocks(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_schema(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_sweep(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_compare(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_fit(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_gp(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_diagnose(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_deploy(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_recover(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_probe(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_look(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_linearize(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_studio(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_design(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_stability(CLI::App& app, std::function<void(std::function<int()>)> choose);
void add_completion(CLI::App& app, std::function<void(std::function<int()>)> choose);

/// Reports exchanged arguments, `loopwright compare EXPERIMENT DIAGRAM`, as such. Throws InputError.
void reject_swapped(const std::string& diagram, const std::vector<std::string>& experiments);

/// A progress bar on a terminal, otherwise a line for every tenth; on stderr.
class Progress {
 public:
  explicit Progress(std::string what);
  void show(double done, double total);
  void finish();

 private:
  std::string what_;
  bool on_terminal_;
  int shown_tenths_ = 0;
  bool drawn_ = false;
  double started_, last_;
};

/// Prints the summary for people: on stdout, or on stderr if one of these results goes to stdout ("-"). If
/// none of them goes to a file either, the summary is the result itself and must not be lost.
void give_summary(const std::string& text, std::initializer_list<std::string_view> results);

/// Writes JSON if requested: to a file, or to stdout for "-".
void write_json(const std::string& path, const std::function<std::string()>& json);

/// Writes a result as a summary, and as JSON if requested. `page`: another file that has the result, if any.
void give_answer(const std::string& text, const std::string& json_path,
                 const std::function<std::string()>& json, std::string_view page);

/// Two results on stdout could not be separated. Throws InputError.
void reject_two_on_stdout(std::initializer_list<std::pair<std::string_view, std::string_view>> options);

/// Checks before hours of computing that the path can be written later. Throws InputError.
void require_writable(const std::string& path, std::string_view option);
/// The same for a result that is always a file, never stdout.
void require_writable_file(const std::string& path, std::string_view option);

}  // namespace loopwright
