/// Who may ask what: every page in the same browser, and every user of this machine, reaches the server.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace loopwright::studio {

/// What decides about a request.
struct RequestHead {
  std::string method, target;
  std::vector<std::pair<std::string, std::string>> fields;  ///< as received
  bool is_upgrade = false;

  /// The value of a field; nothing if it is absent or repeated.
  std::optional<std::string> field(std::string_view name) const;
  size_t count(std::string_view name) const;
};

/// The path of a target without its query, and the query's values, decoded once.
struct Target {
  std::string path;
  std::vector<std::pair<std::string, std::string>> query;
  const std::string* find(std::string_view name) const;
};
/// Nothing for a target that is not plain: no leading slash, control or non-ASCII characters, bad escapes,
/// escaped slashes or dots, backslashes, "." or ".." as a part.
std::optional<Target> read_target(std::string_view target);

/// 256 random bits as hexadecimal digits. Throws std::runtime_error without a source of randomness.
std::string random_token();
/// In a time that does not depend on where they differ.
bool are_equal(std::string_view a, std::string_view b);

struct Refusal {
  int status = 403;
  std::string text;
};

class Gate {
 public:
  /// `host`: further names under which the server may be addressed, with the port.
  Gate(int port, std::vector<std::string> hosts);

  /// The token that is exchanged for the cookie, once.
  const std::string& token() const { return token_; }
  std::string cookie_name() const { return cookie_name_; }
  /// The head of an answer that sets the cookie.
  std::string cookie() const;

  /// Checks that apply to every request, in the order: host, origin, fetch site, cookie. `needs_cookie` is
  /// false for the exchange of the token only.
  std::optional<Refusal> check(const RequestHead& head, bool needs_cookie) const;
  /// Whether the token is right; then it is no longer valid.
  bool take_token(std::string_view token);

 private:
  bool is_known_host(std::string_view host) const;
  bool has_cookie(const RequestHead& head) const;

  std::string cookie_name_, token_, secret_;
  std::vector<std::string> hosts_;
  bool token_is_used_ = false;
};

}  // namespace loopwright::studio
