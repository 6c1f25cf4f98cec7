#include "daemon/feeds/mqtt_outbox.hpp"

#include <gtest/gtest.h>

namespace yuragi::daemon::feeds {
namespace {

TEST(MqttOutboxTest, TheNewestOfEachTopicTakesThePlaceOfTheOldest) {
  MqttOutbox outbox;
  outbox.post({.topic = "wind", .payload = "1"});
  outbox.post({.topic = "fast", .payload = "2"});
  outbox.post({.topic = "wind", .payload = "3"});
  EXPECT_EQ(outbox.size(), 2U);
  EXPECT_EQ(outbox.take()->payload, "3");
  EXPECT_EQ(outbox.take()->payload, "2");
  EXPECT_EQ(outbox.take(), std::nullopt);
}

TEST(MqttOutboxTest, ADayWithoutABrokerWaitsInNoMoreMessagesThanTopics) {
  MqttOutbox outbox;
  for (int i = 0; i < 100'000; ++i) outbox.post({.topic = "wind" + std::to_string(i % 3), .payload = "1"});
  EXPECT_EQ(outbox.size(), 3U);
}

TEST(MqttOutboxTest, OnlyStatesAreSentAgain) {
  MqttOutbox outbox;
  outbox.post({.topic = "wind", .payload = "1"});
  outbox.post({.topic = "b", .payload = "ON", .is_retained = true, .is_state = true});
  outbox.post({.topic = "a", .payload = "ON", .is_state = true});
  while (outbox.take()) {
  }
  outbox.post({.topic = "b", .payload = "OFF", .is_retained = true, .is_state = true});
  outbox.post_states_again();
  EXPECT_EQ(outbox.take()->payload, "OFF");
  EXPECT_EQ(outbox.take()->topic, "a");
  EXPECT_TRUE(outbox.is_empty());
}

TEST(MqttOutboxTest, AnEmptyStateIsSentOnceAndForgotten) {
  MqttOutbox outbox;
  outbox.post({.topic = "a", .payload = "ON", .is_state = true});
  outbox.post({.topic = "a", .payload = "", .is_state = true});
  EXPECT_EQ(outbox.take()->payload, "");
  outbox.post_states_again();
  EXPECT_TRUE(outbox.is_empty());
}

TEST(MqttOutboxTest, WhatIsPutBackComesFirstUnlessThereIsANewerOne) {
  MqttOutbox outbox;
  outbox.post({.topic = "a", .payload = "1"});
  outbox.post({.topic = "b", .payload = "2"});
  MqttPost first = *outbox.take();
  outbox.put_back(first);
  EXPECT_EQ(outbox.take()->topic, "a");
  outbox.post({.topic = "a", .payload = "3"});
  outbox.put_back(first);
  EXPECT_EQ(outbox.size(), 2U);
  EXPECT_EQ(outbox.take()->topic, "b");
  EXPECT_EQ(outbox.take()->payload, "3");
}

}  // namespace
}  // namespace yuragi::daemon::feeds
