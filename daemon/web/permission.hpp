#pragma once

#include <optional>
#include <span>
#include <string>

#include "daemon/http/server.hpp"
#include "daemon/web/access.hpp"
#include "daemon/web/pairing_limits.hpp"
#include "daemon/web/pairings.hpp"

namespace yuragi::daemon::web {

inline constexpr const char* kSessionCookie = "yuragi_session";

/// By what a client is trusted.
struct Trust {
  bool takes_token = false;        ///< by the token only, whatever its address; false: by being on this machine
  const Access* access = nullptr;  ///< of the token; nullptr: there is none, or it cannot be read: nobody can show it
  const Pairings* pairings = nullptr;  ///< of the token; nullptr: no browser is paired
};

/// Returns the id of the valid session that the request shows, or nullopt. Pure.
std::optional<std::string> session_shown(const http::Request& request, const Trust& trust, double utc_s);

/// Returns true if the client may change something: it shows the token or a session, or, if that is not configured,
/// it is on this machine and no proxy sends it for another. `utc_s`: now, seconds since 1970. Pure.
bool is_trusted(const http::Request& request, const Trust& trust, double utc_s);

/// Returns true if the request shows a token or a session, right or wrong. Pure.
bool shows_credentials(const http::Request& request);

/// Returns the answer that refuses the request, or nullopt. Changing something takes trust, reading only if
/// `reading_takes_token`. Pure.
std::optional<http::Response> permission_refusal(const http::Request& request, bool is_trusted, const Trust& trust,
                                                 bool reading_takes_token);

/// Returns the answer to a pairing code: the session as a cookie, and adds it to `pairings`, or a refusal. `address`:
/// of the client.
http::Response pairing_answer(const std::string& code, const http::Request& request, const std::string& address,
                              const Trust& trust, PairingLimits& limits, Pairings& pairings, double utc_s,
                              double now_s);

/// Returns the address that a request comes from: that of the connection, or, if this is one of `proxies`, the last
/// one that X-Forwarded-For names and that is none of them. Pure.
std::string client_address(const http::Request& request, std::span<const std::string> proxies);

}  // namespace yuragi::daemon::web
