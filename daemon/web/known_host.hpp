#pragma once

#include <span>
#include <string>
#include <string_view>

namespace yuragi::daemon::web {

/// Is this the host of a request's header ("Host", with or without a port) under which this machine may be called: an
/// address, localhost, one of `names`, or one of them with ".local" behind it? A page of somebody else that was given
/// this machine's address under its own name (DNS rebinding) is told apart by that. Pure.
bool is_known_host(std::string_view host, std::span<const std::string> names);

/// Is this the origin of a request's header of a page that was loaded from the same `host`? So it is where a browser
/// names none. Pure.
bool is_same_origin(std::string_view origin, std::string_view host);

}  // namespace yuragi::daemon::web
