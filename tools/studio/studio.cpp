#include "tools/studio/studio.h"
#include "tools/studio/web/page.h"

namespace loopwright::studio {
namespace {

ServerOptions options_for(int port) {
  ServerOptions options;
  options.port = port;
  options.files = {{"/", "text/html; charset=utf-8", page::index_html},
                   {"/studio.js", "text/javascript; charset=utf-8", page::studio_js},
                   {"/studio.css", "text/css; charset=utf-8", page::studio_css},
                   {"/layout-worker.js", "text/javascript; charset=utf-8", page::layout_worker_js},
                   {"/licenses.txt", "text/plain; charset=utf-8", page::licenses_txt}};
  return options;
}

}  // namespace

Studio::Studio(const std::string& folder, const std::string& opened, int port)
    : server_(options_for(port), *this), session_(folder, opened, [this](int64_t client, std::string text) {
        server_.send(client, std::move(text));
      }) {}

void Studio::connected(int64_t) {}
void Studio::received(int64_t client, std::string_view text) { session_.receive(client, text); }
void Studio::disconnected(int64_t client) { session_.disconnect(client); }
void Studio::tick() { session_.look(); }

Handler::Stored Studio::store(const std::string& name, int64_t offset, bool is_last, std::string_view bytes) {
  try {
    return {200, session_.store(name, offset, is_last, bytes).dump()};
  } catch (const std::exception& error) {
    return {409, Json{{"error", error.what()}}.dump(-1, ' ', false, Json::error_handler_t::replace)};
  }
}

}  // namespace loopwright::studio
