// Generates the tables and figures of the paper.
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <chrono>
#include "engine/record/atomic_file.h"
#include "tools/studies/linear_motor/study.h"

int main(int count, char** arguments) {
  using namespace loopwright;
  CLI::App app{"Runs the linear-motor study: identification, training, tables, figures"};
  paper::StudyOptions options;
  app.add_option("--diagrams", options.diagrams, "Folder of the diagrams")->capture_default_str();
  app.add_option("-o,--output", options.output, "Folder for report.html, tables.json, models and recordings")
      ->capture_default_str();
  app.add_option("--runs", options.runs, "Runs with different noise for each number")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  CLI11_PARSE(app, count, arguments);
  try {
    const auto begin = std::chrono::steady_clock::now();
    options.progress = [&](const std::string& what) {
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
      fmt::print(stderr, "{:5.0f} s  {} …\n", elapsed.count(), what);
    };
    const paper::Study study = paper::run_study(options);
    write_file(options.output + "/tables.json", paper::to_json(study));
    report::write_html(options.output + "/report.html", paper::study_page(study));
    fmt::print("{}", report::to_text(paper::summary_page(study)));
    fmt::print(stderr, "report: {0}/report.html\nnumbers: {0}/tables.json\n", options.output);
    return 0;
  } catch (const InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
