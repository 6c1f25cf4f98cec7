#pragma once

#include <cstddef>
#include <stop_token>
#include <string>

#include "daemon/alerts/alert_news.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::alerts {

/// The limit of the kept output of a command.
inline constexpr std::size_t kMaxCommandOutput_bytes = 64UL * 1024;

/// Runs news.command by /bin/sh, with YURAGI_ALERT, YURAGI_ALERT_STATE and YURAGI_ALERT_MESSAGE in its environment, and
/// waits for its end; after `most`, or when a stop is requested, it is killed. What it has started ends with it. It
/// reads nothing and inherits no file of this program. `output` receives the first kMaxCommandOutput_bytes of what it
/// prints to standard output and standard error; the rest is dropped. The failure is its exit code or its signal.
/// Thread-safe: yes.
Result<void, Failure> run_command(const News& news, Nanoseconds most, const std::stop_token& stop, std::string& output);

}  // namespace yuragi::daemon::alerts
