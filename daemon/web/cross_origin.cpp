#include "daemon/web/cross_origin.hpp"

#include <algorithm>

#include "daemon/web/problem.hpp"
#include "engine/base/known_host.hpp"

namespace yuragi::daemon::web {
namespace {

constexpr const char* kMaxPreflightAge_s = "600";

bool is_of_api(const http::Request& request) {
  return request.path.starts_with("/api/");
}

bool is_listed(const http::Request& request, std::span<const std::string> origins) {
  return std::ranges::find(origins, request.origin) != origins.end();
}

}  // namespace

bool may_read(const http::Request& request, std::span<const std::string> origins) {
  return is_own_origin(request) || is_listed(request, origins);
}

bool is_own_origin(const http::Request& request) {
  return is_same_origin(request.origin, request.host, request.is_https);
}

std::optional<http::Response> other_site_refusal(const http::Request& request, std::span<const std::string> origins) {
  const bool is_of_other_site = request.fetch_site == "cross-site" || request.fetch_site == "same-site";
  if (!is_of_other_site || !is_of_api(request) || is_listed(request, origins)) return std::nullopt;
  return problem(
      403, "Another page's request",
      "a page of another site sends this: only pages of this daemon and those of [http] origins may read here; "
      "to open it yourself, type its address");
}

std::optional<http::Response> preflight_answer(const http::Request& request, std::span<const std::string> origins) {
  if (request.method != "OPTIONS" || request.method_to_come != "GET") return std::nullopt;
  if (!is_of_api(request) || !is_listed(request, origins)) return std::nullopt;
  return http::Response{.status = 204,
                        .fields = {{"Access-Control-Allow-Origin", request.origin},
                                   {"Access-Control-Allow-Methods", "GET"},
                                   {"Access-Control-Allow-Headers", "Authorization"},
                                   {"Access-Control-Max-Age", kMaxPreflightAge_s},
                                   {"Vary", "Origin"}}};
}

void share_answer(http::Response& response, const http::Request& request, std::span<const std::string> origins) {
  const bool only_reads = request.method == "GET" || request.method == "HEAD";
  if (origins.empty() || !only_reads || !is_of_api(request)) return;
  response.fields.emplace_back("Vary", "Origin");
  if (is_listed(request, origins)) response.fields.emplace_back("Access-Control-Allow-Origin", request.origin);
}

}  // namespace yuragi::daemon::web
