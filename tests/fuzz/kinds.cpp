#include "tests/fuzz/kinds.h"
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace loopwright::fuzz {

// Shares: files that are written by hand, and name many others, break in the most ways. A MAT file needs a
// process.
constexpr KindOfFile kinds[] = {
    {"Diagrams", 50, 0.2, 0.1, open_diagrams},  {"Experiments", 10, 0.2, 0.1, open_experiments},
    {"Sweeps", 6, 0.2, 0.1, open_sweeps},       {"Effects", 8, 0.2, 0.1, open_effects},
    {"Devices", 5, 0.2, 0.1, open_devices},     {"Models", 4, 0.2, 0.02, open_models},
    {"Trainings", 4, 0.2, 0.1, open_trainings}, {"Checkpoints", 3, 0.2, 0, open_checkpoints},
    {"Shards", 2, 0.05, 0.1, open_shards},      {"Logs", 3, 0.05, 0.1, open_logs},
    {"Tables", 3, 0.05, 0.1, open_tables},      {"MatFiles", 2, 0.1, 0, open_mat_files},
};
std::span<const KindOfFile> kinds_of_files() { return kinds; }

std::string read_whole(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

Outcome FileKind::read(const std::string& what) {
  Problems problems;
  Outcome outcome = Outcome::refused;
  try {
    outcome = use(path(), problems);
  } catch (const InputError& error) {
    problems.add(error.problems);
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()), "") << what;
    EXPECT_FALSE(is_text_) << "an exception got out: " << error.what() << "\n" << what;
    return Outcome::refused;
  } catch (const std::exception& error) {
    ADD_FAILURE() << "an exception got out: " << error.what() << "\n" << what;
  }
  if (!problems.has_errors()) return outcome;
  EXPECT_FALSE(problems.text().empty()) << what;
  if (is_text_) expect_helpful(problems, what);
  return Outcome::refused;
}

}  // namespace loopwright::fuzz
