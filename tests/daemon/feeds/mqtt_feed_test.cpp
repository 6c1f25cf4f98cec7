// The feed with Debian's broker.
#include "daemon/feeds/mqtt_feed.hpp"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/feeds/mqtt_texts.hpp"
#include "drivers/bus/mqtt_client.hpp"
#include "tests/support/mosquitto_broker.hpp"

namespace yuragi::daemon::feeds {
namespace {

using drivers::bus::MqttMessage;
using drivers::bus::MqttStatus;
using settings::feeds::Mqtt;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Key;
using testing::Not;
using testing::Pair;
using values::Quantity;

/// Retries that no test waits for long.
constexpr MqttLink::Times kSoon{.first_retry = std::chrono::milliseconds(20),
                                .longest_retry = std::chrono::milliseconds(50)};

std::string text_of(const MqttMessage& message) {
  return {message.payload.begin(), message.payload.end()};
}

/// Another program, which reads all topics.
class Reader {
 public:
  explicit Reader(std::uint16_t port) {
    drivers::bus::MqttSubscription subscription;
    subscription.host = "127.0.0.1";
    subscription.port = port;
    subscription.topics = {"#"};
    client_ = drivers::bus::make_mqtt_client(subscription);
    client_->connect().value();
  }

  /// The next message of a topic; `meanwhile` is called again and again. Only a hang takes longer.
  MqttMessage next(const std::string& topic, const std::function<void()>& meanwhile) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < deadline) {
      meanwhile();
      MqttMessage message;
      if (client_->receive(message, std::chrono::milliseconds(2)) != MqttStatus::kMessage) continue;
      all_.push_back(message);
      if (message.topic == topic) return message;
    }
    throw std::runtime_error("no message of " + topic);
  }
  /// All that it has received until then.
  const std::vector<MqttMessage>& all() const { return all_; }

  /// What the broker keeps, by topic.
  static std::map<std::string, std::string> retained(std::uint16_t port) {
    Reader reader(port);
    drivers::bus::MqttSubscription end;
    end.host = "127.0.0.1";
    end.port = port;
    const auto sender = drivers::bus::make_mqtt_client(end);
    sender->connect().value();
    // It follows all retained messages.
    sender->publish({.topic = "end", .payload = {}});
    reader.next("end", [] {});
    std::map<std::string, std::string> kept;
    for (const MqttMessage& message : reader.all()) {
      if (message.is_retained) kept[message.topic] = text_of(message);
    }
    return kept;
  }

 private:
  std::unique_ptr<drivers::bus::MqttClient> client_;
  std::vector<MqttMessage> all_;
};

/// A feed that gets moments of a clock of its own.
class FeedRun {
 public:
  explicit FeedRun(std::uint16_t port, bool takes_commands = true, const MqttLink::Times& times = kSoon) {
    config_.host = "127.0.0.1";
    config_.port = port;
    config_.topic = "y";
    config_.every_s = 10.0;
    config_.home_assistant = "ha";
    config_.takes_commands = takes_commands;
    moment_.names = std::make_shared<const values::Names>(values::Names{.sensors = {"roof"}, .scenes = {"meadow"}});
    moment_.sensors = {{.speed_m_s = 7.5, .age_s = 0.25, .state = wind::judging::SensorState::kLive}};
    moment_.opacities = {1.0};
    moment_.shaped[Quantity::kSpeed] = 6.0;
    moment_.shaped[Quantity::kU] = 6.0;
    moment_.shaped[Quantity::kLive] = 1.0;
    set_alert(false);
    feed_ = make_mqtt_feed(
        config_, {.show_scene = [this](const std::string& scene, bool shown) { commands_.emplace_back(scene, shown); }},
        times);
  }

  void set_alert(bool is_on) {
    moment_.health = std::make_shared<const values::Health>(
        values::Health{.alerts = {{.name = "storm", .is_on = is_on}}, .needs_attention = is_on});
  }

  /// One moment later.
  void step(double dt_s = 0.5) {
    moment_.time_s += dt_s;
    moment_.mono = MonoTime(from_seconds(moment_.time_s));
    moment_.utc = UtcTime(from_seconds(moment_.time_s - 0.5));
    feed_->send(moment_);
    std::this_thread::yield();
  }
  std::function<void()> steps() {
    return [this] { step(); };
  }

