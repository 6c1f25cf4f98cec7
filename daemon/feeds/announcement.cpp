#include "daemon/feeds/announcement.hpp"

#include <chrono>
#include <system_error>

#include <fmt/format.h>

namespace yuragi::daemon::feeds {
namespace {

constexpr auto kFirstWait = std::chrono::seconds(2);
constexpr auto kLongestWait = std::chrono::minutes(1);
/// It ends sooner if there is no avahi-daemon.
constexpr auto kRunsFor = std::chrono::seconds(5);
constexpr const char* kWhatToDo = "install and start avahi-daemon and avahi-utils, or set announce = false";

}  // namespace

Announcement::Announcement(const std::string& name, const std::string& type, std::uint16_t port)
    : setup_{.command = {"avahi-publish", "-s", name, type, std::to_string(port)}},
      waits_(kFirstWait, kLongestWait, port) {}

void Announcement::check(MonoTime now) {
  if (!publisher_) {
    if (now >= next_) start(now);
    return;
  }
  if (const auto end = publisher_->end()) {
    publisher_.reset();
    trouble_ = fmt::format("not announced: avahi-publish {}; {}", platform::text_of(*end), kWhatToDo);
    next_ = now + waits_.next();
  } else if (!trouble_.empty() && now - started_ >= kRunsFor) {
    trouble_.clear();
    waits_.reset();
  }
}

void Announcement::start(MonoTime now) {
  try {
    publisher_.emplace(setup_);
    started_ = now;
  } catch (const std::system_error& error) {
    trouble_ = fmt::format("not announced: cannot start avahi-publish ({}); {}", error.code().message(), kWhatToDo);
    next_ = now + waits_.next();
  }
}

}  // namespace yuragi::daemon::feeds
