#pragma once

#include <stop_token>
#include <string>

#include "daemon/alerts/alert_news.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::alerts {

/// Returns the posted JSON: alert, state ("began", "ended"), message, host, time (RFC 3339, UTC), and text, which chat
/// services show. Pure.
std::string webhook_body(const News& news, const std::string& host);

/// Posts it to news.webhook and waits for the reply, 20 s at most, less if a stop is requested. Redirections are
/// not followed. The failure has the reason, and of the URL only the host.
Result<void, Failure> post_to_webhook(const News& news, const std::string& host, const std::stop_token& stop);

}  // namespace yuragi::daemon::alerts
