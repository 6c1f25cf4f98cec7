#include "engine/platform/clock_watch.hpp"

#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "engine/base/contain.hpp"

namespace yuragi::platform {
namespace {

constexpr int kReadEvery_ms = 30'000;

int make_interruption() {
  const int made = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (made < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  return made;
}

}  // namespace

ClockWatch::ClockWatch(std::function<UtcTime()> now, ClockPrograms programs)
    : now_(std::move(now)),
      programs_(std::move(programs)),
      interruption_(make_interruption()),
      thread_([this] { run(); }) {}

ClockWatch::~ClockWatch() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(interruption_.get(), &one, sizeof one);
  thread_.join();
}

ClockOffset ClockWatch::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

void ClockWatch::run() {
  pollfd interruption{interruption_.get(), POLLIN, 0};
  do {
    contain("reading the clock's offset", [this] {
      ClockOffset read = read_clock_offset(now_(), programs_, interruption_.get());
      const std::lock_guard lock(mutex_);
      latest_ = std::move(read);
    });
  } while (::poll(&interruption, 1, kReadEvery_ms) == 0);
}

}  // namespace yuragi::platform