  values::Moment& moment() { return moment_; }
  Feed& feed() { return *feed_; }
  std::string discovery() const { return "ha/device/" + home_assistant_id("y") + "/config"; }
  const std::vector<std::pair<std::string, bool>>& commands() const { return commands_; }
  void end() { feed_.reset(); }

 private:
  Mqtt config_;
  values::Moment moment_;
  std::vector<std::pair<std::string, bool>> commands_;
  std::unique_ptr<Feed> feed_;
};

TEST(MqttFeedTest, PublishesTheWindAndKeepsOnlyStates) {
  const MosquittoBroker broker;
  Reader reader(broker.port());
  FeedRun run(broker.port());
  const nlohmann::json wind = nlohmann::json::parse(text_of(reader.next("y/wind", run.steps())));
  EXPECT_NEAR(wind.at("speed_m_s").get<double>(), 6.0, 1e-9);
  EXPECT_EQ(wind.at("direction_deg"), 270);
  EXPECT_EQ(wind.at("live"), 1.0);
  reader.next("y/sensor/roof", run.steps());
  const std::map<std::string, std::string> kept = Reader::retained(broker.port());
  EXPECT_EQ(kept.size(), 4U);
  EXPECT_THAT(kept, AllOf(Contains(Pair("y/status", "online")), Contains(Pair("y/alert/storm", "OFF")),
                          Contains(Pair("y/problem", "OFF")), Contains(Key(run.discovery()))));
  EXPECT_THAT(run.feed().status().trouble, IsEmpty());
  EXPECT_GT(run.feed().status().messages, 4U);
}

TEST(MqttFeedTest, APeriodicTopicHasAtMost8640MessagesADay) {
  const MosquittoBroker broker;
  Reader reader(broker.port());
  FeedRun run(broker.port());
  std::string before;
  for (int i = 0; i < 20; ++i) {
    const auto wind = nlohmann::json::parse(text_of(reader.next("y/wind", run.steps())));
    // 10, 20, 30 s and so on after midnight; some may be missing.
    const auto utc = wind.at("utc").get<std::string>();
    EXPECT_GT(utc, before);
    EXPECT_THAT(utc, testing::EndsWith("0.000Z"));
    before = utc;
  }
}

TEST(MqttFeedTest, AnAlertIsPublishedWhenItBeginsAndEnds) {
  const MosquittoBroker broker;
  Reader reader(broker.port());
  FeedRun run(broker.port());
  EXPECT_EQ(text_of(reader.next("y/alert/storm", run.steps())), "OFF");
  run.set_alert(true);
  EXPECT_EQ(text_of(reader.next("y/alert/storm", run.steps())), "ON");
  run.moment().health = std::make_shared<const values::Health>();
  EXPECT_EQ(text_of(reader.next("y/alert/storm", run.steps())), "") << "the alert is gone";
  EXPECT_THAT(Reader::retained(broker.port()), Not(Contains(Key("y/alert/storm"))));
}

TEST(MqttFeedTest, ItIsOfflineOnceItHasEnded) {
  const MosquittoBroker broker;
  Reader reader(broker.port());
  FeedRun run(broker.port());
  EXPECT_EQ(text_of(reader.next("y/status", run.steps())), "online");
  run.end();
  EXPECT_EQ(text_of(reader.next("y/status", [] {})), "offline");
  EXPECT_THAT(Reader::retained(broker.port()), Contains(Pair("y/status", "offline")));
}

TEST(MqttFeedTest, HomeAssistantGetsAllStatesWhenItStarts) {
  const MosquittoBroker broker;
  Reader reader(broker.port());
  FeedRun run(broker.port());
  reader.next(run.discovery(), run.steps());
  reader.next("y/wind", run.steps());
  broker.publish("ha/status", "online");
  reader.next(run.discovery(), run.steps());
  reader.next("y/scene/meadow", run.steps());
}

TEST(MqttFeedTest, EntitiesOfAnEarlierConfigurationAreRemoved) {
  const MosquittoBroker broker;
  Reader reader(broker.port());
  {
    FeedRun earlier(broker.port());
    reader.next(earlier.discovery(), earlier.steps());
    earlier.end();
  }
  FeedRun run(broker.port());
  run.moment().health = std::make_shared<const values::Health>();  // before its first moment: without the alert
  nlohmann::json entity;
  while (entity != nlohmann::json{{"platform", "binary_sensor"}})
    entity = nlohmann::json::parse(text_of(reader.next(run.discovery(), run.steps())))
                 .at("cmps")
                 .value("alert_storm", nlohmann::json());
}

