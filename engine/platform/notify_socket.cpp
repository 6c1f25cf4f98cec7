#include "engine/platform/notify_socket.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace yuragi::platform {
namespace {

/// Empty if it is not set.
std::string_view environment_value(const char* name) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  return value == nullptr ? std::string_view() : value;
}

/// An integer above 0, or nullopt.
std::optional<std::int64_t> positive_number(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || number <= 0) return std::nullopt;
  return number;
}

constexpr std::int64_t kMaxTimeout_us = 1'000'000'000'000;  // 11 days; more does not have to be fed

}  // namespace

NotifySocket::NotifySocket(std::string name) : name_(std::move(name)) {
  if (name_.empty() || name_.size() >= sizeof(sockaddr_un::sun_path)) return;
  socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
}

NotifySocket::~NotifySocket() {
  if (socket_ >= 0) close(socket_);
}

bool NotifySocket::send(std::string_view message) const {
  if (socket_ < 0) return true;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::ranges::copy(name_, address.sun_path);
  if (name_.front() == '@') address.sun_path[0] = '\0';
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name_.size());
  return sendto(socket_, message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                reinterpret_cast<const sockaddr*>(&address), size) >= 0;
}

ServiceEnvironment ServiceEnvironment::read() {
  ServiceEnvironment service{.socket_name = std::string(environment_value("NOTIFY_SOCKET")), .watchdog = {}};
  const auto timeout_us = positive_number(environment_value("WATCHDOG_USEC"));
  if (timeout_us && *timeout_us <= kMaxTimeout_us) service.watchdog = std::chrono::microseconds(*timeout_us);
  const std::string_view whose = environment_value("WATCHDOG_PID");
  service.is_ours = whose.empty() || positive_number(whose) == getpid();
  return service;
}

}  // namespace yuragi::platform
