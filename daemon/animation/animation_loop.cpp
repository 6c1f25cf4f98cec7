#include "daemon/animation/animation_loop.hpp"

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <system_error>

#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "engine/base/contain.hpp"

namespace yuragi::daemon::animation {
namespace {

void sleep_until(MonoTime deadline) {
  const Nanoseconds since_zero = deadline.time_since_epoch();
  const auto whole_s = std::chrono::floor<std::chrono::seconds>(since_zero);
  const timespec moment{.tv_sec = whole_s.count(), .tv_nsec = (since_zero - whole_s).count()};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &moment, nullptr) == EINTR) {
  }
}

// Cues and changes that may wait for the next tick.
constexpr std::size_t kWaitingOrders = 64;

}  // namespace

Loop::Loop(Animation& animation, Latest<wind::ground::DrivingWind>& wind, const drivers::sensor::Clock& clock,
           double rate_hz, LedSteps* led)
    : animation_(animation),
      wind_(wind),
      clock_(clock),
      rate_hz_(rate_hz),
      led_(led),
      orders_(kWaitingOrders),
      frame_ready_fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (frame_ready_fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

Loop::~Loop() {
  stop();
  close(frame_ready_fd_);
  // Orders that were passed on but not taken.
  orders_.drain([](const Order& order) { const std::unique_ptr<SceneChange> owned(order.change); });
  take_finished_change();
}

void Loop::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  pthread_setname_np(thread_.native_handle(), "animation");
}

void Loop::stop() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
}

bool Loop::begin_change(std::unique_ptr<SceneChange>& change) {
  if (is_changing_ || !orders_.push({.change = change.get()})) return false;
  static_cast<void>(change.release());  // the ring owns it
  is_changing_ = true;
  return true;
}

std::unique_ptr<SceneChange> Loop::take_finished_change() noexcept {
  std::unique_ptr<SceneChange> finished(finished_.exchange(nullptr, std::memory_order_acquire));
  if (finished) is_changing_ = false;
  return finished;
}

std::optional<std::string> Loop::failure() const {
  if (!has_failed_.load(std::memory_order_acquire)) return std::nullopt;
  return failure_;
}

/// No exception leaves the thread. Scenes cannot throw (their steps are noexcept): the remaining causes are lack of
/// memory for the frame, or a pose that is not of its skeleton's kind.
void Loop::run(const std::stop_token& stop) {
  const bool is_over = contain(
      "the animation", [&] { run_ticks(stop); }, [this](const char* what) { failure_ = what; });
  if (is_over) return;
  has_failed_.store(true, std::memory_order_release);
  wake_io_thread();
}

void Loop::run_ticks(const std::stop_token& stop) {
  TickSchedule schedule(clock_.now().mono, rate_hz_);
  while (!stop.stop_requested()) {
    sleep_until(schedule.next_deadline());
    const MonoTime begun = clock_.now().mono;
    const TickSchedule::Tick now = schedule.begin_tick(begun);
    tick(now);
    const Nanoseconds taken = clock_.now().mono - begun;
    counters_.work.add(taken);
    counters_.tick_time.add(taken);
    counters_.add(now, schedule.period());
  }
}

void Loop::tick(const TickSchedule::Tick& tick) {
  wind_.refresh();
  take_orders();
  const LedSteps::Stepped stepped = step(tick);
  if (auto finished = animation_.take_finished_change()) finished_.store(finished.release(), std::memory_order_release);
  if (!stepped.is_new) return;

  // The wind is some milliseconds older than the frame, and with it the age of its newest reading.
  const Instant now = clock_.now();
  wind::State state = *stepped.wind;
  if (state.live_weight > 0.0) state.reading_age_s += std::max(0.0, seconds(now.mono - state.time));
  const wire::FrameInfo info{.sequence = sequence_++,
                             .tick = stepped.number,
                             .time_s = static_cast<double>(tick.number) / rate_hz_,
                             .utc_ns = stepped.utc.value_or(now.utc).time_since_epoch().count(),
                             .wind = state};
  const std::span<const std::uint8_t> frame = animation_.encode(info);
  PublishedFrame& published = frames_.writable();
  animation_.make_room_in(published.bytes);
  published.bytes.assign(frame.begin(), frame.end());
  published.generation = animation_.generation();
  const std::span<const float> opacities = animation_.opacities();
  published.scene_count = std::min(opacities.size(), published.opacities.size());
  std::ranges::copy(opacities.first(published.scene_count), published.opacities.begin());
  frames_.publish();
  wake_io_thread();
}

/// Skipped ticks are made up for by one longer step; those of a leader one by one.
LedSteps::Stepped Loop::step(const TickSchedule::Tick& tick) {
  const wind::ground::DrivingWind& wind = wind_.value();
  const std::uint64_t periods = tick.skipped + 1;
  if (led_ != nullptr) return led_->step(animation_, wind, clock_.now().mono, periods);
  animation_.step(wind, step_s(periods, rate_hz_), periods);
  return {.is_new = true, .number = tick.number, .utc = {}, .wind = &wind.state};
}

/// After the wind was taken: the I/O thread publishes wind for new scenes after the change.
void Loop::take_orders() {
  orders_.drain([this](const Order& order) {
    if (order.change == nullptr) return animation_.cue(order.cue);
    animation_.begin_change(std::unique_ptr<SceneChange>(order.change));
  });
}

/// Fails only when 2^64 frames have not been read.
void Loop::wake_io_thread() noexcept {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = write(frame_ready_fd_, &one, sizeof one);
}

}  // namespace yuragi::daemon::animation
