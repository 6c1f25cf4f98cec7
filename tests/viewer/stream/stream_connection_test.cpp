#include "viewer/stream/stream_connection.hpp"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/viewer/stream_server.hpp"

namespace yuragi::viewer::stream {
namespace {

using testing::HasSubstr;

const wire::Bytes kHello = wire::encode(wire::Hello{wire::kProtocol, "a test", 60.0});

pose::Skeleton one_strand() {
  pose::StrandSkeleton strand;
  strand.strand_count = 1;
  strand.links_per_strand = 3;
  const std::vector<float> zeros(strand.padded_count());
  const std::vector<float> ones(strand.padded_count(), 1.0F);
  strand.root_x_m = strand.root_y_m = strand.root_z_m = zeros;
  strand.rest_x = strand.rest_z = strand.curl_y = strand.curl_z = strand.rest_curl_rad = zeros;
  strand.rest_y = strand.curl_x = strand.link_length_m = ones;
  return strand;
}

wire::Bytes scenes_named(const std::string& name) {
  return wire::encode(wire::Scenes{{{name, "grass", one_strand()}}});
}

wire::Bytes frame_of(std::uint64_t sequence) {
  static const pose::Skeleton kSkeleton = one_strand();
  const pose::Pose pose = pose::StrandPose{std::vector<float>(16, 0.25F), std::vector<float>(16, -0.5F)};
  const std::array<const pose::Skeleton*, 1> skeletons{&kSkeleton};
  const std::array<const pose::Pose*, 1> poses{&pose};
  wire::FrameEncoder encoder;
  const auto bytes = encoder.encode({.sequence = sequence, .tick = sequence, .time_s = 0.1, .utc_ns = 0, .wind = {}},
                                    skeletons, poses);
  return {bytes.begin(), bytes.end()};
}

/// A message whose body is of a kind that this protocol does not know: a Hello with another number in its type field.
wire::Bytes message_of_unknown_kind() {
  for (std::size_t i = wire::kSizePrefixBytes; i < kHello.size(); ++i) {
    wire::Bytes changed = kHello;
    changed[i] = 99;
    const auto message = wire::decode(std::span(changed).subspan(wire::kSizePrefixBytes));
    if (!message && message.error() == wire::Error::kUnknown) return changed;
  }
  ADD_FAILURE() << "no byte of a Hello makes it a message of unknown kind";
  return {};
}

Options options_for(std::uint16_t port) {
  return {.host = "127.0.0.1",
          .port = port,
          .min_backoff = std::chrono::milliseconds(5),
          .max_backoff = std::chrono::milliseconds(20)};
}

/// A connection, and all that has come over it.
class Viewer {
 public:
  explicit Viewer(Options options) : connection(std::move(options)) {}

  /// Takes what comes until `is_done` (or for a minute, if it hangs).
  bool wait_until(const std::function<bool()>& is_done) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    for (;;) {
      Inbox inbox = connection.take();
      if (inbox.scenes) scenes.push_back(inbox.scenes->scenes.at(0).name);
      for (TimedFrame& timed : inbox.frames) frames.push_back(std::move(timed.frame));
      if (inbox.sensors) sensors = std::move(inbox.sensors);
      for (const wire::ControlReply& reply : inbox.replies) replies.push_back(reply.message);
      has_new_connection = has_new_connection || inbox.is_of_new_connection;
      if (is_done()) return true;
      if (std::chrono::steady_clock::now() > deadline) return false;
      connection.wait_for_news(std::chrono::seconds(1));
    }
  }
  bool wait_for_frames(std::size_t count) {
    return wait_until([&] { return frames.size() >= count; });
  }
  bool wait_for_text(const std::string& part) {
    return wait_until([&] { return connection.status().text.find(part) != std::string::npos; });
  }

