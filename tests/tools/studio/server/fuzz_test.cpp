#include <gtest/gtest.h>
#include <cstdlib>
#include <random>
#include <set>
#include "tools/studio/server/server.h"

namespace loopwright::studio::fuzz_test {

namespace {

std::string seed(const Gate& gate, int which) {
  const std::string cookie = gate.cookie().substr(0, gate.cookie().find(';'));
  const std::string own = "Host: 127.0.0.1:80\r\nOrigin: http://127.0.0.1:80\r\nCookie: " + cookie + "\r\n";
  switch (which) {
    case 0:
      return "GET /?token=" + gate.token() + " HTTP/1.1\r\n" + own + "\r\n";
    case 1:
      return "GET /socket HTTP/1.1\r\n" + own +
             "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
             "abc\r\n\r\n";
    case 2:
      return "PUT /data/a.csv?offset=0&last=1 HTTP/1.1\r\n" + own + "Content-Length: 5\r\n\r\nt,x\n1";
    case 3:
      return "PUT /data/a.csv?offset=0&last=0 HTTP/1.1\r\n" + own +
             "Transfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n";
    default:
      return "GET /studio.js HTTP/1.1\r\n" + own + "Sec-Fetch-Site: same-origin\r\n\r\n";
  }
}

std::string mutant(std::string bytes, std::mt19937& random) {
  static const std::string pieces[] = {"\r\n",
                                       "\r\n\r\n",
                                       ": ",
                                       "%2e",
                                       "%00",
                                       "..",
                                       "/",
                                       "\\",
                                       "Host: x\r\n",
                                       ";",
                                       "Content-Length: 18446744073709551616\r\n",
                                       "chunked",
                                       "\x80",
                                       "?",
                                       "&",
                                       "="};
  for (int changes = 1 + int(random() % 4); changes > 0; --changes) {
    const size_t at = bytes.empty() ? 0 : random() % bytes.size();
    switch (random() % 5) {
      case 0:
        if (!bytes.empty()) bytes[at] = char(random());
        break;
      case 1:
        bytes.erase(at, random() % 20);
        break;
      case 2:
        bytes.insert(at, pieces[random() % std::size(pieces)]);
        break;
      case 3:
        bytes.insert(at, bytes.substr(at, random() % 40));
        break;
      default:
        bytes.resize(at);
    }
  }
  return bytes;
}

}  // namespace

/// LOOPWRIGHT_MUTANTS=1000000 for a night.
TEST(RequestParser, MutantsOfRequestsAreAnsweredOrRefused) {
  const char* asked = std::getenv("LOOPWRIGHT_MUTANTS");
  const int count = asked ? std::atoi(asked) : 20'000;
  Gate gate(80, {});
  std::mt19937 random(1);
  const std::set<int> expected = {0, 101, 200, 303, 400, 403, 404, 405, 413, 431};
  for (int i = 0; i < count; ++i) {
    const std::string bytes = mutant(seed(gate, int(random() % 5)), random);
    const int status = status_of_bytes(bytes, gate);
    ASSERT_TRUE(expected.contains(status)) << status << "\n" << bytes;
  }
}

TEST(RequestParser, TargetsThatLeadElsewhereAreNotUnderstood) {
  for (const char* target : {"", "x", "//x/..", "/..", "/a/../b", "/./a", "/a//b", "/%2e%2e/a", "/a%2fb",
                             "/a%5cb", "/a\\b", "/%", "/%zz", "/%00", "/a b", "/\x80", "/a#b", "/a?x=1&x=2"})
    EXPECT_FALSE(read_target(target)) << target;
  const auto target = read_target("/data/a%20b.csv?offset=12&last=1");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/data/a b.csv");
  EXPECT_EQ(*target->find("offset"), "12");
}

TEST(Tokens, AreLongAndCompareWhole) {
  EXPECT_EQ(random_token().size(), 64u);
  EXPECT_NE(random_token(), random_token());
  EXPECT_TRUE(are_equal("abc", "abc"));
  EXPECT_FALSE(are_equal("abc", "abd"));
  EXPECT_FALSE(are_equal("abc", "ab"));
  EXPECT_FALSE(are_equal("", "a"));
  EXPECT_FALSE(are_equal("a", ""));
}

}  // namespace loopwright::studio::fuzz_test
