#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>
#include <thread>
#include <gtest/gtest.h>
#include "tools/studio/server/server.h"

namespace loopwright::studio::hostile_request_test {

namespace {

/// Remembers what reached it.
struct Noticing : Handler {
  int messages = 0, stored = 0;
  std::atomic<int> pages = 0;
  void connected(int64_t) override { ++pages; }
  void received(int64_t, std::string_view) override { ++messages; }
  void disconnected(int64_t) override {}
  void tick() override {}
  Stored store(const std::string&, int64_t, bool, std::string_view) override {
    ++stored;
    return {200, "{}"};
  }
};

/// A server on a thread of its own, whose token has been exchanged.
class HostileRequests : public testing::Test {
 protected:
  HostileRequests() : server_(options(), handler_), thread_([this] { server_.run(); }) {
    const std::string address = server_.address();
    token_ = address.substr(address.find("token=") + 6);
  }
  ~HostileRequests() override {
    server_.stop();
    thread_.join();
  }
  static ServerOptions options() {
    ServerOptions options;
    options.files = {{"/", "text/html", "page"}};
    options.patience = std::chrono::seconds(1);
    return options;
  }

  /// Everything that the server answers until it closes or is silent.
  std::string ask(const std::string& bytes, int silence_ms = 400) const {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET, address.sin_port = htons(uint16_t(server_.port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) return "no connection";
    timeval silence{silence_ms / 1000, silence_ms % 1000 * 1000};
    ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &silence, sizeof silence);
    for (size_t at = 0; at < bytes.size();) {
      const ssize_t count = ::send(socket, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
      if (count <= 0) break;
      at += size_t(count);
    }
    std::string answer(1 << 16, '\0');
    const ssize_t count = ::recv(socket, answer.data(), answer.size(), 0);
    ::close(socket);
    return count > 0 ? answer.substr(0, size_t(count)) : "";
  }
  int status(const std::string& bytes, int silence_ms = 400) const {
    const std::string answer = ask(bytes, silence_ms);
    return answer.size() > 12 ? std::atoi(answer.c_str() + 9) : 0;
  }

  std::string host() const { return "127.0.0.1:" + std::to_string(server_.port()); }
  std::string own(const std::string& request, const std::string& fields) const {
    return request + " HTTP/1.1\r\nHost: " + host() + "\r\n" + fields + "\r\n";
  }
  std::string exchange() {
    const std::string answer = ask(own("GET /?token=" + token_, ""));
    const size_t begin = answer.find("Set-Cookie: ") + 12;
    return "Cookie: " + answer.substr(begin, answer.find(';', begin) - begin) + "\r\n";
  }
  std::string origin() const { return "Origin: http://" + host() + "\r\n"; }
  static std::string upgrade() {
    return "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  }

  Noticing handler_;
  Server server_;
  std::thread thread_;
  std::string token_;
};

}  // namespace

TEST_F(HostileRequests, TheTokenOpensThePageOnce) {
  EXPECT_EQ(status(own("GET /", "")), 403);
  EXPECT_EQ(status(own("GET /?token=" + std::string(64, '0'), "")), 403);
  EXPECT_EQ(status(own("GET /?token=" + token_.substr(1), "")), 403);
  EXPECT_EQ(status(own("GET /?token=", "")), 403);
  const std::string answer = ask(own("GET /?token=" + token_, ""));
  EXPECT_NE(answer.find("303"), answer.npos);
  EXPECT_NE(answer.find("HttpOnly; SameSite=Strict"), answer.npos) << answer;
  EXPECT_EQ(status(own("GET /?token=" + token_, "")), 403) << "the token was used";
}

TEST_F(HostileRequests, ThePageItselfIsServedUnderStrictRules) {
  const std::string answer = ask(own("GET /", exchange()));
  EXPECT_NE(answer.find("200 OK"), answer.npos) << answer;
  for (const char* rule :
       {"default-src 'none'", "script-src 'self'", "frame-ancestors 'none'", "base-uri 'none'",
        "form-action 'none'", "Cross-Origin-Resource-Policy: same-origin",
        "Cross-Origin-Opener-Policy: same-origin", "nosniff", "no-store"})
    EXPECT_NE(answer.find(rule), answer.npos) << rule;
  EXPECT_EQ(answer.find("Access-Control"), answer.npos);
  EXPECT_EQ(answer.find("unsafe"), answer.npos);
}

TEST_F(HostileRequests, EachIsRefused) {
  const std::string cookie = exchange(), port = std::to_string(server_.port());
  const auto with_host = [&](const std::string& name) {
    return "GET / HTTP/1.1\r\nHost: " + name + "\r\n" + cookie + "\r\n";
  };
  const auto socket = [&](const std::string& fields) { return own("GET /socket", upgrade() + fields); };
  const std::string put = "PUT /data/x.csv?offset=0&last=1";
  const std::string body = "Content-Length: 1\r\n";
  const std::string wrong_cookie = "Cookie: loopwright_studio_" + port + "=" + std::string(64, 'a') + "\r\n";
  const struct {
    const char* what;
    std::string bytes;
    int status;
  } table[] = {
      {"a foreign host", with_host("evil.example"), 403},
      {"a foreign host with the right port", with_host("evil.example:" + port), 403},
      {"a host that begins as ours", with_host(host() + ".evil.example"), 403},
      {"a host without port", with_host("127.0.0.1"), 403},
      {"another port", with_host("127.0.0.1:1"), 403},
      {"another loopback address", with_host("127.0.0.2:" + port), 403},
      {"no host", "GET / HTTP/1.1\r\n" + cookie + "\r\n", 403},
      {"an empty host", with_host(""), 403},
      {"two hosts", "GET / HTTP/1.1\r\nHost: " + host() + "\r\nHost: evil.example\r\n" + cookie + "\r\n",
       403},
      {"a host in the target",
       "GET http://evil.example/ HTTP/1.1\r\nHost: " + host() + "\r\n" + cookie + "\r\n", 400},
      {"no cookie", own("GET /", ""), 403},
      {"another cookie", own("GET /", "Cookie: a=b\r\n"), 403},
      {"a wrong secret", own("GET /", wrong_cookie), 403},
      {"a cookie that was added by somebody else",
       own("GET /", cookie.substr(0, cookie.size() - 2) + "; " + wrong_cookie.substr(8)), 403},
      {"two fields of cookies", own("GET /", cookie + wrong_cookie), 403},
      {"an empty cookie", own("GET /", "Cookie: loopwright_studio_" + port + "=\r\n"), 403},
      {"a fetch from another site", own("GET /", cookie + "Sec-Fetch-Site: cross-site\r\n"), 403},
      {"a fetch from another port", own("GET /", cookie + "Sec-Fetch-Site: same-site\r\n"), 403},
      {"a fetch with another origin", own("GET /", cookie + "Origin: http://evil.example\r\n"), 403},
      {"a fetch without origin of its own", own("GET /", cookie + "Origin: null\r\n"), 403},
      {"a socket without origin", socket(cookie), 403},
      {"a socket with the origin null", socket(cookie + "Origin: null\r\n"), 403},
      {"a socket of another page", socket(cookie + "Origin: http://evil.example\r\n"), 403},
      {"a socket of another port", socket(cookie + "Origin: http://127.0.0.1:1\r\n"), 403},
      {"a socket over https", socket(cookie + "Origin: https://" + host() + "\r\n"), 403},
      {"a socket of a longer origin", socket(cookie + "Origin: http://" + host() + ".evil.example\r\n"), 403},
      {"a socket under the other name of this machine",
       socket(cookie + "Origin: http://localhost:" + port + "\r\n"), 403},
      {"a socket with two origins", socket(cookie + origin() + "Origin: http://evil.example\r\n"), 403},
      {"a socket without cookie", socket(origin()), 403},
      {"a socket with a wrong secret", socket(origin() + wrong_cookie), 403},
      {"a socket at another address", own("GET /other", upgrade() + cookie + origin()), 404},
      {"a write without origin", own(put, cookie + body) + "x", 403},
      {"a write with the origin null", own(put, cookie + body + "Origin: null\r\n") + "x", 403},
      {"a write of another page", own(put, cookie + body + "Origin: http://evil.example\r\n") + "x", 403},
      {"a write without cookie", own(put, origin() + body) + "x", 403},
      {"a form",
       own("POST /", cookie + origin() + body + "Content-Type: application/x-www-form-urlencoded\r\n") + "x",
       405},
      {"a question about permissions", own("OPTIONS /", cookie + origin()), 405},
      {"removal", own("DELETE /", cookie + origin()), 405},
      {"an escaped way out", own("GET /..%2f..%2fetc/passwd", cookie), 400},
      {"a way out", own("GET /../etc/passwd", cookie), 400},
      {"a way out in the middle", own("GET /a/../../etc/passwd", cookie), 400},
      {"a write with an escaped way out",
       own("PUT /data/..%2fx.csv?offset=0&last=1", cookie + origin() + body) + "x", 400},
      {"a write with escaped dots",
       own("PUT /data/%2e%2e/x.csv?offset=0&last=1", cookie + origin() + body) + "x", 400},
      {"a write with a backslash", own("PUT /data/..\\x.csv?offset=0&last=1", cookie + origin() + body) + "x",
       400},
      {"a write with a zero byte", own("PUT /data/x%00.csv?offset=0&last=1", cookie + origin() + body) + "x",
       400},
      {"a write at a negative place", own("PUT /data/x.csv?offset=-1&last=1", cookie + origin() + body) + "x",
       400},
      {"a write at a place that is no number",
       own("PUT /data/x.csv?offset=1e9&last=1", cookie + origin() + body) + "x", 400},
      {"a name twice", own("PUT /data/x.csv?offset=0&offset=1&last=1", cookie + origin() + body) + "x", 400},
      {"a huge header", own("GET /", cookie + "X: " + std::string(20'000, 'x') + "\r\n"), 431},
      {"a huge body", own(put, cookie + origin() + "Content-Length: 99999999999\r\n") + "x", 413},
      {"two lengths", own(put, cookie + origin() + "Content-Length: 1\r\nContent-Length: 2\r\n") + "x", 400},
      {"a length that is no number", own(put, cookie + origin() + "Content-Length: -1\r\n") + "x", 400},
      {"no request", "\x16\x03\x01\x02\r\n\r\n", 400},
      {"an unknown version", "GET / HTTP/9.9\r\nHost: " + host() + "\r\n\r\n", 400},
      {"a page that is not there", own("GET /.ssh/id_rsa", cookie), 404},
  };
  for (const auto& row : table) EXPECT_EQ(status(row.bytes), row.status) << row.what;
  EXPECT_EQ(handler_.stored, 0);
  EXPECT_EQ(handler_.pages, 0);
  EXPECT_EQ(status(own("GET /", cookie)), 200) << "the server still serves its page";
}

TEST_F(HostileRequests, TheOwnPageMayDoAllOfIt) {
  const std::string cookie = exchange();
  EXPECT_EQ(status(own("GET /socket", upgrade() + cookie + origin())), 101);
  EXPECT_EQ(status(own("PUT /data/x.csv?offset=0&last=1", cookie + origin() + "Content-Length: 1\r\n") + "x"),
            200);
  EXPECT_EQ(handler_.stored, 1);
  EXPECT_EQ(status(own("GET /", cookie + "Sec-Fetch-Site: same-origin\r\n")), 200);
}

TEST_F(HostileRequests, ASlowRequestIsEnded) {
  const std::string cookie = exchange();
  const auto begin = std::chrono::steady_clock::now();
  ask(own("PUT /data/x.csv?offset=0&last=1", cookie + origin() + "Content-Length: 10\r\n") + "x", 5000);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(4));
  EXPECT_EQ(handler_.stored, 0);
}

TEST_F(HostileRequests, ManyConnectionsLeaveTheServerAlive) {
  const std::string cookie = exchange();
  std::vector<std::thread> threads;
  for (int i = 0; i < 40; ++i) threads.emplace_back([&] { ask("GET / HTTP/1.1\r\nHost: ", 1500); });
  for (std::thread& thread : threads) thread.join();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(status(own("GET /", cookie)), 200);
}

}  // namespace loopwright::studio::hostile_request_test
