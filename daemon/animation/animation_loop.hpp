#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "daemon/animation/animation.hpp"
#include "daemon/animation/duration_histogram.hpp"
#include "daemon/animation/led_steps.hpp"
#include "daemon/animation/running_mean.hpp"
#include "daemon/animation/tick_schedule.hpp"
#include "drivers/sensor/clock.hpp"
#include "engine/base/latest.hpp"
#include "engine/base/spsc_ring.hpp"

namespace yuragi::daemon::animation {

/// The timing of the loop. May be read by other threads at any time.
struct LoopCounters {
  std::atomic<std::uint64_t> ticks{0};
  std::atomic<std::uint64_t> skipped_ticks{0};
  DurationHistogram lateness;  ///< of the start of each tick, and of each that was skipped
  DurationHistogram work;      ///< duration of each tick
  RunningMean tick_time;       ///< the same of late

  /// Counts a tick, and those skipped before it: they are late by a period and more.
  void add(const TickSchedule::Tick& tick, Nanoseconds period) noexcept {
    lateness.add(tick.lateness);
    if (tick.skipped > 0) {
      lateness.add(tick.lateness + static_cast<Nanoseconds::rep>(tick.skipped) * period);
      lateness.add(tick.lateness + period, tick.skipped - 1);
    }
    skipped_ticks.fetch_add(tick.skipped, std::memory_order_relaxed);
    ticks.fetch_add(1, std::memory_order_relaxed);
  }
};

/// An encoded frame, the number of the list of scenes that it is of, and how visible each of them is.
struct PublishedFrame {
  wire::Bytes bytes;
  std::uint64_t generation = 0;
  std::array<float, wire::kMaxScenes> opacities{};
  std::size_t scene_count = 0;
};

/// The animation's thread: at a fixed rate it takes the newest wind, steps the scenes, encodes the frame and publishes
/// it. Once started it neither allocates nor blocks: wind and frames pass through triple buffers, cues and changes of
/// the scenes through a ring, and an eventfd wakes the I/O thread.
class Loop {
 public:
  /// `wind` must outlive the loop and is written by the I/O thread, and so must `led`, by which its ticks have numbers
  /// (null: they count from 0). The clock must be the system's: the loop sleeps on CLOCK_MONOTONIC.
  Loop(Animation& animation, Latest<wind::ground::DrivingWind>& wind, const drivers::sensor::Clock& clock,
       double rate_hz, LedSteps* led = nullptr);
  ~Loop();

  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  void start();
  void stop();

  /// Readable when a frame is ready; read 8 bytes from it, then call take_frame(). Owned by the loop.
  int frame_ready_fd() const noexcept { return frame_ready_fd_; }

  /// For the I/O thread: the newest frame, or null if it was taken already. Valid until the next call.
  const PublishedFrame* take_frame() noexcept { return frames_.refresh() ? &frames_.value() : nullptr; }

  /// For the I/O thread: queues a cue for the next tick. False if the ring is full: it is dropped.
  bool cue(const SceneCue& cue) { return orders_.push({.cue = cue}); }

  /// For the I/O thread: hands over a change of the scenes, which is carried out from the beginning of the next tick
  /// on. Cues and changes take effect in the order in which they are handed over, and a wind that is published after
  /// this call is not used for the old scenes. Returns false, and leaves `change` unchanged, if a change is being
  /// carried out or the ring is full.
  bool begin_change(std::unique_ptr<SceneChange>& change);
  /// Returns true if a change was handed over that take_finished_change() has not returned yet.
  bool is_changing() const noexcept { return is_changing_; }
  /// For the I/O thread: the change that is over, once the animation has done with it; null while there is none.
  std::unique_ptr<SceneChange> take_finished_change() noexcept;

  const LoopCounters& counters() const noexcept { return counters_; }

  /// Why the loop has ended by itself: an exception, which is an error of this program. Nullopt while it runs. The
  /// frames until then have been published, and frame_ready_fd() wakes the I/O thread to look.
  std::optional<std::string> failure() const;

 private:
  /// A cue, or if there is one a change, which it owns.
  struct Order {
    SceneCue cue{};
    SceneChange* change = nullptr;
  };

  void run(const std::stop_token& stop);
  void run_ticks(const std::stop_token& stop);
  void wake_io_thread() noexcept;
  void tick(const TickSchedule::Tick& tick);
  LedSteps::Stepped step(const TickSchedule::Tick& tick);
  void take_orders();

  Animation& animation_;
  Latest<wind::ground::DrivingWind>& wind_;
  const drivers::sensor::Clock& clock_;
  double rate_hz_;
  LedSteps* led_;
  std::uint64_t sequence_ = 0;
  Latest<PublishedFrame> frames_;
  SpscRing<Order> orders_;
  std::atomic<SceneChange*> finished_{nullptr};  ///< owned; from the animation's thread to that of I/O
  bool is_changing_ = false;                     ///< of the I/O thread
  LoopCounters counters_;
  int frame_ready_fd_;
  std::atomic<bool> has_failed_{false};
  std::string failure_;  ///< not written any more once has_failed_ is set
  std::jthread thread_;
};

}  // namespace yuragi::daemon::animation
