// Tens of thousands of wrong inputs, the same in every run: each must end in problems that point into a file,
// or in a run that finished or says why not. One that crashes or hangs names itself (watchdog.h).
#include <gtest/gtest.h>
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include "tests/engine/diagram/diagram_folder.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/pipeline.h"
#include "tests/fuzz/watchdog.h"
#include "where.h"

namespace loopwright::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr int shards = 8, diagrams_a_shard = 2500, comparisons_a_shard = 250;

std::string read(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// A copy of diagrams/ to be broken file by file.
struct Corpus {
  struct File {
    std::string name, text;             ///< "emps/axis.json"
    std::vector<std::string> diagrams;  ///< those that read this file, itself among them
  };
  DiagramFolder folder;
  std::vector<File> files;
  std::vector<Json> donors;

  Corpus() {
    const fs::path source = fs::path(LOOPWRIGHT_SOURCE) / "diagrams";
    std::vector<fs::path> paths;
    for (const auto& entry : fs::recursive_directory_iterator(source))
      if (entry.is_regular_file()) paths.push_back(entry.path());
    std::ranges::sort(paths);
    for (const fs::path& path : paths) {
      const std::string name = fs::relative(path, source).string(), text = read(path);
      folder.with(name, text);
      // Larger learned models take a while to load; diagrams/examples/gpr.json stands for them.
      const bool is_slow = text.find(".model.json") != text.npos && !name.starts_with("examples/");
      if (path.extension() == ".json" && !path.stem().has_extension() && !is_slow)
        files.push_back({name, text, {}});
    }
    for (const File& top : files) {
      donors.push_back(Json::parse(top.text));
      Problems problems;
      const auto diagram = load_diagram(folder.path(top.name), {}, problems);
      for (const std::string& opened : diagram ? diagram->files : std::vector<std::string>{})
        for (File& file : files)
          if (fs::path(opened).lexically_normal() == fs::path(folder.path(file.name)).lexically_normal())
            file.diagrams.push_back(top.name);
    }
    // Effects have readers of their own.
    std::erase_if(files, [](const File& file) { return file.diagrams.empty(); });
    if (files.size() < 80) throw std::runtime_error("diagrams of the repository do not load");
  }
};

class Mutants : public testing::TestWithParam<int> {
 protected:
  static uint64_t seed_of(int i) { return uint64_t(GetParam()) * 1'000'000 + uint64_t(i); }
  std::map<Outcome, int> outcomes_;
};

TEST_P(Mutants, OfDiagramsEndInProblemsOrInRuns) {
  Corpus corpus;
  for (int i = 0; i < diagrams_a_shard && !HasFailure(); ++i) {
    Random random(seed_of(i));
    const Corpus::File& file = pick(corpus.files, random);
    ASSERT_FALSE(file.diagrams.empty()) << file.name;
    const std::string text = mutate_json(file.text, corpus.donors, random);
    const std::string top = pick(file.diagrams, random);
    const std::string what =
        fmt::format("==== seed {}, {} as part of {}\n{}\n====", seed_of(i), file.name, top, text);
    corpus.folder.with(file.name, text);
    watch(seed_of(i), what);
    ++outcomes_[run_diagram(corpus.folder.path(top), what)];
    corpus.folder.with(file.name, file.text);
  }
  unwatch();
  for (auto [outcome, least] :
       {std::pair{Outcome::refused, 0.2}, {Outcome::finished, 0.1}, {Outcome::failed, 0.0}})
    EXPECT_GT(outcomes_[outcome], least * diagrams_a_shard)
        << "mutants that are all alike test little: outcome " << int(outcome);
}

/// A short recording of the EMPS axis, as the experiments name its columns.
std::string table() {
  std::string text = "t_s,q_ref_m,F_motor_N,q_meas_m\n";
  for (int i = 0; i < 40; ++i)
    text += fmt::format("{:.3f},{:.6f},{:.4f},{:.6f}\n", 0.001 * i, 1e-5 * i * i, 20.0 + i, 9e-6 * i * i);
  return text;
}

TEST_P(Mutants, OfExperimentsAndTablesEndInProblemsOrInRuns) {
  Corpus corpus;
  for (int i = 0; i < comparisons_a_shard && !HasFailure(); ++i) {
    Random random(seed_of(i) + 500'000);
    const bool is_open = below(random, 2);
    const std::string name = is_open ? "emps/open_loop.experiment.json" : "emps/closed_loop.experiment.json";
    const bool breaks_table = below(random, 2);
    std::string experiment = read(fs::path(LOOPWRIGHT_SOURCE) / "diagrams" / name), data = table();
    (breaks_table ? data : experiment) =
        breaks_table ? mutate_table(data, random) : mutate_json(experiment, {}, random);
    const std::string what =
        fmt::format("==== seed {}, {}\n{}\n====\n{}\n====", seed_of(i) + 500'000, name, experiment, data);
    corpus.folder.with(name, experiment).with("emps/emps_train.csv", data);
    watch(seed_of(i) + 500'000, what);
    const std::string diagram = below(random, 8) ? "emps/nominal.json" : pick(corpus.files, random).name;
    ++outcomes_[compare_experiment(corpus.folder.path(diagram), corpus.folder.path(name), what)];
  }
  unwatch();
  EXPECT_GT(outcomes_[Outcome::refused], 0.2 * comparisons_a_shard);
  EXPECT_GT(outcomes_[Outcome::finished], 0.1 * comparisons_a_shard);
}

INSTANTIATE_TEST_SUITE_P(Shard, Mutants, testing::Range(0, shards));

}  // namespace
}  // namespace loopwright::fuzz
