/// Records that a page sends in parts.
#include <gtest/gtest.h>
#include "tests/tools/studio/session/studio_folder.h"
#include "tools/studio/session/folder.h"

namespace loopwright::studio::stored_record_test {
namespace {

std::string many_rows() {
  std::string text = "t_s,y\n";
  for (int row = 0; row < 300000; ++row)
    text += std::to_string(row) + "," + std::to_string(7919L * row % 10007) + "\n";
  return text;
}

TEST(StoredRecord, IsThatOfItsPartsWhateverTheirSize) {
  const StudioFolder folder;
  const Folder served(folder.path());
  const std::string text = many_rows();
  for (const size_t part : {size_t(4096), size_t(777777), size_t(4) << 20, text.size()}) {
    const std::string name = "record" + std::to_string(part) + ".csv";
    for (size_t at = 0; at < text.size(); at += part)
      served.store_part(name, int64_t(at), at + part >= text.size(), std::string_view(text).substr(at, part));
    EXPECT_TRUE(folder.read(name) == text) << part;
  }
}

TEST(StoredRecord, NeedsAllItsPartsInTheirOrder) {
  const StudioFolder folder;
  const Folder served(folder.path());
  served.store_part("a.csv", 0, false, "t,y\n");
  EXPECT_THROW(served.store_part("a.csv", 8, true, "1,2\n"), Refused);
  EXPECT_THROW(served.store_part("b.csv", 4, true, "1,2\n"), Refused);
  EXPECT_FALSE(std::filesystem::exists(folder.path("a.csv")));
  served.store_part("a.csv", 4, true, "0,1\n");
  EXPECT_EQ(folder.read("a.csv"), "t,y\n0,1\n");
}

}  // namespace
}  // namespace loopwright::studio::stored_record_test
