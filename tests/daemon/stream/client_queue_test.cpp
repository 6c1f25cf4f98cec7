#include "daemon/stream/client_queue.hpp"

#include <algorithm>
#include <random>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::stream {
namespace {

using namespace std::chrono_literals;

SharedBytes message(std::string_view text) {
  return std::make_shared<const wire::Bytes>(text.begin(), text.end());
}

/// A queue, and a socket that takes everything at once.
class ClientQueueTest : public testing::Test {
 protected:
  static MonoTime at(Nanoseconds time) { return MonoTime(time); }

  std::string take_one(Nanoseconds now = 0s) {
    const auto bytes = queue_.to_write(at(now));
    std::string text(bytes.begin(), bytes.end());
    queue_.written(bytes.size(), at(now));
    return text;
  }

  std::string take_all() {
    std::string all;
    for (std::string one = take_one(); !one.empty(); one = take_one()) all += one;
    return all;
  }

  void subscribe(bool poses = true, bool sensors = true) {
    queue_.subscribe({.poses = poses, .sensors = sensors}, message("scenes "), nullptr, nullptr, at(0s));
  }

  ClientQueue queue_{ClientLimits{.subscribe_within = 5s, .stuck_after = 5s, .idle_after = 10min}, message("hello "),
                     at(0s)};
};

TEST_F(ClientQueueTest, TheGreetingComesFirstAndAlone) {
  queue_.offer_frame(message("frame "));
  queue_.offer_sensors(message("sensors "));
  EXPECT_EQ(take_all(), "hello ");
}

TEST_F(ClientQueueTest, ScenesComeBeforeTheNewestFrame) {
  queue_.subscribe({.poses = true, .sensors = true}, message("scenes "), message("frame "), message("sensors "),
                   at(0s));
  EXPECT_EQ(take_all(), "hello scenes sensors frame ");
}

TEST_F(ClientQueueTest, WhatWasNotAskedForIsNotSent) {
  queue_.subscribe({.poses = false, .sensors = true}, message("scenes "), message("frame "), message("sensors "),
                   at(0s));
  queue_.offer_frame(message("frame "));
  EXPECT_EQ(take_all(), "hello sensors ");
}

TEST_F(ClientQueueTest, AReplyGoesBeforeWhatIsNewerAndIsNeverReplaced) {
  subscribe();
  queue_.offer_frame(message("frame "));
  EXPECT_TRUE(queue_.offer_reply(message("one ")));
  EXPECT_TRUE(queue_.offer_reply(message("two ")));
  EXPECT_EQ(take_all(), "hello scenes one two frame ");
}

TEST_F(ClientQueueTest, NewScenesComeBeforeTheirFramesAndAFrameOfTheOldOnesThatWaitsIsDropped) {
  subscribe();
  take_all();
  queue_.offer_frame(message("old "));
  queue_.offer_sensors(message("sensors "));
  queue_.offer_scenes(message("new scenes "));
  queue_.offer_frame(message("one "));
  queue_.offer_frame(message("two "));
  EXPECT_EQ(take_all(), "new scenes sensors two ");
  EXPECT_EQ(queue_.frames_skipped(), 2u);
}

TEST_F(ClientQueueTest, NewScenesWaitForTheMessageInFlightAndReplaceThoseThatWait) {
  queue_.offer_scenes(message("nobody asked "));
  EXPECT_EQ(take_all(), "hello ");
  subscribe();
  take_all();
  queue_.offer_frame(message("frame "));
  (void)queue_.to_write(at(0s));
  queue_.written(2, at(0s));
  queue_.offer_scenes(message("second "));
  queue_.offer_scenes(message("third "));
  EXPECT_EQ(take_all(), "ame third ");
}

TEST_F(ClientQueueTest, WhoeverIsDismissedOrWantsNoPosesGetsNoScenes) {
  queue_.subscribe({.poses = false, .sensors = true}, message("scenes "), nullptr, nullptr, at(0s));
  EXPECT_FALSE(queue_.wants_poses());
  queue_.offer_scenes(message("second "));
  EXPECT_EQ(take_all(), "hello ");
  ClientQueue other(ClientLimits{}, message("hello "), at(0s));
  other.subscribe({.poses = true}, message("scenes "), nullptr, nullptr, at(0s));
  other.dismiss(message("goodbye"));
  other.offer_scenes(message("second "));
  EXPECT_EQ(other.to_write(at(0s)).size(), 7u);
}

/// Frames and scenes are their list's number; whatever comes in between, each frame is of the scenes that came last.
TEST_F(ClientQueueTest, AtAnySpeedEachFrameIsOfTheScenesBeforeIt) {
  std::mt19937 random(5);
  queue_.subscribe({.poses = true, .sensors = true}, message("S00000"), nullptr, nullptr, at(0s));
  std::string all;
  int list = 0;
  const auto numbered = [&](char kind) { return message(fmt::format("{}{:05}", kind, list)); };
  for (int round = 0; round < 100'000; ++round) {
    switch (random() % 8) {
      case 0:
        if (random() % 10 != 0) break;
        ++list;
        queue_.offer_scenes(numbered('S'));
        queue_.offer_frame(numbered('F'));
        break;
      case 1:
        queue_.offer_frame(numbered('F'));
        break;
      case 2:
        queue_.offer_sensors(message("sensor"));
        break;
      case 3:
        (void)queue_.offer_reply(message("reply!"));
        break;
      default: {
        const auto bytes = queue_.to_write(at(0s));
        const std::size_t count = std::min<std::size_t>(bytes.size(), random() % 7);
        all.append(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
        queue_.written(count, at(0s));
      }
    }
  }
  const std::string rest = take_all();
  all = (all + rest).substr(std::string("hello ").size());
  ASSERT_EQ(all.size() % 6, 0u) << "no message is cut";
  std::string scenes;
  std::size_t frames = 0;
  for (std::size_t i = 0; i < all.size(); i += 6) {
    const std::string one = all.substr(i, 6);
    if (one[0] == 'S') {
      EXPECT_LT(scenes, one.substr(1));
      scenes = one.substr(1);
    }
    if (one[0] != 'F') continue;
    ASSERT_EQ(one.substr(1), scenes);
    ++frames;
  }
  EXPECT_EQ(std::stoi(scenes), list) << "the newest scenes are always sent";
  EXPECT_GT(frames, 1000u);
}

TEST_F(ClientQueueTest, RepliesDoNotPileUp) {
  subscribe();
  take_all();
  int taken = 0;
  while (taken < 1000 && queue_.offer_reply(message("reply "))) ++taken;
  EXPECT_GE(taken, 8);
  EXPECT_LE(taken, 16);
  take_one();
  EXPECT_TRUE(queue_.offer_reply(message("reply ")));
}

TEST_F(ClientQueueTest, TracesGoInTheirOrderBeforeFramesAndOnlySoManyWait) {
  subscribe();
  take_all();
  queue_.offer_frame(message("frame "));
  EXPECT_TRUE(queue_.offer_trace(message("one ")));
  EXPECT_TRUE(queue_.offer_trace(message("two ")));
  queue_.offer_sensors(message("sensors "));
  EXPECT_EQ(take_all(), "sensors one two frame ");

  int taken = 0;
  while (taken < 10'000 && queue_.offer_trace(message("trace "))) ++taken;
  EXPECT_GE(taken, 100);
  EXPECT_LE(taken, 1000);
  take_one();
  EXPECT_TRUE(queue_.offer_trace(message("trace ")));
}

TEST_F(ClientQueueTest, SensorsAreNotSentToOneWhoWantsPosesOnly) {
  queue_.subscribe({.poses = true, .sensors = false}, message("scenes "), message("frame "), message("sensors "),
                   at(0s));
  queue_.offer_sensors(message("sensors "));
  EXPECT_EQ(take_all(), "hello scenes frame ");
}

TEST_F(ClientQueueTest, ANewerFrameReplacesTheOneThatWaitsAndNotTheOneInFlight) {
  subscribe();
  take_all();
  queue_.offer_frame(message("one"));
  const auto in_flight = queue_.to_write(at(0s));
  queue_.written(1, at(0s));
  queue_.offer_frame(message("two"));
  queue_.offer_frame(message("three"));
  EXPECT_EQ(in_flight.size(), 3u);
  EXPECT_EQ(take_one(), "ne") << "the rest of the frame in flight";
  EXPECT_EQ(take_one(), "three");
  EXPECT_EQ(take_one(), "");
  EXPECT_EQ(queue_.frames_sent(), 2u);
  EXPECT_EQ(queue_.frames_skipped(), 1u);
}

TEST_F(ClientQueueTest, NewerSensorsReplaceThoseThatWaitAndLeaveTheFrame) {
  subscribe();
  take_all();
  queue_.offer_frame(message("frame "));
  queue_.offer_sensors(message("old "));
  queue_.offer_sensors(message("new "));
  EXPECT_EQ(take_all(), "new frame ");
  EXPECT_EQ(queue_.frames_skipped(), 0u);
}

TEST_F(ClientQueueTest, TheMessageInFlightIsKeptAliveThoughItsOwnerLetsGo) {
  subscribe();
  take_all();
  auto frame = message("frame");
  const std::weak_ptr<const wire::Bytes> watch = frame;
  queue_.offer_frame(std::move(frame));
  (void)queue_.to_write(at(0s));
  EXPECT_FALSE(watch.expired());
  queue_.written(5, at(0s));
  EXPECT_TRUE(watch.expired());
}

TEST_F(ClientQueueTest, OneWhoNeverSubscribesIsOverdue) {
  take_all();
  EXPECT_EQ(queue_.overdue(at(5s - 1ns)), std::nullopt);
  EXPECT_EQ(queue_.overdue(at(5s)), Overdue::kNeverSubscribed);
  subscribe();
  EXPECT_EQ(queue_.overdue(at(5s)), std::nullopt);
}

TEST_F(ClientQueueTest, OneWhoSubscribedToSomethingMaySitStill) {
  for (const Wanted wanted :
       {Wanted{.poses = true}, Wanted{.sensors = true}, Wanted{.traces = true}, Wanted{.wind = true}}) {
    ClientQueue queue(ClientLimits{}, message("hello "), at(0s));
    queue.written(queue.to_write(at(0s)).size(), at(0s));
    queue.subscribe(wanted, nullptr, nullptr, nullptr, at(0s));
    EXPECT_EQ(queue.overdue(at(24h)), std::nullopt);
  }
}

TEST_F(ClientQueueTest, OneWhoSubscribedToNothingHasToRequestSomethingNowAndThen) {
  take_all();
  queue_.subscribe({}, message("scenes "), nullptr, nullptr, at(4s));
  EXPECT_EQ(queue_.overdue(at(604s - 1ns)), std::nullopt);
  EXPECT_EQ(queue_.overdue(at(604s)), Overdue::kIdle);
  queue_.requested(at(604s));
  EXPECT_EQ(queue_.overdue(at(1204s - 1ns)), std::nullopt);
  EXPECT_EQ(queue_.overdue(at(1204s)), Overdue::kIdle);
}

TEST_F(ClientQueueTest, WhoeverIsDismissedGetsTheLastWordAndNothingElse) {
  subscribe();
  take_all();
  queue_.offer_frame(message("frame"));
  (void)queue_.to_write(at(0s));
  queue_.written(1, at(0s));
  queue_.offer_sensors(message("sensors "));
  EXPECT_TRUE(queue_.offer_trace(message("trace ")));
  EXPECT_TRUE(queue_.offer_reply(message("reply ")));

  queue_.dismiss(message(" goodbye"));
  queue_.offer_frame(message("frame "));
  queue_.offer_sensors(message("sensors "));
  EXPECT_FALSE(queue_.offer_reply(message("reply ")));
  EXPECT_FALSE(queue_.offer_trace(message("trace ")));
  EXPECT_FALSE(queue_.is_done());
  EXPECT_EQ(take_all(), "rame goodbye") << "a message in flight is never cut";
  EXPECT_TRUE(queue_.is_done());
}

TEST_F(ClientQueueTest, WhoeverIsDismissedIsOverdueOnlyForNotReading) {
  take_all();
  queue_.dismiss(message("goodbye"));
  EXPECT_EQ(queue_.overdue(at(10s)), std::nullopt) << "once is enough";
  (void)queue_.to_write(at(10s));
  EXPECT_EQ(queue_.overdue(at(15s)), Overdue::kStuck);
}

TEST_F(ClientQueueTest, AWriteThatDoesNotMoveIsStuckAfterItsTime) {
  subscribe();
  take_all();
  queue_.offer_frame(message("frame"));
  (void)queue_.to_write(at(100s));
  EXPECT_EQ(queue_.overdue(at(105s - 1ns)), std::nullopt);
  EXPECT_EQ(queue_.overdue(at(105s)), Overdue::kStuck);
}

TEST_F(ClientQueueTest, AskingAgainWhatToWriteIsNoMovement) {
  subscribe();
  take_all();
  queue_.offer_frame(message("frame"));
  (void)queue_.to_write(at(100s));
  (void)queue_.to_write(at(104s));
  queue_.written(0, at(104s));
  EXPECT_EQ(queue_.overdue(at(105s)), Overdue::kStuck);
}

TEST_F(ClientQueueTest, ASlowClientThatTakesAByteNowAndThenMayStay) {
  subscribe();
  take_all();
  queue_.offer_frame(message("frame"));
  for (int i = 0; i < 4; ++i) {
    (void)queue_.to_write(at(100s + i * 4s));
    EXPECT_EQ(queue_.overdue(at(100s + i * 4s)), std::nullopt);
    queue_.written(1, at(100s + i * 4s));
  }
  EXPECT_EQ(queue_.overdue(at(116s)), std::nullopt);
  EXPECT_EQ(queue_.overdue(at(117s)), Overdue::kStuck);
}

}  // namespace
}  // namespace yuragi::daemon::stream
