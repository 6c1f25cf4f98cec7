#include "daemon/web/permission.hpp"

#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/web/problem.hpp"
#include "engine/base/json_text.hpp"

namespace yuragi::daemon::web {
namespace {

constexpr std::string_view kBearer = "Bearer ";

/// The value of a cookie (A. Barth, RFC 6265, 2011, 5.4); empty where it is not there.
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

bool is_trusted(const HttpRequest& request, const Access* access, double utc_s) {
  if (request.client.is_local && !request.is_forwarded) return true;
  if (access == nullptr) return false;
  if (request.authorization.starts_with(kBearer) &&
      access->is_token(std::string_view(request.authorization).substr(kBearer.size())))
    return true;
  const std::string_view session = cookie_named(kSessionCookie, request.cookie);
  return !session.empty() && access->is_session(session, utc_s);
}

std::optional<HttpResponse> permission_refusal(const HttpRequest& request, bool is_trusted, bool has_token,
                                               bool reading_takes_token) {
  const bool only_reads = request.method == "GET" || request.method == "HEAD";
  if (is_trusted || (only_reads && !reading_takes_token)) return std::nullopt;
  HttpResponse refusal = problem(
      401, "Not allowed from here",
      has_token
          ? "from other machines this takes the token (Authorization: Bearer TOKEN), or a browser that was paired: "
            "`yuragi token` shows a code"
          : "only this machine itself may do this: the configuration has no [http] token_file");
  refusal.fields.push_back({"WWW-Authenticate", "Bearer realm=\"yuragi\""});
  return refusal;
}

HttpResponse pairing_answer(const std::string& code, const HttpRequest& request, const Access* access,
                            PairingTries& tries, double utc_s, double now_s) {
  if (access == nullptr) return problem(409, "Not done", "the configuration has no [http] token_file");
  if (!tries.take(now_s)) {
    HttpResponse refusal = problem(429, "Too many tries", "wait some seconds, and try again");
    refusal.fields.push_back({"Retry-After", "10"});
    return refusal;
  }
  if (!access->is_pairing_code(code, utc_s))
    return problem(403, "Not the code", "this is not the code that `yuragi token` shows now");
  HttpResponse response{.body = json_text(nlohmann::json({{"message", "paired"}})) + "\n"};
  response.fields.push_back(
      {"Set-Cookie", fmt::format("{}={}; Path=/; Max-Age={:.0f}; HttpOnly; SameSite=Strict{}", kSessionCookie,
                                 access->new_session(utc_s), Access::kSession_s, request.is_https ? "; Secure" : "")});
  return response;
}

}  // namespace yuragi::daemon::web
