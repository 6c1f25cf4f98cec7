#pragma once

#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "daemon/animation/animation.hpp"
#include "daemon/animation/duration_histogram.hpp"
#include "daemon/animation/tick_schedule.hpp"
#include "drivers/sensor/clock.hpp"
#include "engine/base/latest.hpp"
#include "engine/base/spsc_ring.hpp"

namespace yuragi::daemon::animation {

/// The timing of the loop. May be read by other threads at any time.
struct LoopCounters {
  std::atomic<std::uint64_t> ticks{0};
  std::atomic<std::uint64_t> skipped_ticks{0};
  DurationHistogram lateness;  ///< of the start of each tick
  DurationHistogram work;      ///< duration of each tick
};

/// The animation's thread: at a fixed rate it takes the newest wind, steps the scenes, encodes the frame and publishes
/// it. Once started it neither allocates nor blocks: wind and frames pass through triple buffers, cues through a ring,
/// and an eventfd wakes the I/O thread.
class AnimationLoop {
 public:
  /// `wind` must outlive the loop and is written by the I/O thread. The clock must be the system's: the loop sleeps on
  /// CLOCK_MONOTONIC.
  AnimationLoop(Animation& animation, Latest<wind::ground::DrivingWind>& wind, const drivers::sensor::Clock& clock,
                double rate_hz);
  ~AnimationLoop();

  AnimationLoop(const AnimationLoop&) = delete;
  AnimationLoop& operator=(const AnimationLoop&) = delete;

  void start();
  void stop();

  /// Readable when a frame is ready; read 8 bytes from it, then call take_frame(). Owned by the loop.
  int frame_ready_fd() const noexcept { return frame_ready_fd_; }

  /// For the I/O thread: the newest frame, or null if it was taken already. Valid until the next call.
  const wire::Bytes* take_frame() noexcept { return frames_.refresh() ? &frames_.value() : nullptr; }

  /// For the I/O thread: queues a cue for the next tick. False where the ring is full: it is dropped.
  bool cue(const SceneCue& cue) { return cues_.push(cue); }

  const LoopCounters& counters() const noexcept { return counters_; }

 private:
  void run(const std::stop_token& stop);
  void tick(const TickSchedule::Tick& tick);

  Animation& animation_;
  Latest<wind::ground::DrivingWind>& wind_;
  const drivers::sensor::Clock& clock_;
  double rate_hz_;
  std::uint64_t sequence_ = 0;
  Latest<wire::Bytes> frames_;
  SpscRing<SceneCue> cues_;
  LoopCounters counters_;
  int frame_ready_fd_;
  std::jthread thread_;
};

}  // namespace yuragi::daemon::animation
