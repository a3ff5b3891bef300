#include "tools/studio/server/server.h"
#include <fmt/format.h>
#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <charconv>
#include <deque>
#include <map>
#include <optional>

namespace loopwright::studio {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;

/// What fails in a way nobody foresaw ends one message, not the page that sent it.
template <class Action> void keep_going(Action&& action) {
  try {
    action();
  } catch (const std::exception&) {
  }
}
using Tcp = asio::ip::tcp;
using Parser = http::request_parser<http::string_body>;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

constexpr std::string_view policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:; "
    "font-src 'self'; "
    "worker-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";
constexpr std::string_view data_path = "/data/";

std::unique_ptr<Parser> make_parser() {
  auto parser = std::make_unique<Parser>();
  parser->header_limit(largest_header);
  parser->body_limit(largest_body);
  return parser;
}

RequestHead head_of(const Request& request) {
  RequestHead head{std::string(request.method_string()), std::string(request.target()), {}, false};
  for (const auto& field : request)
    head.fields.emplace_back(std::string(field.name_string()), std::string(field.value()));
  head.is_upgrade = websocket::is_upgrade(request);
  return head;
}

Response answer(const Request& request, int status, std::string body, std::string_view type) {
  Response response{http::status(status), request.version()};
  response.set(http::field::content_type, std::string(type));
  response.set("Content-Security-Policy", std::string(policy));
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set(http::field::cache_control, "no-store");
  response.keep_alive(request.keep_alive());
  response.body() = std::move(body);
  response.prepare_payload();
  return response;
}

Response refuse(const Request& request, const Refusal& refusal) {
  Response response = answer(request, refusal.status, refusal.text + "\n", "text/plain; charset=utf-8");
  response.keep_alive(false);
  return response;
}

std::optional<int64_t> whole_number(const std::string* text) {
  int64_t number = 0;
  if (!text) return {};
  const char* const end = text->data() + text->size();
  const auto [stop, code] = std::from_chars(text->data(), end, number);
  return code == std::errc() && stop == end && number >= 0 ? std::optional(number) : std::nullopt;
}

/// Answers every request but that of a WebSocket. `handler` null: nothing is stored.
Response respond(const Request& request, Gate& gate, const std::vector<PageFile>& files, Handler* handler) {
  const RequestHead head = head_of(request);
  const auto target = read_target(head.target);
  const std::string* token = target ? target->find("token") : nullptr;
  const bool exchanges = target && target->path == "/" && token && request.method() == http::verb::get;
  if (auto refusal = gate.check(head, !exchanges)) return refuse(request, *refusal);
  if (!target) return refuse(request, {400, "this address is not understood"});
  if (exchanges) {
    // A page that is loaded again with its first address still has its cookie.
    if (!gate.take_token(*token)) {
      if (auto refusal = gate.check(head, true)) return refuse(request, *refusal);
    }
    Response response = answer(request, 303, "", "text/plain");
    response.set(http::field::location, "/");
    response.set(http::field::set_cookie, gate.cookie());
    return response;
  }
  if (request.method() == http::verb::put && target->path.starts_with(data_path)) {
    const auto offset = whole_number(target->find("offset")), last = whole_number(target->find("last"));
    if (!offset || !last || *last > 1) return refuse(request, {400, "offset and last are whole numbers"});
    const Handler::Stored stored =
        handler ? handler->store(target->path.substr(data_path.size()), *offset, *last == 1, request.body())
                : Handler::Stored{};
    return answer(request, stored.status, stored.json, "application/json");
  }
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return refuse(request, {405, "this method is not served"});
  for (const PageFile& file : files) {
    if (file.path != target->path) continue;
    Response response = answer(request, 200, std::string(file.bytes), file.type);
    response.set(http::field::content_encoding, "gzip");
    if (request.method() == http::verb::head) response.body().clear();
    return response;
  }
  return refuse(request, {404, "there is no such page"});
}

}  // namespace

struct Server::Inside : std::enable_shared_from_this<Inside> {
  class Connection;
  class Page;

  ServerOptions options;
  Handler& handler;
  std::unique_ptr<asio::io_context> own_context = std::make_unique<asio::io_context>(1);
  asio::io_context& context = *own_context;
  Tcp::acceptor acceptor{context};
  asio::steady_timer timer{context};
  std::optional<Gate> gate;
  std::map<int64_t, std::weak_ptr<Page>> pages;
  int connections = 0;
  int64_t last_client = 0;