TEST(MqttFeedTest, CommandsReachTheirSceneAndAllElseIsRefused) {
  const MosquittoBroker broker;
  Reader reader(broker.port());
  FeedRun run(broker.port());
  reader.next("y/wind", run.steps());
  broker.publish("y/scene/meadow/set", "hide");
  reader.next("y/wind", run.steps());
  while (run.commands().empty()) run.step();
  EXPECT_EQ(run.commands().front(), std::pair(std::string("meadow"), false));
  broker.publish("y/scene/meadow/set", "away");
  broker.publish("y/scene/another/set", "ON");
  broker.publish("y/scene/meadow/set", std::string(1000, 'N'));
  while (run.feed().status().sends.find("refused 3 messages") == std::string::npos) run.step();
  EXPECT_EQ(run.commands().size(), 1U);
}

TEST(MqttFeedTest, AKeptCommandIsNotCarriedOut) {
  const MosquittoBroker broker;
  broker.retain("y/scene/meadow/set", "OFF");
  FeedRun run(broker.port());
  while (run.feed().status().sends.find("refused 1 message") == std::string::npos) run.step();
  EXPECT_THAT(run.commands(), IsEmpty());
}

TEST(MqttFeedTest, AFloodOfCommandsIsRefused) {
  const MosquittoBroker broker;
  Reader reader(broker.port());
  FeedRun run(broker.port());
  reader.next("y/wind", run.steps());
  drivers::bus::MqttSubscription subscription;
  subscription.host = "127.0.0.1";
  subscription.port = broker.port();
  const auto sender = drivers::bus::make_mqtt_client(subscription);
  ASSERT_TRUE(sender->connect());
  constexpr int kFlood = 200;
  for (int i = 0; i < kFlood; ++i) {
    while (sender->publish({.topic = "y/scene/meadow/set", .payload = {'O', 'N'}}) !=
           drivers::bus::MqttSending::kSent) {
      MqttMessage none;
      sender->receive(none, Nanoseconds(0));
    }
  }
  // Within one second of the moments' time.
  while (run.feed().status().sends.find("refused 190 messages") == std::string::npos) run.step(0.0);
  EXPECT_EQ(run.commands().size(), 10U);
}

TEST(MqttFeedTest, ABrokerThatIsRestartedGetsAllStatesAgain) {
  MosquittoBroker broker;
  FeedRun run(broker.port());
  {
    Reader reader(broker.port());
    reader.next("y/wind", run.steps());
  }
  broker.stop();
  while (run.feed().status().trouble.empty()) run.step();
  EXPECT_THAT(run.feed().status().trouble, HasSubstr("check"));
  broker.start();
  while (!run.feed().status().trouble.empty()) run.step();
  Reader reader(broker.port());
  reader.next("y/wind", run.steps());
  EXPECT_THAT(Reader::retained(broker.port()),
              AllOf(Contains(Pair("y/status", "online")), Contains(Key(run.discovery())),
                    Contains(Pair("y/alert/storm", "OFF"))));
}

TEST(MqttFeedTest, ABrokerThatHangsDelaysNothingAndIsReported) {
  MosquittoBroker broker;
  MqttLink::Times times = kSoon;
  times.keep_alive = std::chrono::seconds(5);
  times.connect = std::chrono::milliseconds(200);
  FeedRun run(broker.port(), true, times);
  {
    Reader reader(broker.port());
    reader.next("y/wind", run.steps());
  }
  broker.hold();
  while (run.feed().status().trouble.empty()) run.step();
  broker.go_on();
  while (!run.feed().status().trouble.empty()) run.step();
}

TEST(MqttFeedTest, ABrokerThatRefusesTheUserIsATrouble) {
  const MosquittoBroker broker("allow_anonymous false\n");
  FeedRun run(broker.port());
  while (run.feed().status().trouble.empty()) run.step();
  EXPECT_THAT(run.feed().status().trouble, HasSubstr("check `user` and `password`"));
}

}  // namespace
}  // namespace yuragi::daemon::feeds
