#include <gtest/gtest.h>
#include <array>
#include <cstdio>
#include <sstream>
#include "tests/engine/lanes/lane_testing.h"
#include "where.h"

namespace loopwright::module_test {
namespace {

using testing::set_name;
using testing::simd_sets;

std::string output_of(const std::string& command) {
  std::string text;
  FILE* const pipe = popen(command.c_str(), "r");
  std::array<char, 4096> part;
  while (const size_t n = fread(part.data(), 1, part.size(), pipe)) text.append(part.data(), n);
  return pclose(pipe) == 0 ? text : "";
}

class LaneModule : public ::testing::TestWithParam<InstructionSet> {};
INSTANTIATE_TEST_SUITE_P(Sets, LaneModule, ::testing::ValuesIn(simd_sets), set_name);

// Under the sanitizers one module replaces both: see engine/lanes/CMakeLists.txt.
bool is_built(InstructionSet set) {
#ifdef __SANITIZE_ADDRESS__
  return set != InstructionSet::avx512;
#else
  (void)set;
  return true;
#endif
}

// Any other symbol could be linked into the program, which must run on machines without these instructions.
TEST_P(LaneModule, ExportsNothingButItsEntry) {
  if (!is_built(GetParam())) GTEST_SKIP() << "not built under the sanitizers";
  const std::string file =
      LOOPWRIGHT_BINARY "/lib/loopwright_lanes_" + std::string(to_name(GetParam())) + ".so";
  std::istringstream lines(output_of("nm -D --defined-only '" + file + "'"));
  std::string address, kind, name;
  int symbols = 0;
  while (lines >> address >> kind >> name) {
    EXPECT_EQ(name, "loopwright_lane_module");
    ++symbols;
  }
  EXPECT_EQ(symbols, 1);
}

TEST_P(LaneModule, CanBeUsedWhereverTheProcessorHasItsInstructions) {
  if (!is_built(GetParam())) GTEST_SKIP() << "not built under the sanitizers";
  const std::string reason = lanes_unavailable(GetParam());
  if (reason.find("this processor does not have") != std::string::npos) GTEST_SKIP() << reason;
  EXPECT_EQ(reason, "");
}

}  // namespace
}  // namespace loopwright::module_test