  Inside(ServerOptions o, Handler& h) : options(std::move(o)), handler(h) {
    const Tcp::endpoint endpoint(asio::ip::address_v4::loopback(), static_cast<unsigned short>(options.port));
    beast::error_code code;
    acceptor.open(endpoint.protocol(), code);
    if (!code) acceptor.set_option(asio::socket_base::reuse_address(true), code);
    if (!code) acceptor.bind(endpoint, code);
    if (!code) acceptor.listen(asio::socket_base::max_listen_connections, code);
    if (code)
      throw std::runtime_error(fmt::format("port {} cannot be used: {}", options.port, code.message()));
    gate.emplace(acceptor.local_endpoint().port(), std::vector<std::string>());
  }

  void accept();
  void start_ticks() {
    if (pages.empty()) return;
    timer.expires_after(options.tick);
    timer.async_wait([self = shared_from_this()](beast::error_code code) {
      if (code || self->pages.empty()) return;
      keep_going([&] { self->handler.tick(); });
      self->start_ticks();
    });
  }
};

/// One page: a WebSocket. Messages are sent in order; a page that does not read them is closed.
class Server::Inside::Page : public std::enable_shared_from_this<Page> {
 public:
  Page(std::shared_ptr<Inside> server, beast::tcp_stream&& stream, int64_t client)
      : server_(std::move(server)), socket_(std::move(stream)), client_(client) {}
  ~Page() { --server_->connections; }
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  void start(Request request) {
    beast::get_lowest_layer(socket_).expires_never();
    socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    socket_.read_message_max(largest_body);
    request_ = std::move(request);
    socket_.async_accept(request_, [self = shared_from_this()](beast::error_code code) {
      if (code) return;
      const bool is_first = self->server_->pages.empty();
      self->server_->pages[self->client_] = self;
      self->server_->handler.connected(self->client_);
      if (is_first) self->server_->start_ticks();
      self->is_open_ = true;
      self->read();
    });
  }
  void send(std::string text) {
    constexpr size_t most_waiting = 256 << 20;  // bytes
    waiting_ += text.size();
    if (waiting_ > most_waiting) return fail();
    queue_.push_back(std::move(text));
    if (queue_.size() == 1) write();
  }
  void close() { beast::get_lowest_layer(socket_).cancel(); }

 private:
  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](beast::error_code code, size_t) {
      if (code) return self->fail();
      if (self->is_too_fast()) {
        self->socket_.async_close(websocket::close_code::policy_error,
                                  [self](beast::error_code) { self->fail(); });
        return;
      }
      const std::string text = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      keep_going([&] { self->server_->handler.received(self->client_, text); });
      self->read();
    });
  }
  void write() {
    socket_.text(true);
    socket_.async_write(asio::buffer(queue_.front()),
                        [self = shared_from_this()](beast::error_code code, size_t) {
                          if (code) return self->fail();
                          self->waiting_ -= self->queue_.front().size();
                          self->queue_.pop_front();
                          if (!self->queue_.empty()) self->write();
                        });
  }
  /// A bucket that fills with every message and empties at the permitted rate.
  bool is_too_fast() {
    const auto now = std::chrono::steady_clock::now();
    const double most = server_->options.most_messages;
    bucket_ = std::max(0.0, bucket_ - most * std::chrono::duration<double>(now - before_).count()) + 1;
    before_ = now;
    return bucket_ > most;
  }
  void fail() {
    if (!is_open_) return;
    is_open_ = false;
    server_->pages.erase(client_);
    server_->handler.disconnected(client_);
    close();
  }

  std::shared_ptr<Inside> server_;
  websocket::stream<beast::tcp_stream> socket_;
  const int64_t client_;
  Request request_;
  beast::flat_buffer buffer_;
  std::deque<std::string> queue_;
  size_t waiting_ = 0;
  double bucket_ = 0;
  std::chrono::steady_clock::time_point before_{};
  bool is_open_ = false;
};

