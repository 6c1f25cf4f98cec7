#include "daemon/animation/animation_loop.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include "daemon/sensing/sensor_hub.hpp"
#include "daemon/sensing/system_clock.hpp"
#include "engine/pose/pose_arrays.hpp"

// Every allocation of this program by a thread other than the test's own is counted: that leaves the animation's.
namespace {
std::atomic<int> other_threads_allocations{0};
thread_local bool is_test_thread = false;

void* counted_allocation(std::size_t size) {
  if (!is_test_thread) ++other_threads_allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) {
  return counted_allocation(size);
}
void* operator new[](std::size_t size) {
  return counted_allocation(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace yuragi::daemon::animation {
namespace {

class AnimationLoopTest : public ::testing::Test {
 protected:
  AnimationLoopTest() { is_test_thread = true; }

  /// Waits for the next frame as the I/O thread does, and decodes it.
  wire::Frame next_frame() {
    while (true) {
      pollfd ready{.fd = loop_.frame_ready_fd(), .events = POLLIN, .revents = 0};
      if (poll(&ready, 1, 5000) != 1) throw std::runtime_error("no frame in 5 s");
      std::uint64_t made = 0;
      if (read(ready.fd, &made, sizeof made) != sizeof made) continue;
      if (const wire::Bytes* bytes = loop_.take_frame()) {
        const auto message = wire::decode(std::span(*bytes).subspan(wire::kSizePrefixBytes));
        return std::get<wire::Frame>(message.value());
      }
    }
  }

  static std::size_t value_bytes(const wire::Frame& frame) {
    std::size_t bytes = 0;
    pose::for_each_array(frame.poses.at(0), [&bytes](std::span<const float> values) { bytes += values.size_bytes(); });
    return bytes;
  }

  sensing::SystemClock clock_;
  Latest<wind::ground::DrivingWind> wind_;
  Animation animation_{settings::default_config(), sensing::make_gust_noise(settings::default_config())};
  AnimationLoop loop_{animation_, wind_, clock_, 240.0};
};

TEST_F(AnimationLoopTest, MakesFrameAfterFrameThatShowTheNewestWind) {
  wind::WindState blowing;
  blowing.wind = {7.0, 0.0};
  blowing.source = wind::WindSource::kLive;
  wind_.publish({blowing, blowing.wind});
  loop_.start();

  wire::Frame previous = next_frame();
  for (int count = 0; count < 20; ++count) {
    wire::Frame frame = next_frame();
    EXPECT_GT(frame.info.sequence, previous.info.sequence);
    EXPECT_GT(frame.info.tick, previous.info.tick);
    EXPECT_GT(frame.info.time_s, previous.info.time_s);
    EXPECT_FLOAT_EQ(static_cast<float>(frame.info.wind.wind.u_m_s), 7.0F);
    ASSERT_EQ(frame.poses.size(), 1U);
    previous = std::move(frame);
  }
  const auto& pose = std::get<pose::StrandPose>(previous.poses[0]);
  double sum_east_rad = 0.0;
  for (const float bend_rad : pose.bend_east_rad) sum_east_rad += static_cast<double>(bend_rad);
  EXPECT_GT(sum_east_rad, 0.0) << "a wind from the west bends the meadow to the east";
}

TEST_F(AnimationLoopTest, AllocatesNothingAfterItsStart) {
  loop_.start();
  for (int count = 0; count < 5; ++count) next_frame();
  const int before = other_threads_allocations.load();
  for (int count = 0; count < 60; ++count) next_frame();
  EXPECT_EQ(other_threads_allocations.load(), before);
}

TEST_F(AnimationLoopTest, ACueFadesTheSceneWithoutAnyAllocation) {
  loop_.start();
  for (int count = 0; count < 5; ++count) next_frame();
  const int before = other_threads_allocations.load();
  ASSERT_TRUE(loop_.cue({.scene = 0, .shown = false, .over_s = 0.1}));
  wire::Frame frame = next_frame();
  while (frame.opacities.at(0) > 0.0F) frame = next_frame();
  EXPECT_EQ(value_bytes(frame), 0U) << "what is hidden is not sent";
  ASSERT_TRUE(loop_.cue({.scene = 0, .shown = true, .over_s = 0.1}));
  while (frame.opacities.at(0) < 1.0F) frame = next_frame();
  EXPECT_GT(value_bytes(frame), 0U);
  EXPECT_EQ(other_threads_allocations.load(), before);
}

TEST_F(AnimationLoopTest, CountsItsTicksAndHowLateTheyWere) {
  loop_.start();
  for (int count = 0; count < 10; ++count) next_frame();
  loop_.stop();
  const LoopCounters& counters = loop_.counters();
  EXPECT_GE(counters.ticks.load(), 10U);
  EXPECT_GT(counters.work.percentile_s(0.5), 0.0);
  EXPECT_GT(counters.lateness.percentile_s(1.0), 0.0);
}

TEST_F(AnimationLoopTest, EndsAtOnceAndTwice) {
  loop_.start();
  next_frame();
  loop_.stop();
  const std::uint64_t ticks = loop_.counters().ticks.load();
  loop_.stop();
  pollfd ready{.fd = loop_.frame_ready_fd(), .events = POLLIN, .revents = 0};
  std::uint64_t made = 0;
  if (poll(&ready, 1, 0) == 1) {
    ASSERT_EQ(read(ready.fd, &made, sizeof made), ssize_t{sizeof made});
  }
  EXPECT_EQ(poll(&ready, 1, 50), 0) << "no frame is made after stop()";
  EXPECT_EQ(loop_.counters().ticks.load(), ticks);
}

}  // namespace
}  // namespace yuragi::daemon::animation
