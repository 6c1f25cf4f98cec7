#include "daemon/animation/animation_loop.hpp"

#include <atomic>
#include <new>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include "daemon/animation/scene_exchange.hpp"
#include "daemon/sensing/sensor_hub.hpp"
#include "daemon/sensing/system_clock.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "tests/support/failing_scene.hpp"
#include "tests/support/replaced_allocation.hpp"

// Every allocation of this program by a thread other than the test's own is counted: that leaves the animation's.
namespace {
std::atomic<int> other_threads_allocations{0};
thread_local bool is_test_thread = false;
}  // namespace

void* yuragi::test::allocate(std::size_t size) {
  if (!is_test_thread) ++other_threads_allocations;
  if (is_memory_gone) throw std::bad_alloc();
  return allocate_as_usual(size);
}

namespace yuragi::daemon::animation {
namespace {

constexpr int kReloads = YURAGI_RELOADS;

class AnimationLoopTest : public ::testing::Test {
 protected:
  AnimationLoopTest() { is_test_thread = true; }

  /// Waits for the next frame as the I/O thread does, and decodes it.
  wire::Frame next_frame() { return next_frame(loop_); }
  wire::Frame next_frame(Loop& loop) {
    while (true) {
      pollfd ready{.fd = loop.frame_ready_fd(), .events = POLLIN, .revents = 0};
      if (poll(&ready, 1, 60'000) != 1) throw std::runtime_error("no frame in a minute");
      std::uint64_t made = 0;
      if (read(ready.fd, &made, sizeof made) != sizeof made) continue;
      if (const PublishedFrame* frame = loop.take_frame()) {
        generation_ = frame->generation;
        const auto message = wire::decode(std::span(frame->bytes).subspan(wire::kSizePrefixBytes));
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
  Loop loop_{animation_, wind_, clock_, 240.0};
  std::uint64_t generation_ = 0;  // of the frame that was taken last
  wire::Scenes scenes_;           // that were announced last
};

TEST_F(AnimationLoopTest, MakesFrameAfterFrameThatShowTheNewestWind) {
  wind::State blowing;
  blowing.wind = {7.0, 0.0};
  blowing.source = wind::Source::kLive;
  wind_.publish({blowing, blowing.wind});
  loop_.start();

  wire::Frame previous = next_frame();
  for (int count = 0; count < 20; ++count) {
    wire::Frame frame = next_frame();
    EXPECT_GT(frame.info.sequence, previous.info.sequence);
    EXPECT_GT(frame.info.tick, previous.info.tick);
    EXPECT_GT(frame.info.time_s, previous.info.time_s);
    EXPECT_FLOAT_EQ(static_cast<float>(frame.info.wind.wind.u_m_s), 7.0F);
    ASSERT_EQ(frame.poses.size(), 2U);  // a meadow, and the ground around it
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

/// Small scenes that differ in all that a reload may change: which there are, their order, parameters and gains.
settings::Config random_config(std::mt19937& random, std::size_t most) {
  const auto one_of = [&random](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  std::string text = "seed = " + std::to_string(1 + one_of(2)) + "\n";
  const int count = 1 + one_of(static_cast<int>(most));
  for (int i = 0; i < count; ++i) {
    text += "[[scene]]\nname = \"" + std::string(1, static_cast<char>('a' + i)) + "\"\n";
    text +=
        "shown = " + std::string(one_of(3) == 0 ? "false" : "true") + "\ngain = " + std::to_string(one_of(3)) + "\n";
    text += one_of(4) == 0
                ? "kind = \"curtain\"\ncolumns = 12\nrows = 9\n"
                : "kind = \"grass\"\nblades_deep = 2\nblades_across = " + std::to_string(2 + one_of(2)) + "\n";
  }
  return settings::parse_config(text, "test.toml");
}

TEST_F(AnimationLoopTest, AChangeOfTheScenesAllocatesNothingOnItsThreadAndItsFramesAreAnnounced) {
  settings::Config next = settings::default_config();
  SceneDirector director(next, [this](const SceneCue& cue) { return loop_.cue(cue); });
  SceneExchange exchange(animation_, loop_, director);
  scenes_ = animation_.describe();
  loop_.start();
  for (int count = 0; count < 5; ++count) next_frame();

  // The meadow is made anew, and there is another one: the frames become three times as large, and then twice.
  next.scenes.push_back(next.scenes[0]);
  next.scenes[0].placement.x_m = 3.0;
  next.scenes.back().name = "second";
  auto change = make_scene_change(*exchange.present(), next, 0.1);
  const int before = other_threads_allocations.load();
  ASSERT_TRUE(exchange.begin(change));
  EXPECT_EQ(change, nullptr);
  std::vector<std::size_t> scenes_of_lists;
  const auto take = [&] {
    const wire::Frame frame = next_frame();
    if (const auto message = exchange.new_scenes(generation_)) {
      scenes_ = std::get<wire::Scenes>(wire::decode(std::span(*message).subspan(wire::kSizePrefixBytes)).value());
      scenes_of_lists.push_back(scenes_.scenes.size());
    }
    EXPECT_TRUE(wire::fits(frame, scenes_));
  };
  std::unique_ptr<SceneChange> finished;
  while (!finished) {
    take();
    finished = exchange.take_finished();
  }
  for (int count = 0; count < 10; ++count) take();
  EXPECT_EQ(other_threads_allocations.load(), before);
  // On a slow machine no frame of the first list may have been taken.
  EXPECT_THAT(scenes_of_lists, testing::AnyOf(testing::ElementsAre(4U, 3U), testing::ElementsAre(3U)));
  EXPECT_FALSE(exchange.is_changing());
}

TEST_F(AnimationLoopTest, WhileOneChangeIsCarriedOutThereIsNoOther) {
  settings::Config next = settings::default_config();
  SceneDirector director(next, [this](const SceneCue& cue) { return loop_.cue(cue); });
  SceneExchange exchange(animation_, loop_, director);
  next.scenes[0].placement.x_m = 3.0;
  auto change = make_scene_change(*exchange.present(), next);
  auto another = make_scene_change(*exchange.present(), next);
  ASSERT_TRUE(exchange.begin(change));
  EXPECT_FALSE(exchange.begin(another));
  EXPECT_NE(another, nullptr);
  EXPECT_TRUE(exchange.is_changing());
  // Neither of them is lost with a loop that never ran (address sanitizer).
}

/// Hundreds of reloads, and a cue now and then, against the running thread.
TEST_F(AnimationLoopTest, ScenesAreExchangedHundredsOfTimes) {
  std::mt19937 random(7);
  settings::Config config = random_config(random, 5);
  Animation animation(config, sensing::make_gust_noise(config));
  Loop loop(animation, wind_, clock_, 4000.0);
  SceneDirector director(config, [&loop](const SceneCue& cue) { return loop.cue(cue); });
  SceneExchange exchange(animation, loop, director);
  scenes_ = animation.describe();
  const std::weak_ptr<const SceneRoster> first = exchange.present();
  loop.start();

  std::uint64_t newest_generation = 0;
  std::uint64_t lists = 0;
  const auto take = [&] {
    wire::Frame frame = next_frame(loop);
    EXPECT_GE(generation_, newest_generation);
    newest_generation = generation_;
    if (const auto message = exchange.new_scenes(generation_)) {
      scenes_ = std::get<wire::Scenes>(wire::decode(std::span(*message).subspan(wire::kSizePrefixBytes)).value());
      ++lists;
    }
    EXPECT_TRUE(wire::fits(frame, scenes_)) << "a frame is of the scenes that were announced last";
    return frame;
  };
  for (int round = 0; round < kReloads && !HasFailure(); ++round) {
    config = random_config(random, 5);
    auto change = make_scene_change(*exchange.present(), config, static_cast<double>(random() % 3) * 0.001);
    while (!exchange.begin(change)) take();
    while (exchange.is_changing()) {
      if (random() % 4 == 0) {
        director.handle({.scene = std::string(1, static_cast<char>('a' + random() % 5)),
                         .shown = random() % 2 == 0,
                         .hide_others = random() % 4 == 0,
                         .over_s = 0.0},
                        true);
      }
      take();
      exchange.take_finished();
    }
    if (round % 50 != 0) continue;
    // When all fades are over, what the director says is what is seen.
    for (int count = 0; count < 40; ++count) take();
    const wire::Frame frame = take();
    const std::vector<wire::SceneState> states = director.handle({.scene = ""}, true).scenes;
    ASSERT_EQ(states.size(), frame.opacities.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
      EXPECT_EQ(states[i].name, scenes_.scenes.at(i).name);
      EXPECT_EQ(frame.opacities[i], states[i].shown ? 1.0F : 0.0F) << states[i].name;
    }
  }
  EXPECT_GT(lists, std::uint64_t{kReloads});
  EXPECT_TRUE(first.expired()) << "what has left is freed";
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

TEST_F(AnimationLoopTest, SaysWhyItHasEndedByItselfAndKeepsTheLastFrame) {
  const settings::Config config = config_with_failing_scene();
  Animation animation(config, sensing::make_gust_noise(config));
  Loop loop(animation, wind_, clock_, 240.0);
  loop.start();
  std::uint64_t last_sequence = 0;
  while (!loop.failure()) {
    pollfd ready{.fd = loop.frame_ready_fd(), .events = POLLIN, .revents = 0};
    ASSERT_EQ(poll(&ready, 1, 60'000), 1) << "the I/O thread is woken for the failure, too";
    std::uint64_t made = 0;
    ASSERT_EQ(read(ready.fd, &made, sizeof made), ssize_t{sizeof made});
    if (const PublishedFrame* frame = loop.take_frame()) {
      const auto message = wire::decode(std::span(frame->bytes).subspan(wire::kSizePrefixBytes));
      last_sequence = std::get<wire::Frame>(message.value()).info.sequence;
    }
  }
  EXPECT_EQ(loop.failure(), "std::bad_alloc");
  EXPECT_EQ(last_sequence + 1, std::uint64_t{FailingScene::kGoodTicks});
  EXPECT_EQ(loop.counters().ticks.load(), std::uint64_t{FailingScene::kGoodTicks});
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
