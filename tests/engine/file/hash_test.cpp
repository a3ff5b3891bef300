#include "engine/file/hash.h"

#include <gtest/gtest.h>

namespace loopwright::hash_test {
namespace {

TEST(ContentHash, GivesThePublishedValues) {
  // draft-eastlake-fnv, appendix C
  EXPECT_EQ(content_hash(""), "cbf29ce484222325");
  EXPECT_EQ(content_hash("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(content_hash("foobar"), "85944171f73967e8");
}

TEST(ContentHash, IsTheSameInParts) {
  EXPECT_EQ(ContentHash().add("foo").add("").add("bar").text(), content_hash("foobar"));
}

TEST(ContentHash, ReadsBytesAsUnsignedAndZerosAsBytes) {
  EXPECT_NE(content_hash(std::string_view("\0", 1)), content_hash(""));
  EXPECT_EQ(ContentHash().add("\xFF").value(), (0xcbf29ce484222325u ^ 0xFFu) * 0x100000001b3u);
}

}  // namespace
}  // namespace loopwright::hash_test
