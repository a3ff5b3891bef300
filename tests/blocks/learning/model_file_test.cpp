#include "blocks/learning/model_file.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <fstream>
#include <sstream>
#include "tests/blocks/learning/trained_model.h"

namespace loopwright::model_file_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// The message of the reader when `from` is replaced by `to` in the file.
std::string problems_after(const std::string& from, const std::string& to) {
  const ModelFolder folder;
  std::string text = text_of(folder.path());
  const size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  std::ofstream(folder.path()) << text.replace(at, from.size(), to);
  Problems problems;
  read_model(folder.path(), {}, problems);
  EXPECT_TRUE(problems.has_errors());
  return problems.text();
}

TEST(ModelFile, BringsBackEveryNumber) {
  gp::Kernel without_structure = gp::additive();
  without_structure.terms.push_back(gp::Term{0.1, {gp::smooth(0.05), gp::Shape{}}});
  for (const gp::Kernel& kernel : {gp::additive(), gp::product(), gp::double_smooth(), without_structure}) {
    const LearnedModel written = trained_model(kernel);
    const ModelFolder folder(written);
    Problems problems;
    const LearnedModel read = read_model(folder.path(), {}, problems);
    ASSERT_TRUE(problems.list().empty()) << problems.text();
    EXPECT_EQ(read.model.kernel, written.model.kernel);
    EXPECT_EQ(read.model.data.index(), written.model.data.index());
    EXPECT_EQ(read.title, written.title);
    EXPECT_EQ(read.label_unit, "V");
    EXPECT_EQ(read.shown.labels, written.shown.labels);
    const gp::Posterior before(written.model), after(read.model);
    for (double x : {0.0, 0.1234, 0.3}) {
      EXPECT_EQ(after.mean({x, 0.21}), before.mean({x, 0.21}));
      EXPECT_EQ(after.variance({x, 0.21}), before.variance({x, 0.21}));
    }
  }
}

TEST(ModelFile, IsRefusedWhenItsVersionIsNotKnown) {
  EXPECT_THAT(problems_after("\"loopwright_gp_model\": 1", "\"loopwright_gp_model\": 2"),
              AllOf(HasSubstr("axis.model.json:2:"), HasSubstr("version of the model file is not known"),
                    HasSubstr("expected: 1"), HasSubstr("train the model again")));
}

TEST(ModelFile, IsRefusedWhenOneDigitChanged) {
  EXPECT_THAT(problems_after("\"label_mean\": 0.12", "\"label_mean\": 0.13"),
              AllOf(HasSubstr("damaged or was changed by hand"), HasSubstr("/checksum")));
}

TEST(ModelFile, IsRefusedWhenItEndsEarly) {
  EXPECT_THAT(problems_after("\"label_mean\"", "\x01"), HasSubstr("axis.model.json:"));
}

TEST(ModelFile, IsRefusedWhenItIsAnotherKindOfFile) {
  EXPECT_THAT(problems_after("\"loopwright_gp_model\": 1", "\"loopwright\": 1"),
              AllOf(HasSubstr("this is no model"), HasSubstr("\"loopwright_gp_model\": 1")));
}

TEST(ModelFile, WritesTheSameBytesAgain) {
  const ModelFolder first, second;
  EXPECT_EQ(text_of(first.path()), text_of(second.path()));
}

}  // namespace
}  // namespace loopwright::model_file_test