class Server::Inside::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(std::shared_ptr<Inside> server, Tcp::socket&& socket)
      : server_(std::move(server)), stream_(std::move(socket)) {}
  ~Connection() {
    if (!is_handed_over_) --server_->connections;
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void read() {
    parser_ = make_parser();
    stream_.expires_after(is_known_ ? server_->options.patience : server_->options.first_patience);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](beast::error_code code, size_t) { self->got(code); });
  }

 private:
  void got(beast::error_code code) {
    is_known_ = true;
    if (code == http::error::end_of_stream || code == beast::error::timeout) return;
    if (code == http::error::header_limit)
      return write(refuse(parser_->get(), {431, "the header is too long"}));
    if (code == http::error::body_limit) return write(refuse(parser_->get(), {413, "the body is too long"}));
    if (code.category() == http::make_error_code(http::error::bad_target).category())
      return write(refuse(parser_->get(), {400, "this is no request"}));
    if (code) return;
    Request request = parser_->release();
    const RequestHead head = head_of(request);
    if (head.is_upgrade) {
      auto refusal = server_->gate->check(head, true);
      if (!refusal && head.target != "/socket") refusal = Refusal{404, "there is no such socket"};
      if (refusal) return write(refuse(request, *refusal));
      is_handed_over_ = true;
      std::make_shared<Page>(server_, std::move(stream_), ++server_->last_client)->start(std::move(request));
      return;
    }
    write(respond(request, *server_->gate, server_->options.files, &server_->handler));
  }
  void write(Response response) {
    response_ = std::move(response);
    http::async_write(stream_, response_, [self = shared_from_this()](beast::error_code code, size_t) {
      if (code) return;
      if (self->response_.keep_alive()) return self->read();
      beast::error_code ignored;
      self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
    });
  }

  std::shared_ptr<Inside> server_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  std::unique_ptr<Parser> parser_;
  Response response_;
  bool is_handed_over_ = false;
  bool is_known_ = false;  ///< has sent a request
};

void Server::Inside::accept() {
  acceptor.async_accept([self = shared_from_this()](beast::error_code code, Tcp::socket socket) {
    if (code == asio::error::operation_aborted) return;
    if (!code && self->connections < self->options.most_connections) {
      ++self->connections;
      std::make_shared<Connection>(self, std::move(socket))->read();
    }
    self->accept();
  });
}

Server::Server(ServerOptions options, Handler& handler)
    : inside_(std::make_shared<Inside>(std::move(options), handler)) {
  inside_->accept();
}

Server::~Server() {
  stop();
  // What waits in the context holds on to the inside, which holds the context: it is taken out of this
  // circle.
  const std::unique_ptr<asio::io_context> context = std::move(inside_->own_context);
  inside_.reset();
}

int Server::port() const { return inside_->acceptor.local_endpoint().port(); }

std::string Server::address() const {
  return fmt::format("http://127.0.0.1:{}/?token={}", port(), inside_->gate->token());
}

void Server::run() {
  // A request that fails in a way nobody foresaw ends its connection, not the process.
  while (true) {
    try {
      inside_->context.run();
      return;
    } catch (const std::exception&) {
    }
  }
}

void Server::stop() { inside_->context.stop(); }

void Server::send(int64_t client, std::string text) {
  asio::post(inside_->context, [inside = inside_, client, text = std::move(text)]() mutable {
    const auto found = inside->pages.find(client);
    if (found == inside->pages.end()) return;
    if (const auto page = found->second.lock()) page->send(std::move(text));
  });
}

int status_of_bytes(std::string_view bytes, Gate& gate) {
  const auto parser = make_parser();
  parser->eager(true);
  beast::error_code code;
  for (size_t at = 0; at < bytes.size() && !parser->is_done();) {
    const size_t count = parser->put(asio::buffer(bytes.data() + at, bytes.size() - at), code);
    if (code == http::error::need_more) return 0;
    if (code == http::error::header_limit) return 431;
    if (code == http::error::body_limit) return 413;
    if (code) return 400;
    if (count == 0) return 0;
    at += count;
  }
  if (!parser->is_done()) return 0;
  const Request request = parser->release();
  const RequestHead head = head_of(request);
  if (head.is_upgrade) {
    if (const auto refusal = gate.check(head, true)) return refusal->status;
    return head.target == "/socket" ? 101 : 404;
  }
  return int(respond(request, gate, {}, nullptr).result_int());
}

}  // namespace loopwright::studio
