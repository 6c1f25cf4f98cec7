#pragma once

#include <optional>
#include <span>
#include <string>

#include "daemon/http/server.hpp"

namespace yuragi::daemon::web {

// Which pages of other origins may read (WHATWG, Fetch, 3.2, "CORS protocol"). They never change anything.

/// Returns true if a page of this daemon sends the request, or no page at all. Pure.
bool is_own_origin(const http::Request& request);

/// Returns true if a page of the request's origin may read: one of this daemon's own, one of `origins`, or no page at
/// all. Pure.
bool may_read(const http::Request& request, std::span<const std::string> origins);

/// Returns the refusal (403) of a request to the API for a page of another site, as far as a browser names it
/// (W3C, Fetch Metadata Request Headers: Sec-Fetch-Site); nullopt: it is none, or a page of `origins` sends it. A
/// picture or a link of such a page could start work here and sends no Origin. Pure.
std::optional<http::Response> other_site_refusal(const http::Request& request, std::span<const std::string> origins);

/// Returns the answer to the preflight of a page in `origins` that wants to read the API; nullopt: it is none. Pure.
std::optional<http::Response> preflight_answer(const http::Request& request, std::span<const std::string> origins);

/// Lets a page of `origins` read the answer if it is one of the API to a GET. Pure.
void share_answer(http::Response& response, const http::Request& request, std::span<const std::string> origins);

}  // namespace yuragi::daemon::web
