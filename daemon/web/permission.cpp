#include "daemon/web/permission.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/web/problem.hpp"
#include "engine/base/json_text.hpp"
#include "engine/base/printable_text.hpp"

namespace yuragi::daemon::web {
namespace {

constexpr std::string_view kBearer = "Bearer ";
/// Of an IPv6 address with its zone; what is longer is no address.
constexpr std::size_t kMaxAddressCharacters = 64;

/// The value of a cookie (A. Barth, RFC 6265, 2011, 5.4); empty if it is missing.
std::string_view cookie_named(std::string_view name, std::string_view cookies) {
  while (!cookies.empty()) {
    const std::size_t end = std::min(cookies.find(';'), cookies.size());
    std::string_view cookie = cookies.substr(0, end);
    cookies.remove_prefix(std::min(end + 1, cookies.size()));
    while (cookie.starts_with(' ')) cookie.remove_prefix(1);
    const std::size_t equals = cookie.find('=');
    if (equals != std::string_view::npos && cookie.substr(0, equals) == name) return cookie.substr(equals + 1);
  }
  return {};
}

}  // namespace

std::optional<std::string> session_shown(const http::Request& request, const Trust& trust, double utc_s) {
  if (!trust.takes_token || trust.access == nullptr || trust.pairings == nullptr) return std::nullopt;
  auto id = trust.access->session_id_of(cookie_named(kSessionCookie, request.cookie));
  if (id && !trust.pairings->is_valid(*id, utc_s)) id.reset();
  return id;
}

bool is_trusted(const http::Request& request, const Trust& trust, double utc_s) {
  if (!trust.takes_token) return request.client.is_local && !request.is_forwarded;
  const Access* const access = trust.access;
  if (access == nullptr) return false;
  if (request.authorization.starts_with(kBearer) &&
      access->is_token(std::string_view(request.authorization).substr(kBearer.size())))
    return true;
  return session_shown(request, trust, utc_s).has_value();
}

bool shows_credentials(const http::Request& request) {
  return !request.authorization.empty() || !cookie_named(kSessionCookie, request.cookie).empty();
}

std::optional<http::Response> permission_refusal(const http::Request& request, bool is_trusted, const Trust& trust,
                                                 bool reading_takes_token) {
  const bool only_reads = request.method == "GET" || request.method == "HEAD";
  if (is_trusted || (only_reads && !reading_takes_token)) return std::nullopt;
  const char* const why =
      !trust.takes_token ? "only the machine of the daemon may do this: the configuration has no [http] token_file"
      : trust.access == nullptr
          ? "the token of this installation cannot be read, so nobody may do this: the daemon's log has the reason"
          : "this needs the token (Authorization: Bearer TOKEN) or a paired browser: `yuragi token` shows a "
            "code";
  http::Response refusal = problem(401, "Not allowed", why);
  refusal.fields.push_back({"WWW-Authenticate", "Bearer realm=\"yuragi\""});
  return refusal;
}

http::Response pairing_answer(const std::string& code, const http::Request& request, const std::string& address,
                              const Trust& trust, PairingLimits& limits, Pairings& pairings, double utc_s,
                              double now_s) {
  if (!trust.takes_token) return problem(409, "Not done", "the configuration has no [http] token_file");
  if (trust.access == nullptr) return problem(409, "Not done", "the token of this installation cannot be read");
  const Access* const access = trust.access;
  if (!limits.take(address, now_s)) {
    http::Response refusal = problem(429, "Too many tries", "wait some seconds, and try again");
    refusal.fields.push_back({"Retry-After", "10"});
    return refusal;
  }
  const auto step = access->pairing_step_of(code, utc_s);
  if (!step)
    return problem(403, "Not the code",
                   "this is not the code that `yuragi token` shows, or it is older than 10 minutes");
  if (!pairings.use_code(*step))
    return problem(403, "Used", "this code has been used: `yuragi token` shows another one");
  const std::string id = Access::new_session_id();
  pairings.add(id, address, utc_s);
  http::Response response{.body = json_text(nlohmann::json({{"message", "paired"}})) + "\n"};
  response.fields.push_back(
      {"Set-Cookie", fmt::format("{}={}; Path=/; Max-Age={}; HttpOnly; SameSite=Strict{}", kSessionCookie,
                                 access->session_of(id), Pairings::kSession_s, request.is_https ? "; Secure" : "")});
  return response;
}

std::string client_address(const http::Request& request, std::span<const std::string> proxies) {
  const auto is_proxy = [proxies](std::string_view address) {
    return std::ranges::find(proxies, address) != proxies.end();
  };
  std::string address = request.client.address;
  std::string_view list = request.forwarded_for;
  while (is_proxy(address) && !list.empty()) {
    const std::size_t comma = list.rfind(',');
    std::string_view last = comma == std::string_view::npos ? list : list.substr(comma + 1);
    list = comma == std::string_view::npos ? std::string_view() : list.substr(0, comma);
    while (last.starts_with(' ')) last.remove_prefix(1);
    while (last.ends_with(' ')) last.remove_suffix(1);
    if (last.empty() || last.size() > kMaxAddressCharacters) break;
    address = last;
  }
  make_printable(address);
  return address;
}

}  // namespace yuragi::daemon::web
