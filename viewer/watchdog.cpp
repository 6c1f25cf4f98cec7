#include "viewer/watchdog.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace yuragi::viewer {
namespace {

std::string_view environment_value(const char* name) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  return value == nullptr ? std::string_view() : value;
}

std::optional<double> timeout_of_environment() {
  const std::string_view text = environment_value("WATCHDOG_USEC");
  std::uint64_t timeout_us = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), timeout_us);
  if (error != std::errc{} || end != text.data() + text.size() || timeout_us == 0) return std::nullopt;
  return 1e-6 * static_cast<double>(timeout_us);
}

}  // namespace

Watchdog::Watchdog() : Watchdog(std::string(environment_value("NOTIFY_SOCKET")), timeout_of_environment()) {}

Watchdog::Watchdog(std::string socket_name, std::optional<double> timeout_s)
    : socket_name_(std::move(socket_name)), interval_s_(timeout_s.value_or(0.0) / 2.0) {
  if (!timeout_s || socket_name_.empty() || socket_name_.size() >= sizeof(sockaddr_un::sun_path)) return;
  socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
}

Watchdog::~Watchdog() {
  if (socket_ >= 0) close(socket_);
}

void Watchdog::went_round(double now_s) {
  if (socket_ < 0 || (said_s_ && now_s - *said_s_ < interval_s_)) return;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::ranges::copy(socket_name_, address.sun_path);
  if (socket_name_.front() == '@') address.sun_path[0] = '\0';
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_name_.size());
  constexpr std::string_view kAlive = "WATCHDOG=1";
  const ssize_t sent = sendto(socket_, kAlive.data(), kAlive.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                              reinterpret_cast<const sockaddr*>(&address), size);
  if (sent >= 0) said_s_ = now_s;
}

}  // namespace yuragi::viewer
