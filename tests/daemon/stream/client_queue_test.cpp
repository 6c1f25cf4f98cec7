#include "daemon/stream/client_queue.hpp"

#include <string>

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
    queue_.subscribe(poses, sensors, message("scenes "), nullptr, nullptr);
  }

  ClientQueue queue_{ClientLimits{.subscribe_within = 5s, .stuck_after = 5s}, message("hello "), at(0s)};
};

TEST_F(ClientQueueTest, TheGreetingComesFirstAndAlone) {
  queue_.offer_frame(message("frame "));
  queue_.offer_sensors(message("sensors "));
  EXPECT_EQ(take_all(), "hello ");
}

TEST_F(ClientQueueTest, ScenesComeBeforeTheNewestFrame) {
  queue_.subscribe(true, true, message("scenes "), message("frame "), message("sensors "));
  EXPECT_EQ(take_all(), "hello scenes sensors frame ");
}

TEST_F(ClientQueueTest, WhatWasNotAskedForIsNotSent) {
  queue_.subscribe(false, true, message("scenes "), message("frame "), message("sensors "));
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
  queue_.subscribe(true, false, message("scenes "), message("frame "), message("sensors "));
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

TEST_F(ClientQueueTest, AnIdleClientIsNeverStuck) {
  subscribe();
  take_all();
  EXPECT_EQ(queue_.overdue(at(24h)), std::nullopt);
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
