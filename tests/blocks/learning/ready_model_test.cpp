#include "blocks/learning/ready_model.h"
#include <gtest/gtest.h>
#include "tests/blocks/learning/trained_model.h"

namespace loopwright::ready_model_test {
namespace {

std::shared_ptr<const ReadyModel> ready(const std::string& path) {
  const Value settings;
  Problems problems;
  auto model = ready_model(Checker(settings, "block", problems), "model", path);
  EXPECT_EQ(problems.text(), "");
  return model;
}

TEST(ReadyModel, IsSharedWhileItIsInUse) {
  const ModelFolder folder;
  const auto first = ready(folder.path());
  ASSERT_TRUE(first);
  EXPECT_EQ(ready(folder.path()), first);
  EXPECT_EQ(&first->table(), &ready(folder.path())->table());
}

TEST(ReadyModel, IsReadAnewWhenItsFileHasChanged) {
  const ModelFolder folder;
  const auto first = ready(folder.path());
  LearnedModel other = trained_model();
  other.model.homing_offset = 0.004;
  write_model(folder.path(), other);
  const auto second = ready(folder.path());
  ASSERT_TRUE(first && second);
  EXPECT_NE(first, second);
  EXPECT_EQ(second->learned.model.homing_offset, 0.004);
  EXPECT_EQ(first->learned.model.homing_offset, 0.003);
}

}  // namespace
}  // namespace loopwright::ready_model_test
