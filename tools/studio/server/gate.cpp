#include "tools/studio/server/gate.h"
#include <fmt/format.h>
#include <sys/random.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <stdexcept>

namespace loopwright::studio {
namespace {

bool is_same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

bool is_plain(std::string_view text) {
  return std::ranges::all_of(text,
                             [](unsigned char c) { return c > 0x20 && c < 0x7f && c != '\\' && c != '#'; });
}

std::optional<std::string> decoded(std::string_view text) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result += text[i];
      continue;
    }
    if (i + 2 >= text.size() || digit(text[i + 1]) < 0 || digit(text[i + 2]) < 0) return {};
    const char c = char(digit(text[i + 1]) * 16 + digit(text[i + 2]));
    const bool is_control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    if (is_control || c == '/' || c == '\\' || c == '.' || c == '%') return {};
    result += c;
    i += 2;
  }
  return result;
}

bool leads_elsewhere(std::string_view path) {
  for (size_t at = 1; at <= path.size();) {
    const size_t end = std::min(path.find('/', at), path.size());
    const std::string_view part = path.substr(at, end - at);
    if (part == "." || part == ".." || (part.empty() && end < path.size())) return true;
    at = end + 1;
  }
  return false;
}

}  // namespace

std::optional<std::string> RequestHead::field(std::string_view name) const {
  const auto found = std::ranges::find_if(fields, [&](const auto& f) { return is_same_name(f.first, name); });
  return found == fields.end() || count(name) != 1 ? std::nullopt : std::optional(found->second);
}

size_t RequestHead::count(std::string_view name) const {
  return size_t(std::ranges::count_if(fields, [&](const auto& f) { return is_same_name(f.first, name); }));
}

const std::string* Target::find(std::string_view name) const {
  const auto found = std::ranges::find(query, name, [](const auto& q) { return std::string_view(q.first); });
  return found == query.end() ? nullptr : &found->second;
}

std::optional<Target> read_target(std::string_view target) {
  constexpr size_t longest = 4096;
  if (target.empty() || target.size() > longest || target[0] != '/' || !is_plain(target)) return {};
  const size_t mark = std::min(target.find('?'), target.size());
  if (leads_elsewhere(target.substr(0, mark))) return {};
  const auto path = decoded(target.substr(0, mark));
  if (!path) return {};
  Target result{*path, {}};
  for (size_t at = mark + 1; at < target.size();) {
    const size_t end = std::min(target.find('&', at), target.size());
    const std::string_view pair = target.substr(at, end - at);
    const size_t equal = std::min(pair.find('='), pair.size());
    const auto name = decoded(pair.substr(0, equal));
    const auto value = decoded(equal < pair.size() ? pair.substr(equal + 1) : "");
    if (!name || !value || result.find(*name)) return {};
    result.query.emplace_back(*name, *value);
    at = end + 1;
  }
  return result;
}

std::string random_token() {
  std::array<unsigned char, 32> bytes{};
  for (size_t at = 0; at < bytes.size();) {
    const ssize_t count = ::getrandom(bytes.data() + at, bytes.size() - at, 0);
    if (count < 0 && errno != EINTR) throw std::runtime_error("the system has no random numbers");
    if (count > 0) at += size_t(count);
  }
  std::string text;
  for (unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

bool are_equal(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (size_t i = 0; i < a.size(); ++i)
    difference |=
        static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b.empty() ? 0 : b[i % b.size()]);
  return difference == 0;
}

Gate::Gate(int port, std::vector<std::string> hosts)
    : cookie_name_(fmt::format("loopwright_studio_{}", port)),
      token_(random_token()),
      secret_(random_token()),
      hosts_(std::move(hosts)) {
  for (const char* name : {"127.0.0.1", "localhost", "[::1]"})
    hosts_.push_back(fmt::format("{}:{}", name, port));
}

std::string Gate::cookie() const {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict", cookie_name_, secret_);
}

bool Gate::is_known_host(std::string_view host) const {
  return std::ranges::find(hosts_, host) != hosts_.end();
}

bool Gate::has_cookie(const RequestHead& head) const {
  const auto cookies = head.field("Cookie");
  if (!cookies) return false;
  const std::string wanted = cookie_name_ + "=";
  bool found = false;
  for (size_t at = 0; at < cookies->size();) {
    const size_t end = std::min(cookies->find(';', at), cookies->size());
    std::string_view pair = std::string_view(*cookies).substr(at, end - at);
    pair.remove_prefix(std::min(pair.find_first_not_of(' '), pair.size()));
    if (pair.starts_with(wanted)) {
      if (found) return false;  // two of them: one was set by somebody else
      found = are_equal(pair.substr(wanted.size()), secret_);
      if (!found) return false;
    }
    at = end + 1;
  }
  return found;
}

std::optional<Refusal> Gate::check(const RequestHead& head, bool needs_cookie) const {
  const auto host = head.field("Host");
  if (!host || !is_known_host(*host)) return Refusal{403, "this server is not addressed by that name"};
  // The page's own origin, under the name that this request uses.
  const bool changes_something = head.is_upgrade || (head.method != "GET" && head.method != "HEAD");
  const bool has_origin = head.count("Origin") > 0;
  if (changes_something || has_origin) {
    const auto origin = head.field("Origin");
    if (!origin || *origin != "http://" + *host) return Refusal{403, "the request comes from another page"};
  }
  if (head.count("Sec-Fetch-Site") > 0) {
    const auto site = head.field("Sec-Fetch-Site");
    if (!site || (*site != "same-origin" && *site != "none"))
      return Refusal{403, "the request comes from another page"};
  }
  if (needs_cookie && !has_cookie(head))
    return Refusal{403, "open the address that `loopwright studio` printed"};
  return {};
}

bool Gate::take_token(std::string_view token) {
  if (token_is_used_ || !are_equal(token, token_)) return false;
  token_is_used_ = true;
  return true;
}

}  // namespace loopwright::studio
