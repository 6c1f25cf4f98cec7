#include "viewer/app/watchdog.hpp"

#include <utility>

namespace yuragi::viewer::app {

Watchdog::Watchdog() : Watchdog(platform::ServiceEnvironment::read()) {}

Watchdog::Watchdog(platform::ServiceEnvironment service)
    : socket_(std::move(service.socket_name)),
      interval_s_(service.watchdog ? std::optional(seconds(*service.watchdog) / 2.0) : std::nullopt) {}

void Watchdog::went_round(double now_s) {
  if (!interval_s_ || (sent_s_ && now_s - *sent_s_ < *interval_s_)) return;
  if (socket_.send("WATCHDOG=1")) sent_s_ = now_s;
}

}  // namespace yuragi::viewer::app
