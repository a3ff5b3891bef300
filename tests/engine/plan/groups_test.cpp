// Small tables of the plan: numbers in groups, blocks by name.
#include "engine/plan/groups.h"
#include <fmt/format.h>
#include <gtest/gtest.h>
#include "engine/plan/block_names.h"

namespace loopwright {
namespace {

TEST(Groups, KeepTheOrderInWhichNumbersAreTold) {
  const Groups groups(3, [](const auto& tell) { tell(2, 5), tell(0, 7), tell(2, 4); });
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(std::vector<int>(groups[0].begin(), groups[0].end()), (std::vector{7}));
  EXPECT_TRUE(groups[1].empty());
  EXPECT_EQ(std::vector<int>(groups[2].begin(), groups[2].end()), (std::vector{5, 4}));
  EXPECT_EQ(Groups().size(), 0u);
}

TEST(BlockNames, LeadToTheirBlocksAndOthersNowhere) {
  for (const int count : {0, 1, 5, 1000}) {
    std::vector<FlatBlock> blocks(static_cast<size_t>(count));
    BlockNames names(blocks, std::string_view("stage.").size(), blocks.size());
    for (int b = 0; b < count; ++b) {
      blocks[size_t(b)].path = fmt::format("stage.gain_{}", b);
      names.add(b);
    }
    for (int b = 0; b < count; ++b) EXPECT_EQ(names.find(fmt::format("gain_{}", b)), b);
    EXPECT_EQ(names.find(fmt::format("gain_{}", count)), -1);
    EXPECT_EQ(names.find(""), -1);
  }
}

}  // namespace
}  // namespace loopwright
