/// The kinds of files that the program reads, each with a method to damage them and the functions that read
/// them.
#pragma once
#include <memory>
#include <span>
#include <string>
#include "tests/engine/diagram/diagram_folder.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/pipeline.h"

namespace loopwright::fuzz {

class Kind {
 public:
  virtual ~Kind() = default;
  /// Puts a mutant into a folder and describes it.
  virtual std::string make(Random& random) = 0;
  /// Reads it, and uses the result.
  virtual Outcome read(const std::string& what) = 0;
  /// Arguments with which the program reads it and ends soon; empty: there is no such command.
  virtual std::vector<std::string> command() { return {}; }
};

struct KindOfFile {
  std::string_view name;
  int share;                             ///< of a hundred mutants
  double least_refused, least_accepted;  ///< mutants that are all alike test little
  std::unique_ptr<Kind> (*open)();
};
std::span<const KindOfFile> kinds_of_files();

struct Seed {
  std::string name, text;
};

/// A file in a folder, which is replaced by a mutant.
class FileKind : public Kind {
 public:
  std::string make(Random& random) override {
    seed_ = pick(seeds_, random);
    const std::string mutant = change(seed_.text, random);
    folder_.with(seed_.name, mutant);
    return "==== " + seed_.name + "\n" + mutant + "\n====";
  }
  Outcome read(const std::string& what) override;

 protected:
  virtual std::string change(const std::string& text, Random& random) = 0;
  /// Problems; none if the file was accepted.
  virtual Outcome use(const std::string& path, Problems& problems) = 0;
  std::string path() const { return folder_.path(seed_.name); }

  DiagramFolder folder_;
  std::vector<Seed> seeds_;
  Seed seed_;
  bool is_text_ = true;  ///< every problem must point into it
};

std::string read_whole(const std::string& path);

std::unique_ptr<Kind> open_diagrams();
std::unique_ptr<Kind> open_experiments();
std::unique_ptr<Kind> open_sweeps();
std::unique_ptr<Kind> open_effects();
std::unique_ptr<Kind> open_devices();
std::unique_ptr<Kind> open_models();
std::unique_ptr<Kind> open_trainings();
std::unique_ptr<Kind> open_checkpoints();
std::unique_ptr<Kind> open_shards();
std::unique_ptr<Kind> open_logs();
std::unique_ptr<Kind> open_tables();
std::unique_ptr<Kind> open_mat_files();

}  // namespace loopwright::fuzz
