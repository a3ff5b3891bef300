#include "engine/block/memory_layout.h"
#include <gmock/gmock.h>
#include <cstdint>
#include <span>

namespace loopwright::memory_layout_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

struct IndexAmongNumbers {
  double first, second;
  int index;
  double last;
};
struct ViewsAndArrays {
  std::span<double> line;
  double filtered[3];
  uint64_t sample;
  bool is_on;
  double held;
};
struct IndicesAlone {
  int64_t sample;
  int newest, count;
};

TEST(MemoryLayout, NumbersAreFoundAmongIndicesAndViews) {
  EXPECT_THAT(number_words<IndexAmongNumbers>(), ElementsAre(0, 1, 3));
  EXPECT_THAT(number_words<ViewsAndArrays>(), ElementsAre(2, 3, 4, 7));
  EXPECT_THAT(number_words<IndicesAlone>(), IsEmpty());
}

}  // namespace
}  // namespace loopwright::memory_layout_test
