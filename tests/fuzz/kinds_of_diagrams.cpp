// Diagrams with everything that they name, and experiments with their data.
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include "tests/fuzz/kinds.h"
#include "where.h"

namespace loopwright::fuzz {
namespace {

namespace fs = std::filesystem;

/// A copy of diagrams/ that is damaged file by file.
struct Corpus {
  struct File {
    std::string name, text;             ///< "emps/axis.json"
    std::vector<std::string> diagrams;  ///< those that read this file, including itself
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
      const std::string name = fs::relative(path, source).string(), text = read_whole(path.string());
      folder.with(name, text);
      // Larger learned models are slow to load; diagrams/examples/gpr.json represents them.
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

class Diagrams : public Kind {
 public:
  std::string make(Random& random) override {
    if (broken_) corpus_.folder.with(broken_->name, broken_->text);
    broken_ = &pick(corpus_.files, random);
    const std::string text = mutate_json(broken_->text, corpus_.donors, random);
    top_ = pick(broken_->diagrams, random);
    corpus_.folder.with(broken_->name, text);
    return fmt::format("==== {} as part of {}\n{}\n====", broken_->name, top_, text);
  }
  Outcome read(const std::string& what) override { return run_diagram(corpus_.folder.path(top_), what); }
  std::vector<std::string> command() override { return {"check", corpus_.folder.path(top_)}; }

 private:
  Corpus corpus_;
  const Corpus::File* broken_ = nullptr;
  std::string top_;
};

/// A short recording of the EMPS axis, with the column names of the experiments.
std::string table() {
  std::string text = "t_s,q_ref_m,F_motor_N,q_meas_m\n";
  for (int i = 0; i < 40; ++i)
    text += fmt::format("{:.3f},{:.6f},{:.4f},{:.6f}\n", 0.001 * i, 1e-5 * i * i, 20.0 + i, 9e-6 * i * i);
  return text;
}

class Experiments : public Kind {
 public:
  std::string make(Random& random) override {
    name_ = below(random, 2) ? "emps/open_loop.experiment.json" : "emps/closed_loop.experiment.json";
    std::string experiment = read_whole((fs::path(LOOPWRIGHT_SOURCE) / "diagrams" / name_).string()),
                data = table();
    if (below(random, 2))
      data = mutate_table(data, random);
    else
      experiment = mutate_json(experiment, {}, random);
    corpus_.folder.with(name_, experiment).with("emps/emps_train.csv", data);
    diagram_ = below(random, 8) ? "emps/nominal.json" : pick(corpus_.files, random).name;
    return fmt::format("==== {}\n{}\n====\n{}\n====", name_, experiment, data);
  }
  Outcome read(const std::string& what) override {
    return compare_experiment(corpus_.folder.path(diagram_), corpus_.folder.path(name_), what);
  }
  std::vector<std::string> command() override {
    return {"compare", corpus_.folder.path(diagram_), corpus_.folder.path(name_)};
  }

 private:
  Corpus corpus_;
  std::string name_, diagram_;
};

}  // namespace

std::unique_ptr<Kind> open_diagrams() { return std::make_unique<Diagrams>(); }
std::unique_ptr<Kind> open_experiments() { return std::make_unique<Experiments>(); }

}  // namespace loopwright::fuzz
