#pragma once

#include <functional>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "daemon/stream/log_allowance.hpp"
#include "engine/base/count_text.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::stream {

/// The log of what clients do, within a LogAllowance: even if they connect and request very often, the log
/// does not fill up. Thread-safe: no.
class ClientLog {
 public:
  /// `now`: the clock of the allowance.
  ClientLog(const LogAllowance::Settings& settings, std::function<MonoTime()> now)
      : now_(std::move(now)), allowance_(settings, now_()) {}

  template <class... Values>
  void info(fmt::format_string<Values...> format, const Values&... values) {
    write(spdlog::level::info, format, values...);
  }
  template <class... Values>
  void warn(fmt::format_string<Values...> format, const Values&... values) {
    write(spdlog::level::warn, format, values...);
  }

  /// Logs how many lines were omitted, from time to time: call it repeatedly.
  void report_left_out() {
    if (const std::uint64_t count = allowance_.take_left_out(now_()); count > 0) {
      spdlog::warn("{} about clients left out of this log: they came too fast", count_text(count, "line"));
    }
  }

 private:
  template <class... Values>
  void write(spdlog::level::level_enum level, fmt::format_string<Values...> format, const Values&... values) {
    if (spdlog::should_log(level) && allowance_.take(now_())) {
      spdlog::log(level, fmt::vformat(format, fmt::make_format_args(values...)));
    }
  }

  std::function<MonoTime()> now_;
  LogAllowance allowance_;
};

}  // namespace yuragi::daemon::stream
