#pragma once

#include <span>
#include <string>
#include <string_view>

namespace yuragi {

/// Returns true if `host`, the "Host" field of an HTTP request with or without a port, is a name of this machine: a
/// numeric address, localhost, one of `names`, or one of them followed by ".local". This refuses a web page that
/// reached this machine under its own name (DNS rebinding). Pure.
bool is_known_host(std::string_view host, std::span<const std::string> names);

/// Returns true if `origin`, the "Origin" field of a request, is empty or names a page loaded from the same `host`.
/// `is_https`: the request came by TLS, and the page must have, too: one in the clear can be anybody's in the network.
/// A request in the clear can be that of a page by HTTPS, behind a proxy. Pure.
bool is_same_origin(std::string_view origin, std::string_view host, bool is_https);

}  // namespace yuragi
