/// `loopwright studio`: the page, the server and the session together.
#pragma once
#include <memory>
#include <string>
#include "tools/studio/server/server.h"
#include "tools/studio/session/session.h"

namespace loopwright::studio {

class Studio : public Handler {
 public:
  /// Serves a folder, on a port of the loopback interface (0: any free one). `opened`: a file in it that the
  /// page opens first; empty: none. Throws std::runtime_error.
  Studio(const std::string& folder, const std::string& opened, int port);
  Server& server() { return server_; }

 private:
  void connected(int64_t client) override;
  void received(int64_t client, std::string_view text) override;
  void disconnected(int64_t client) override;
  void tick() override;
  Stored store(const std::string& name, int64_t offset, bool is_last, std::string_view bytes) override;

  Server server_;
  Session session_;  ///< its jobs end before the server does
};

}  // namespace loopwright::studio
