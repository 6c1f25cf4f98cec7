#pragma once

#include <optional>
#include <string>

#include "daemon/web/access.hpp"
#include "daemon/web/http_server.hpp"

namespace yuragi::daemon::web {

inline constexpr const char* kSessionCookie = "yuragi_session";

/// What a client has to show before it is answered. A client of this machine has to show nothing, unless a proxy sends
/// it for somebody else. `access`: null where there is no token; then no other client can show it. `utc_s`: now,
/// seconds since 1970. Pure.
bool is_trusted(const HttpRequest& request, const Access* access, double utc_s);

/// Why the request is refused, where it is. Changing something takes trust, reading only where `reading_takes_token`.
std::optional<HttpResponse> permission_refusal(const HttpRequest& request, bool is_trusted, bool has_token,
                                               bool reading_takes_token);

/// The answer to one that has typed a pairing code: the session as a cookie, or a refusal.
HttpResponse pairing_answer(const std::string& code, const HttpRequest& request, const Access* access,
                            PairingTries& tries, double utc_s, double now_s);

}  // namespace yuragi::daemon::web
