#pragma once

#include <stop_token>

#include "daemon/alerts/alert_news.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::alerts {

/// Runs news.command by /bin/sh, with YURAGI_ALERT, YURAGI_ALERT_STATE and YURAGI_ALERT_MESSAGE in its environment, and
/// waits for its end; after `most`, or when a stop is requested, it is killed with all that it has started. It reads
/// nothing, and what it prints goes where this program's messages go. The failure is its exit code or its signal.
Result<void, Failure> run_command(const AlertNews& news, Nanoseconds most, const std::stop_token& stop);

}  // namespace yuragi::daemon::alerts
