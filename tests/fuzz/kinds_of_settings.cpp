// JSON files other than diagrams: sweeps, effects, devices, learned models, trainings.
#include <fmt/format.h>
#include <filesystem>
#include <stdexcept>
#include "blocks/learning/ready_model.h"
#include "engine/file/hash.h"
#include "engine/json/json.h"
#include "hw/drivers.h"
#include "models/gp/table.h"
#include "tests/blocks/learning/trained_model.h"
#include "tests/fuzz/kinds.h"
#include "tests/tools/effects/axis_sizes.h"
#include "tests/tools/gp/stage.h"
#include "tests/tools/sweep/sweep_testing.h"
#include "tools/effects/effect_plan.h"
#include "where.h"

namespace loopwright::fuzz {
namespace {

namespace fs = std::filesystem;

class JsonKind : public FileKind {
 protected:
  std::string change(const std::string& text, Random& random) override {
    return mutate_json(text, donors_, random);
  }
  void add_folder(const fs::path& folder) {
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".json")
        seeds_.push_back({entry.path().filename().string(), read_whole(entry.path().string())});
    std::ranges::sort(seeds_, {}, &Seed::name);
  }
  std::vector<Json> donors_;
};

class Sweeps : public JsonKind {
 public:
  Sweeps() {
    const SweepFolder grid(four_axis_values, forty_samples),
        variants(
            R"("mass.mass": {"values": [1, 2]}, "damping_ratio": {"logarithmic": {"from": 0.1, "to": 1, "count": 3}})",
            R"(, "keep": {"worst": 2, "of": "a"}, "set": {"solver.stop": 0.2}, "seed": 7)");
    for (const auto* sweep : {&grid, &variants})
      seeds_.push_back({"sweep.json", read_whole(sweep->folder.path("sweep.json"))});
    folder_.with("loop.json", small_loop);
  }
  std::vector<std::string> command() override { return {"sweep", path(), "-o", folder_.path("results")}; }

 protected:
  Outcome use(const std::string& path, Problems& problems) override {
    auto sweep = load_sweep(path, problems);
    if (!sweep) return Outcome::refused;
    const SweepPlan plan(std::move(sweep));
    const Plan& first = *plan.world(0).plan;
    const bool is_short =
        (first.stop_tick - first.start_tick) / std::max<int64_t>(1, first.step_ticks) < 1000 &&
        is_fixed_step(first.method);
    EXPECT_TRUE(!is_short || make_runs(plan, 0, 1).size() == 1);
    return Outcome::finished;
  }
};

class Effects : public JsonKind {
 public:
  Effects() {
    add_folder(fs::path(LOOPWRIGHT_SOURCE) / "diagrams/effects");
    for (const Seed& seed : seeds_) donors_.push_back(Json::parse(seed.text));
  }

 protected:
  Outcome use(const std::string& path, Problems& problems) override {
    for (const Effect& effect : load_effect(path, problems))
      compile_effect(effect, {}, axis_sizes(), problems);
    return Outcome::finished;
  }
};

class Devices : public JsonKind {
 public:
  Devices() { add_folder(fs::path(LOOPWRIGHT_SOURCE) / "hw/devices"); }
  std::vector<std::string> command() override {
    Json diagram = Json::parse(read_whole(LOOPWRIGHT_SOURCE "/diagrams/examples/hardware_io.json"));
    diagram["blocks"]["axis"]["device"] = seed_.name;
    folder_.with("axis.diagram.json", diagram.dump());
    return {"check", folder_.path("axis.diagram.json")};
  }

 protected:
  Outcome use(const std::string& path, Problems& problems) override {
    hw::load_device(path, {}, problems);
    return Outcome::finished;
  }
};

class Models : public JsonKind {
 public:
  Models() {
    for (const gp::Kernel& kernel : {gp::additive(), gp::product()}) {
      const ModelFolder folder(trained_model(kernel));
      seeds_.push_back({"axis.model.json", read_whole(folder.path())});
    }
  }
  std::vector<std::string> command() override { return {"gp", "show", path()}; }

 protected:
  /// Every other mutant gets a matching checksum, so that its contents are read.
  std::string change(const std::string& text, Random& random) override {
    std::string mutant = mutate_json(text, donors_, random);
    if (below(random, 2)) return mutant;
    Problems problems;
    Value file = parse_json(std::make_shared<SourceFile>(SourceFile{"", mutant}), problems);
    const Value::Member* stated = file.find("checksum");
    if (problems.has_errors() || !stated || stated->value.kind != Value::Kind::text) return mutant;
    const std::string old = '"' + stated->value.text + '"';
    std::erase_if(file.members, [](const Value::Member& m) { return m.name == "checksum"; });
    if (const size_t at = mutant.find(old); at != mutant.npos)
      mutant.replace(at, old.size(), '"' + content_hash(to_json(file)) + '"');
    return mutant;
  }
  Outcome use(const std::string& path, Problems& problems) override {
    LearnedModel learned = read_model(path, {}, problems);
    if (problems.has_errors()) return Outcome::refused;
    try {
      const ReadyModel ready(std::move(learned));
      for (const double x : {0.0, 0.2, -1e9, 1e300, double(INFINITY), double(NAN)})
        for (const double v : {0.1, -3.0, 1e300, double(NAN)})
          ready.table()({x, v}), ready.posterior.mean({x, v});
    } catch (const std::domain_error&) {
      return Outcome::failed;
    }
    return Outcome::finished;
  }
};

class Trainings : public JsonKind {
 public:
  Trainings() {
    StageFolder stage;
    stage.pass("pass.csv", {0.1, 0.2, 0.3, 0.4});
    folder_.with("pass.csv", read_whole(stage.path("pass.csv")));
    stage.training();
    seeds_.push_back({"t.training.json", read_whole(stage.path("t.training.json"))});
    stage.training(R"(, "kernel": "product", "priors": {"noise": {"median": 0.1}}, "window_length": 0.1)",
                   R"({"command": "d", "mass": 0.3, "damping": 1, "cutoff": 100, "delay": 0.002})");
    seeds_.push_back({"t.training.json", read_whole(stage.path("t.training.json"))});
  }

 protected:
  Outcome use(const std::string& path, Problems& problems) override {
    if (const auto training = load_training(path, {}, problems)) collect_samples(*training, problems);
    return Outcome::finished;
  }
};

}  // namespace

std::unique_ptr<Kind> open_sweeps() { return std::make_unique<Sweeps>(); }
std::unique_ptr<Kind> open_effects() { return std::make_unique<Effects>(); }
std::unique_ptr<Kind> open_devices() { return std::make_unique<Devices>(); }
std::unique_ptr<Kind> open_models() { return std::make_unique<Models>(); }
std::unique_ptr<Kind> open_trainings() { return std::make_unique<Trainings>(); }

}  // namespace loopwright::fuzz
