// Numbers in groups.
#include "engine/plan/groups.h"
#include <gtest/gtest.h>

namespace loopwright::groups_test {
namespace {

TEST(Groups, KeepTheOrderInWhichNumbersAreTold) {
  const Groups groups(3, [](const auto& tell) { tell(2, 5), tell(0, 7), tell(2, 4); });
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(std::vector<int>(groups[0].begin(), groups[0].end()), (std::vector{7}));
  EXPECT_TRUE(groups[1].empty());
  EXPECT_EQ(std::vector<int>(groups[2].begin(), groups[2].end()), (std::vector{5, 4}));
  EXPECT_EQ(Groups().size(), 0u);
}

}  // namespace
}  // namespace loopwright::groups_test
