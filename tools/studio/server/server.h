/// HTTP and one WebSocket for each open page, on one thread. It knows nothing of diagrams.
#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>
#include "tools/studio/server/gate.h"

namespace loopwright::studio {

/// A file of the page, compressed with gzip.
struct PageFile {
  std::string_view path, type, bytes;
};

struct ServerOptions {
  int port = 0;  ///< 0: any free one
  std::vector<PageFile> files;
  std::chrono::milliseconds tick{300};     ///< between calls of Handler::tick while a page is open
  std::chrono::seconds patience{15};       ///< for a whole request
  std::chrono::seconds first_patience{3};  ///< for the first one: idle connections would keep pages out
  int most_connections = 16;
  double most_messages = 500;  ///< a second, of one page
};

constexpr uint32_t largest_header = 16 << 10;  ///< bytes
constexpr uint64_t largest_body = 16 << 20;

/// What the server is for. Called on the thread of Server::run, except `Server::send`.
class Handler {
 public:
  virtual ~Handler() = default;
  virtual void connected(int64_t client) = 0;
  virtual void received(int64_t client, std::string_view text) = 0;
  virtual void disconnected(int64_t client) = 0;
  virtual void tick() = 0;
  struct Stored {
    int status = 200;
    std::string json;
  };
  virtual Stored store(const std::string& name, int64_t offset, bool is_last, std::string_view bytes) = 0;
};

class Server {
 public:
  /// Listens on the loopback interface. Throws std::runtime_error if the port is not free.
  Server(ServerOptions options, Handler& handler);
  ~Server();

  int port() const;
  /// With the token that opens the page.
  std::string address() const;
  /// Until stop(); any thread may call that.
  void run();
  void stop();
  /// Any thread; nothing happens if the client is gone.
  void send(int64_t client, std::string text);

 private:
  struct Inside;
  std::shared_ptr<Inside> inside_;
};

/// One request in these bytes, as far as the parser and its limits accept it: the fuzz target of the server.
/// Returns the status that would be answered; 0: more bytes are needed.
int status_of_bytes(std::string_view bytes, Gate& gate);

}  // namespace loopwright::studio
