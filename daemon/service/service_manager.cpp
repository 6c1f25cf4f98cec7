#include "daemon/service/service_manager.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "engine/base/count_text.hpp"

namespace yuragi::daemon::service {
Manager::Manager(bool with_animation) : Manager(platform::ServiceEnvironment::read(), with_animation) {}

Manager::Manager(platform::ServiceEnvironment service, bool with_animation) : socket_(std::move(service.socket_name)) {
  if (socket_.is_open() && service.is_ours && service.watchdog) watchdog_.emplace(*service.watchdog, with_animation);
}

void Manager::report_ready() {
  is_ready_ = is_ready_ || socket_.send("READY=1");
}

void Manager::report_reloading() {
  if (is_ready_ && socket_.send("RELOADING=1")) is_ready_ = false;
}

void Manager::report_status(const wire::Sensors& status) {
  const auto live = std::ranges::count(status.sensors, wind::SourceHealth::kLive, &wire::SensorStatus::health);
  const std::string line = fmt::format("{} of {} live, {}", live, count_text(status.sensors.size(), "sensor"),
                                       count_text(status.clients, "client"));
  if (line != status_ && socket_.send("STATUS=" + line)) status_ = line;
}

void Manager::report_restarting() {
  socket_.send("RELOADING=1\nWATCHDOG=1\nSTATUS=is started again");
}

void Manager::report_stopping(const std::string& why) {
  socket_.send("STOPPING=1\nSTATUS=ending: " + why);
}

void Manager::went_round(MonoTime now, std::uint64_t animation_ticks) {
  if (!watchdog_) return;
  watchdog_->io_went_round();
  watchdog_->animation_has_made(animation_ticks);
  if (watchdog_->take(now)) socket_.send("WATCHDOG=1");
}

}  // namespace yuragi::daemon::service