  std::vector<std::string> replies;
  bool has_new_connection = false;
  Connection connection;
  std::vector<std::string> scenes;
  std::vector<wire::Frame> frames;
  std::optional<wire::Sensors> sensors;
};

TEST(StreamConnection, SubscribesAndHandsOverScenesFramesAndSensors) {
  StreamServer server(kHello);
  Viewer viewer(options_for(server.port()));
  ASSERT_TRUE(server.wait_for_subscriptions(1));

  wire::Sensors sensors;
  sensors.clients = 7;
  server.send(scenes_named("meadow") + frame_of(1) + frame_of(2) + wire::encode(sensors));
  ASSERT_TRUE(viewer.wait_until([&] { return viewer.sensors.has_value(); }));

  EXPECT_THAT(viewer.scenes, testing::ElementsAre("meadow"));
  ASSERT_EQ(viewer.frames.size(), 2U);
  EXPECT_EQ(viewer.frames[1].info.sequence, 2U);
  EXPECT_NEAR(std::get<pose::StrandPose>(viewer.frames[1].poses.at(0)).bend_south_rad.at(0), -0.5F, 1e-3F);
  EXPECT_EQ(viewer.sensors->clients, 7U);
  EXPECT_EQ(viewer.connection.status().state, State::kConnected);
  EXPECT_TRUE(viewer.connection.status().is_same_machine);
  EXPECT_THAT(viewer.connection.status().text, HasSubstr("a test"));
}

TEST(StreamConnection, TakesAMessageThatComesByteByByte) {
  StreamServer server(kHello);
  Viewer viewer(options_for(server.port()));
  ASSERT_TRUE(server.wait_for_subscriptions(1));
  for (const std::uint8_t byte : scenes_named("meadow") + frame_of(5)) server.send({byte});
  ASSERT_TRUE(viewer.wait_for_frames(1));
  EXPECT_EQ(viewer.frames[0].info.sequence, 5U);
}

TEST(StreamConnection, ComesBackWhenTheServerCutsItOff) {
  StreamServer server(kHello + scenes_named("meadow"));
  Viewer viewer(options_for(server.port()));
  for (std::size_t round = 1; round <= 5; ++round) {
    ASSERT_TRUE(server.wait_for_subscriptions(round));
    server.send(frame_of(round));
    ASSERT_TRUE(viewer.wait_for_frames(round));
    server.cut();
  }
}

TEST(StreamConnection, ComesBackWhenTheServerIsRestartedOnThePort) {
  auto server = std::make_unique<StreamServer>(kHello + scenes_named("first"));
  const std::uint16_t port = server->port();
  Viewer viewer(options_for(port));
  ASSERT_TRUE(viewer.wait_until([&] { return !viewer.scenes.empty(); }));
  server.reset();
  ASSERT_TRUE(viewer.wait_for_text("no daemon replies"));
  EXPECT_EQ(viewer.connection.status().state, State::kWaiting);

  server = std::make_unique<StreamServer>(kHello + scenes_named("second"), port);
  ASSERT_TRUE(server->wait_for_subscriptions(1));
  server->send(frame_of(9));
  ASSERT_TRUE(viewer.wait_for_frames(1));
  EXPECT_THAT(viewer.scenes, testing::ElementsAre("first", "second"));
}

TEST(StreamConnection, SendsControlsInOrderAndHandsOverTheReplies) {
  StreamServer server(kHello);
  Viewer viewer(options_for(server.port()));
  ASSERT_TRUE(server.wait_for_subscriptions(1));
  server.send(scenes_named("grass"));
  ASSERT_TRUE(viewer.wait_until([&] { return !viewer.scenes.empty(); }));
  EXPECT_TRUE(viewer.has_new_connection);
  for (std::uint32_t number = 0; number < 100; ++number) {
    viewer.connection.send({.scene = "", .parameters = wire::ParameterCommand{.number = number}});
  }
  const std::vector<wire::Control> controls = server.wait_for_controls(100);
  ASSERT_EQ(controls.size(), 100U);
  for (std::uint32_t number = 0; number < 100; ++number) EXPECT_EQ(controls[number].parameters->number, number);
  server.send(wire::encode(wire::ControlReply{.done = true, .message = "one", .scenes = {}}) +
              wire::encode(wire::ControlReply{.done = false, .message = "two", .scenes = {}}));
  ASSERT_TRUE(viewer.wait_until([&] { return viewer.replies.size() == 2; }));
  EXPECT_EQ(viewer.replies, (std::vector<std::string>{"one", "two"}));

  viewer.has_new_connection = false;
  server.cut();
  ASSERT_TRUE(viewer.wait_until([&] { return viewer.has_new_connection; }));
}

TEST(StreamConnection, TellsOnlyADaemonThatKnowsItWhatTheWallGivesUp) {
  for (const bool is_known : {false, true}) {
    StreamServer server(
        wire::encode(wire::Hello{.software = "a test", .tick_rate_hz = 60.0, .takes_display = is_known}));
    Viewer viewer(options_for(server.port()));
    ASSERT_TRUE(server.wait_for_subscriptions(1));
    server.send(scenes_named("grass"));
    ASSERT_TRUE(viewer.wait_until([&] { return !viewer.scenes.empty(); }));  // and so the Hello has come
    viewer.connection.send(wire::Display{.given_up = 3});
    viewer.connection.send(wire::Control{});
    ASSERT_EQ(server.wait_for_controls(1).size(), 1U);
    EXPECT_EQ(server.given_up(), is_known ? std::optional<std::uint8_t>(3) : std::nullopt);
  }
}

TEST(StreamConnection, ShowsTheTokenWithEachSubscription) {
  StreamServer server(kHello);
  Options options = options_for(server.port());
  options.token = Secret("correct horse battery staple");
  const Viewer viewer(options);
  ASSERT_TRUE(server.wait_for_subscriptions(1));
  EXPECT_EQ(server.token(), options.token);
  server.cut();
  ASSERT_TRUE(server.wait_for_subscriptions(2));
  EXPECT_EQ(server.token(), options.token);
}

TEST(StreamConnection, WithoutAConnectionAControlIsDropped) {
  std::uint16_t port = 0;
  {
    const StreamServer gone(kHello);
    port = gone.port();
  }
  Connection connection(options_for(port));
  for (int i = 0; i < 1000; ++i) connection.send({.scene = "elm"});
  StreamServer server(kHello, port);
  ASSERT_TRUE(server.wait_for_subscriptions(1));
  EXPECT_TRUE(server.wait_for_controls(0).empty());
}

TEST(StreamConnection, SkipsAMessageOfUnknownKind) {
  StreamServer server(kHello);
  Viewer viewer(options_for(server.port()));
  ASSERT_TRUE(server.wait_for_subscriptions(1));
  server.send(scenes_named("meadow") + message_of_unknown_kind() + frame_of(3));
  ASSERT_TRUE(viewer.wait_for_frames(1));
  EXPECT_THAT(viewer.connection.status().text, HasSubstr("connected"));
}

TEST(StreamConnection, DropsAServerThatSendsGarbageAndTriesAgain) {
  const wire::Bytes impossible_length(64, 0xFF);
  StreamServer server(impossible_length);
  Viewer viewer(options_for(server.port()));
  EXPECT_TRUE(server.wait_for_subscriptions(3));

  wire::Bytes not_a_message(36, 0xA5);
  not_a_message[0] = 32;
  not_a_message[1] = not_a_message[2] = not_a_message[3] = 0;
  StreamServer other(not_a_message);
  Viewer second(options_for(other.port()));
  EXPECT_TRUE(other.wait_for_subscriptions(3));
  EXPECT_TRUE(second.wait_for_text("is not a Yuragi daemon"));
  EXPECT_TRUE(second.frames.empty());
}

TEST(StreamConnection, SaysThatAServerSpeaksAnotherProtocol) {
  StreamServer server(wire::encode(wire::Hello{wire::kProtocol + 1, "yuragi 9", 60.0}));
  Viewer viewer(options_for(server.port()));
  EXPECT_TRUE(viewer.wait_for_text("(yuragi 9) speaks protocol 2"));
}

TEST(StreamConnection, GivesUpASilentServerAndTriesAgain) {
  StreamServer server({});
  Options options = options_for(server.port());
  options.silence_limit = std::chrono::milliseconds(30);
  const Viewer viewer(options);
  EXPECT_TRUE(server.wait_for_subscriptions(3));
}

TEST(StreamConnection, KeepsOnlyTheNewestFramesForAReaderWhoDoesNotLook) {
  StreamServer server(kHello + scenes_named("meadow"));
  Viewer viewer(options_for(server.port()));
  ASSERT_TRUE(server.wait_for_subscriptions(1));
  for (std::uint64_t i = 1; i <= 300; ++i) server.send(frame_of(i));
  server.send(wire::encode(wire::Hello{wire::kProtocol, "the end", 60.0}));

  // The status is read without taking anything out.
  while (viewer.connection.status().text.find("the end") == std::string::npos) {
    viewer.connection.wait_for_news(std::chrono::seconds(1));
  }
  Inbox inbox = viewer.connection.take();
  EXPECT_TRUE(inbox.scenes.has_value());
  ASSERT_EQ(inbox.frames.size(), Connection::kMaxWaitingFrames);
  EXPECT_EQ(inbox.frames.back().frame.info.sequence, 300U);
  EXPECT_EQ(inbox.frames.front().frame.info.sequence, 301U - Connection::kMaxWaitingFrames);
}

TEST(StreamConnection, DropsFramesOfTheScenesBefore) {
  StreamServer server(kHello + scenes_named("old"));
  Viewer viewer(options_for(server.port()));
  ASSERT_TRUE(server.wait_for_subscriptions(1));
  server.send(frame_of(1) + scenes_named("new") + wire::encode(wire::Hello{wire::kProtocol, "the end", 60.0}));
  while (viewer.connection.status().text.find("the end") == std::string::npos) {
    viewer.connection.wait_for_news(std::chrono::seconds(1));
  }
  const Inbox inbox = viewer.connection.take();
  ASSERT_TRUE(inbox.scenes.has_value());
  EXPECT_EQ(inbox.scenes->scenes.at(0).name, "new");
  EXPECT_TRUE(inbox.frames.empty());
}

TEST(StreamConnection, StopsWhileItWaitsToTryAgain) {
  // Were the stop to wait for the next attempt, this would take an hour.
  std::uint16_t port = 0;
  { port = StreamServer({}).port(); }
  Options options = options_for(port);
  options.min_backoff = options.max_backoff = std::chrono::hours(1);
  Viewer viewer(options);
  EXPECT_TRUE(viewer.wait_for_text("no daemon replies"));
}

}  // namespace
}  // namespace yuragi::viewer::stream
