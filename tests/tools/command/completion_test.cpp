// Completion and the manual page know every subcommand and option.
#include <gmock/gmock.h>
#include "tests/tools/command/program.h"

namespace loopwright::completion_test {
namespace {

using ::testing::HasSubstr;

TEST(Completion, OfferTheCommandsAndOptionsThatBashAsksFor) {
  DiagramFolder folder;
  folder.with("loopwright.bash", loopwright_program({"completion", "bash"}).out).with("axis.json", "{}");
  const auto offered = [&](const std::string& words, int at) {
    folder.with("ask.sh", "cd " + folder.path("") + "\n. ./loopwright.bash\nCOMP_WORDS=(" + words +
                              ")\nCOMP_CWORD=" + std::to_string(at) +
                              "\n_loopwright\nprintf '%s\\n' \"${COMPREPLY[@]}\" > offered\n");
    EXPECT_EQ(std::system(("bash " + folder.path("ask.sh")).c_str()), 0);
    return text_of(folder.path("offered"));
  };
  EXPECT_EQ(offered("loopwright lin", 1), "linearize\n");
  EXPECT_EQ(offered("loopwright run --check", 2), "--checkpoint\n--checkpoint-every\n");
  EXPECT_THAT(offered("loopwright run ax", 2), HasSubstr("axis.json"));
  EXPECT_EQ(offered("loopwright sweep mer", 2), "merge\n");
}

TEST(Completion, ManualNamesEveryOption) {
  const std::string page = loopwright_program({"completion", "man"}).out;
  for (const char* named : {".SS loopwright diagnose", "\\-\\-checkpoint\\-every", ".SH EXIT STATUS"})
    EXPECT_THAT(page, HasSubstr(named));
  EXPECT_THAT(loopwright_program({"completion", "fish"}).out, HasSubstr("-l checkpoint-every -d"));
  EXPECT_EQ(loopwright_program({"completion", "tcsh"}).code, 2);
}

}  // namespace
}  // namespace loopwright::completion_test
