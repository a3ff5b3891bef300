// Files that the program writes and reads itself: checkpoints, shards of sweeps, logs, tables, MAT files.
#include <fmt/format.h>
#include <cmath>
#include <stdexcept>
#include "engine/file/hash.h"
#include "engine/record/recording_file.h"
#include "hw/realtime/log_columns.h"
#include "tests/engine/record/mutation.h"
#include "tests/engine/written_diagram.h"
#include "tests/fuzz/kinds.h"
#include "tests/tools/sweep/sweep_testing.h"
#include "tools/deploy/replay.h"
#include "where.h"

namespace loopwright::fuzz {
namespace {

class Checkpoints : public FileKind {
 public:
  Checkpoints() {
    is_text_ = false;
    const std::string file = folder_.path("run.checkpoint");
    RunOptions options;
    options.checkpoint_file = file, options.checkpoint_every = 0.25;
    simulate(*plan_, options);
    seeds_.push_back({"run.checkpoint", read_whole(file)});
  }

 protected:
  /// Every other mutant has a damaged header and a matching hash. The bytes behind the facts are memory of a
  /// run, which only the hash protects.
  std::string change(const std::string& text, Random& random) override {
    if (below(random, 2)) return mutate(text, random);
    constexpr size_t hash = 16;
    const size_t head = text.find("build: ");
    const std::string mutant =
        mutate(text.substr(0, head), random) + text.substr(head, text.size() - hash - head);
    return mutant + content_hash(mutant);
  }
  Outcome use(const std::string& path, Problems&) override {
    RunOptions options;
    options.resume_file = path;
    return simulate(*plan_, options).status == RunStatus::finished ? Outcome::finished : Outcome::failed;
  }

 private:
  const std::shared_ptr<const Plan> plan_ = plan_of(diagram(
      R"("s": {"type": "Sine", "frequency": 1}, "x": {"type": "LowPass", "cutoff": 5, "in": {"u": "s.y"}},
         "d": {"type": "Delay", "samples": 3, "sample_time": 0.05, "in": {"u": "x.y"}})",
      R"("stop": 1, "step": 0.01)"));
};

class Shards : public FileKind {
 public:
  Shards() : sweep_(R"("mass.mass": {"linear": {"from": 0.5, "to": 2, "count": 20}})"), plan_(sweep_.plan()) {
    is_text_ = false;
    run_sweep(plan_, folder_.path(""), {});
    seeds_.push_back({"sweep_file.txt", read_whole(folder_.path("sweep_file.txt"))});
    for (const std::string& path : shard_files(folder_.path("")))
      for (int weight = 0; weight < 4; ++weight)
        seeds_.push_back({std::filesystem::path(path).filename().string(), read_whole(path)});
  }
  std::string make(Random& random) override {
    for (const Seed& whole : seeds_) folder_.with(whole.name, whole.text);
    return FileKind::make(random);
  }

 protected:
  std::string change(const std::string& text, Random& random) override { return mutate(text, random); }
  Outcome use(const std::string&, Problems&) override {
    const SweepResults results = read_results(plan_, folder_.path(""));
    EXPECT_EQ(results.missing + int64_t(results.table.rows()), plan_.runs());
    return Outcome::finished;
  }

 private:
  SweepFolder sweep_;
  SweepPlan plan_;
};

class Logs : public FileKind {
 public:
  Logs() {
    Problems problems;
    hardware_ = hw::find_hardware(*plan_, problems);
    Recording log;
    log.facts = plan_->identity.facts();
    for (const hw::LogColumn& column : hw::log_columns(*plan_, hardware_)) {
      log.columns.push_back({column.name, column.unit, {}});
      for (int row = 0; row < 5; ++row)
        log.columns.back().values.push_back(column.name == "time" ? plan_->clock.time(row) : 1e-6 * row);
    }
    write_recording(folder_.path("log.csv"), log);
    seeds_.push_back({"log.csv", read_whole(folder_.path("log.csv"))});
  }
  std::vector<std::string> command() override {
    return {"run", LOOPWRIGHT_SOURCE "/diagrams/examples/hardware_io.json", "--replay", path()};
  }

 protected:
  std::string change(const std::string& text, Random& random) override { return mutate_table(text, random); }
  Outcome use(const std::string& path, Problems& problems) override {
    const Recording log = read_recording(path, problems, {.allow_not_finite = true});
    if (problems.has_errors()) return Outcome::refused;
    Problems of_replay;  // they refer to the plan, not to a location in the log
    const Replay result = replay(*plan_, hardware_, log, of_replay);
    if (of_replay.has_errors()) return Outcome::failed;
    EXPECT_FALSE(to_text(result).empty());
    return Outcome::finished;
  }

 private:
  const std::shared_ptr<const Plan> plan_ =
      load_plan(LOOPWRIGHT_SOURCE "/diagrams/examples/hardware_io.json");
  hw::Hardware hardware_;
};

Recording small_recording() {
  Recording recording;
  recording.facts = {{"title", "A table: µ"}, {"parameter a.b", "1 kg"}};
  for (const char* name : {"time", "stage.position", "odd, \"name\" [2]"}) {
    recording.columns.push_back({name, name[0] == 't' ? "s" : "m", {}});
    for (int row = 0; row < 20; ++row) recording.columns.back().values.push_back(std::sqrt(row) * 1e-3);
  }
  return recording;
}

class Tables : public FileKind {
 public:
  Tables() {
    write_recording(folder_.path("table.csv"), small_recording());
    seeds_.push_back({"table.csv", read_whole(folder_.path("table.csv"))});
    seeds_.push_back({"table.csv", "t [ms];x\n0;1,5\n1;2,5\n2;NaN\n"});
    seeds_.push_back({"table.txt", "time x\ns mm\n0 1\n0.1\t2\n"});
  }
  std::vector<std::string> command() override {
    folder_.with(
        "player.json",
        diagram(fmt::format(R"("t": {{"type": "RecordedColumn", "file": "{}", "column": "stage.position"}})",
                            seed_.name)));
    return {"check", folder_.path("player.json")};
  }

 protected:
  std::string change(const std::string& text, Random& random) override { return mutate_table(text, random); }
  Outcome use(const std::string& path, Problems& problems) override {
    const Recording recording = read_recording(path, problems);
    EXPECT_TRUE(is_refused_or_well_formed(recording, problems, {}));
    return Outcome::finished;
  }
};

class MatFiles : public FileKind {
 public:
  MatFiles() {
    is_text_ = false;
    write_recording(folder_.path("table.mat"), small_recording());
    seeds_.push_back({"table.mat", read_whole(folder_.path("table.mat"))});
  }

 protected:
  std::string change(const std::string& text, Random& random) override {
    constexpr size_t header = 128;
    return below(random, 2) ? mutate(text, random) : flip_bits(text, header, random);
  }
  Outcome use(const std::string& path, Problems& problems) override {
    const Recording recording = read_recording(path, problems);
    EXPECT_TRUE(is_refused_or_well_formed(recording, problems, {}));
    return Outcome::finished;
  }
};

}  // namespace

std::unique_ptr<Kind> open_checkpoints() { return std::make_unique<Checkpoints>(); }
std::unique_ptr<Kind> open_shards() { return std::make_unique<Shards>(); }
std::unique_ptr<Kind> open_logs() { return std::make_unique<Logs>(); }
std::unique_ptr<Kind> open_tables() { return std::make_unique<Tables>(); }
std::unique_ptr<Kind> open_mat_files() { return std::make_unique<MatFiles>(); }

}  // namespace loopwright::fuzz
