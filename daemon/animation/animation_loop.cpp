#include "daemon/animation/animation_loop.hpp"

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <system_error>

#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace yuragi::daemon::animation {
namespace {

// A frame may grow by a few bytes when a field differs from its default; the buffers have room for that.
constexpr std::size_t kFrameSlack_bytes = 256;

// The longest step after a halt of the machine, however long it was.
constexpr double kLongestStep_s = 0.1;

void sleep_until(MonoTime deadline) {
  const Nanoseconds since_zero = deadline.time_since_epoch();
  const auto whole_s = std::chrono::floor<std::chrono::seconds>(since_zero);
  const timespec moment{.tv_sec = whole_s.count(), .tv_nsec = (since_zero - whole_s).count()};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &moment, nullptr) == EINTR) {
  }
}

// Cues that may wait for the next tick.
constexpr std::size_t kWaitingCues = 64;

}  // namespace

AnimationLoop::AnimationLoop(Animation& animation, Latest<wind::ground::DrivingWind>& wind,
                             const drivers::sensor::Clock& clock, double rate_hz)
    : animation_(animation),
      wind_(wind),
      clock_(clock),
      rate_hz_(rate_hz),
      frames_(wire::Bytes(animation.largest_frame_bytes() + kFrameSlack_bytes)),
      cues_(kWaitingCues),
      frame_ready_fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (frame_ready_fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

AnimationLoop::~AnimationLoop() {
  stop();
  close(frame_ready_fd_);
}

void AnimationLoop::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  pthread_setname_np(thread_.native_handle(), "animation");
}

void AnimationLoop::stop() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
}

void AnimationLoop::run(const std::stop_token& stop) {
  TickSchedule schedule(clock_.now().mono, rate_hz_);
  while (!stop.stop_requested()) {
    sleep_until(schedule.next_deadline());
    const MonoTime begun = clock_.now().mono;
    const TickSchedule::Tick now = schedule.begin_tick(begun);
    tick(now);
    counters_.lateness.add(now.lateness);
    counters_.work.add(clock_.now().mono - begun);
    counters_.skipped_ticks.fetch_add(now.skipped, std::memory_order_relaxed);
    counters_.ticks.fetch_add(1, std::memory_order_relaxed);
  }
}

void AnimationLoop::tick(const TickSchedule::Tick& tick) {
  // Skipped ticks are made up for by one longer step, so that motion keeps its speed, up to a limit.
  wind_.refresh();
  const wind::ground::DrivingWind& wind = wind_.value();
  const double dt_s = std::min(static_cast<double>(tick.skipped + 1) / rate_hz_, kLongestStep_s);
  cues_.drain([this](const SceneCue& cue) { animation_.cue(cue); });
  animation_.step(wind, dt_s);

  const wire::FrameInfo info{.sequence = sequence_++,
                             .tick = tick.number,
                             .time_s = static_cast<double>(tick.number) / rate_hz_,
                             .utc_ns = clock_.now().utc.time_since_epoch().count(),
                             .wind = wind.state};
  const std::span<const std::uint8_t> frame = animation_.encode(info);
  frames_.writable().assign(frame.begin(), frame.end());
  frames_.publish();

  // Wakes the I/O thread. It fails only when 2^64 frames have not been read.
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = write(frame_ready_fd_, &one, sizeof one);
}

}  // namespace yuragi::daemon::animation
