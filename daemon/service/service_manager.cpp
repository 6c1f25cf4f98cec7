#include "daemon/service/service_manager.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "engine/base/count_text.hpp"

namespace yuragi::daemon::service {
namespace {

/// Read during set-up, when no thread changes the environment. Empty where it is not set.
std::string_view environment_value(const char* name) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  return value == nullptr ? std::string_view() : value;
}

/// A whole number above 0, or nothing.
std::optional<std::int64_t> positive_number(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || number <= 0) return std::nullopt;
  return number;
}

constexpr std::int64_t kLongestTimeout_us = 1'000'000'000'000;  // 12 days; more does not have to be fed

/// The time-out of the watchdog of this process; nothing where there is none, or where it is another process's.
std::optional<Nanoseconds> watchdog_timeout() {
  const auto timeout_us = positive_number(environment_value("WATCHDOG_USEC"));
  const std::string_view whose = environment_value("WATCHDOG_PID");
  if (!timeout_us || *timeout_us > kLongestTimeout_us) return {};
  if (!whose.empty() && positive_number(whose) != getpid()) return {};
  return std::chrono::microseconds(*timeout_us);
}

}  // namespace

ServiceManager::ServiceManager(bool with_animation) : socket_name_(environment_value("NOTIFY_SOCKET")) {
  if (socket_name_.empty() || socket_name_.size() >= sizeof(sockaddr_un::sun_path)) return;
  socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (const auto timeout = watchdog_timeout()) watchdog_.emplace(*timeout, with_animation);
}

ServiceManager::~ServiceManager() {
  if (socket_ >= 0) close(socket_);
}

bool ServiceManager::notify(const std::string& message) const {
  if (socket_ < 0) return true;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::ranges::copy(socket_name_, address.sun_path);
  if (socket_name_.front() == '@') address.sun_path[0] = '\0';
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_name_.size());
  return sendto(socket_, message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                reinterpret_cast<const sockaddr*>(&address), size) >= 0;
}

void ServiceManager::say_ready() {
  is_ready_ = is_ready_ || notify("READY=1");
}

void ServiceManager::say_reloading() {
  if (is_ready_ && notify("RELOADING=1")) is_ready_ = false;
}

void ServiceManager::say_status(const wire::Sensors& status) {
  const auto live = std::ranges::count(status.sensors, wind::SourceHealth::kLive, &wire::SensorStatus::health);
  const std::string line = fmt::format("{} of {} live, {}", live, count_text(status.sensors.size(), "sensor"),
                                       count_text(status.clients, "client"));
  if (line != status_ && notify("STATUS=" + line)) status_ = line;
}

void ServiceManager::say_stopping(const std::string& why) {
  notify("STOPPING=1\nSTATUS=ending: " + why);
}

void ServiceManager::went_round(MonoTime now, std::uint64_t animation_ticks) {
  if (!watchdog_) return;
  watchdog_->io_went_round();
  watchdog_->animation_has_made(animation_ticks);
  if (watchdog_->take(now)) notify("WATCHDOG=1");
}

}  // namespace yuragi::daemon::service
