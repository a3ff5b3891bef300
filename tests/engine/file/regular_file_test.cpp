// Only regular files are read. Others are rejected without waiting for another process.
#include "engine/file/regular_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace loopwright::regular_file_test {
namespace {

using testing::HasSubstr;

class RegularFile : public testing::Test {
 protected:
  RegularFile() {
    std::string name = (std::filesystem::temp_directory_path() / "loopwright_file_XXXXXX").string();
    if (::mkdtemp(name.data())) folder_ = name;
    ::alarm(20);  // a test that would wait for a writer ends here
  }
  ~RegularFile() override {
    ::alarm(0);
    std::filesystem::remove_all(folder_);
  }
  std::string path(const std::string& name) const { return folder_ + '/' + name; }
  static std::string failure(const std::string& path, size_t largest = 1000) {
    std::string bytes, reason = read_regular_file(path, largest, bytes);
    EXPECT_EQ(reason.empty() && bytes.size() <= largest, reason.empty());
    return reason;
  }
  std::string folder_;
};

TEST_F(RegularFile, IsReadWhole) {
  const std::string text("a\0b\n", 4);
  std::ofstream(path("a"), std::ios::binary) << text;
  std::string bytes = "old";
  EXPECT_EQ(read_regular_file(path("a"), 4, bytes), "");
  EXPECT_EQ(bytes, text);
  EXPECT_EQ(why_not_regular(path("a")), "");
  EXPECT_THAT(failure(path("a"), 3), HasSubstr("larger than"));
  ASSERT_EQ(::symlink("a", path("link").c_str()), 0);
  EXPECT_EQ(failure(path("link")), "");
}

TEST_F(RegularFile, IsNoPipeSocketDeviceOrFolder) {
  ASSERT_EQ(::mkfifo(path("fifo").c_str(), 0600), 0);
  ASSERT_EQ(::symlink("fifo", path("link").c_str()), 0);
  const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path("socket").c_str(), sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  EXPECT_THAT(failure(path("fifo")), HasSubstr("pipe"));
  EXPECT_THAT(failure(path("link")), HasSubstr("pipe"));
  EXPECT_THAT(failure(path("socket")), HasSubstr("socket"));
  EXPECT_THAT(failure("/dev/zero"), HasSubstr("device"));
  EXPECT_THAT(failure("/dev/null"), HasSubstr("device"));
  EXPECT_THAT(failure("/dev/tty"), HasSubstr("device"));
  EXPECT_THAT(failure(folder_), HasSubstr("folder"));
  EXPECT_THAT(why_not_regular(path("fifo")), HasSubstr("pipe"));
  ::close(listener);
}

TEST_F(RegularFile, ThatIsNotThereIsSaidSo) {
  for (const std::string& name : {path("none"), std::string(), std::string("a\0b", 3), path("none/a")})
    EXPECT_EQ(failure(name), "there is no such file") << name;
}

}  // namespace
}  // namespace loopwright::regular_file_test
