#include "daemon/stream/tcp_stream.hpp"

#include <algorithm>
#include <array>
#include <deque>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <gtest/gtest.h>

#include "engine/base/address.hpp"
#include "engine/wire/message_reader.hpp"
#include "tests/engine/wire/samples.hpp"
#include "tests/support/no_free_descriptor.hpp"

// Real sockets on loopback; server and clients share one I/O context, which the tests turn by hand until what they wait
// for has happened.

namespace yuragi::daemon::stream {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using namespace std::chrono_literals;

SharedBytes share(wire::Bytes bytes) {
  return std::make_shared<const wire::Bytes>(std::move(bytes));
}

/// Makes frames of `strands` strands, which differ in their sequence numbers only.
class FrameMaker {
 public:
  explicit FrameMaker(std::size_t strands) : skeleton_(samples::meadow(strands)), pose_(samples::bent(strands)) {}

  SharedBytes make(std::uint64_t sequence) {
    wire::FrameInfo info = samples::frame_info();
    info.sequence = sequence;
    const std::array<const pose::Skeleton*, 1> skeletons{&skeleton_};
    const std::array<const pose::Pose*, 1> poses{&pose_};
    const auto bytes = encoder_.encode(info, skeletons, poses);
    return std::make_shared<const wire::Bytes>(bytes.begin(), bytes.end());
  }

 private:
  pose::Skeleton skeleton_;
  pose::Pose pose_;
  wire::FrameEncoder encoder_;
};

SharedBytes frame(std::uint64_t sequence) {
  return FrameMaker(37).make(sequence);
}

/// 80 kB a frame: a few dozen of them are more than the kernel's buffers hold.
constexpr std::size_t kManyStrands = 20'000;

/// Connects, and keeps all that comes unless it is paused.
class TestClient {
 public:
  TestClient(asio::io_context& io, const std::string& endpoint, int receive_buffer_bytes = 0) : socket_(io) {
    const Address address = parse_address(endpoint).value();
    socket_.open(tcp::v4());
    if (receive_buffer_bytes > 0) socket_.set_option(asio::socket_base::receive_buffer_size(receive_buffer_bytes));
    socket_.connect(tcp::endpoint(asio::ip::make_address(address.host), address.port));
    resume();
  }
  ~TestClient() {
    boost::system::error_code ignored;
    socket_.close(ignored);
  }

  void send(const wire::Bytes& bytes) { asio::write(socket_, asio::buffer(bytes)); }

  void pause() { paused_ = true; }
  void resume() {
    paused_ = false;
    socket_.async_read_some(asio::buffer(*chunk_), [this, chunk = chunk_](const auto& error, std::size_t count) {
      if (error == asio::error::operation_aborted) return;  // this may be gone
      if (error) {
        closed = true;
        return;
      }
      reader_.feed(std::span(*chunk).first(count));
      while (auto message = reader_.next()) take(std::move(message->value()));
      if (!paused_) resume();
    });
  }

  bool closed = false;
  std::vector<wire::Hello> hellos;
  std::vector<wire::Scenes> scenes;
  std::vector<std::uint64_t> frames;  // their sequence numbers
  std::vector<wire::Sensors> sensors;
  std::vector<wire::ControlReply> replies;
  std::vector<wire::RawTrace> traces;
  std::vector<std::size_t> kinds;  // of all messages, in order

 private:
  void take(wire::Message message) {
    kinds.push_back(message.index());
    if (auto* hello = std::get_if<wire::Hello>(&message)) hellos.push_back(*hello);
    if (auto* set = std::get_if<wire::Scenes>(&message)) scenes.push_back(*set);
    if (auto* one = std::get_if<wire::Frame>(&message)) frames.push_back(one->info.sequence);
    if (auto* state = std::get_if<wire::Sensors>(&message)) sensors.push_back(*state);
    if (auto* trace = std::get_if<wire::RawTrace>(&message)) traces.push_back(*trace);
    if (auto* reply = std::get_if<wire::ControlReply>(&message)) replies.push_back(*reply);
  }

  tcp::socket socket_;
  std::shared_ptr<std::array<std::uint8_t, 65536>> chunk_ = std::make_shared<std::array<std::uint8_t, 65536>>();
  wire::MessageReader reader_;
  bool paused_ = false;
};

class TcpStreamTest : public testing::Test {
 protected:
  TcpStreamSettings settings() {
    TcpStreamSettings settings;
    settings.hello = {.software = "test", .tick_rate_hz = 60.0};
    settings.scenes = samples::scenes();
    settings.check_every = 1ms;
    settings.now = [this] { return now_; };
    settings.on_control = [this](const wire::Control& control, bool is_local) {
      controls_.push_back(control);
      all_were_local_ = all_were_local_ && is_local;
      return wire::ControlReply{.done = true, .message = "it is done", .scenes = {}};
    };
    return settings;
  }

  /// Turns the I/O context until `done`, for a minute at most. False where it hangs.
  template <class Done>
  bool turn_until(Done done) {
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (!done() && std::chrono::steady_clock::now() < deadline) {
      io_.restart();
      io_.run_one_for(10ms);
    }
    return done();
  }

  std::vector<wire::Control> controls_;
  bool all_were_local_ = true;
  MonoTime now_{std::chrono::hours(1)};
  asio::io_context io_{1};
  TcpStream stream_{io_, "127.0.0.1:0", settings()};
};

TEST_F(TcpStreamTest, AClientIsGreetedAtOnce) {
  TestClient client(io_, stream_.local_endpoint());
  ASSERT_TRUE(turn_until([&] { return !client.hellos.empty(); }));
  EXPECT_EQ(client.hellos[0].software, "test");
  EXPECT_EQ(client.hellos[0].tick_rate_hz, 60.0);
  EXPECT_FALSE(client.hellos[0].refused.has_value());
  EXPECT_EQ(stream_.client_count(), 1u);
}

TEST_F(TcpStreamTest, ASubscriberGetsScenesAndThenEveryFrameThatItIsFastEnoughFor) {
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(samples::subscribe()));
  ASSERT_TRUE(turn_until([&] { return !client.scenes.empty(); }));
  EXPECT_EQ(client.scenes[0].scenes.size(), 2u);
  for (std::uint64_t i = 1; i <= 20; ++i) {
    stream_.publish(frame(i));
    ASSERT_TRUE(turn_until([&] { return client.frames.size() == i; })) << i;
    ASSERT_EQ(client.frames.back(), i);
  }
}

TEST_F(TcpStreamTest, ALateJoinerHasScenesAndThePictureWithoutWaitingForTheNextFrame) {
  stream_.publish(frame(41));
  stream_.publish(frame(42));
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(wire::Subscribe{.client = "late"}));
  ASSERT_TRUE(turn_until([&] { return !client.frames.empty(); }));
  EXPECT_EQ(client.frames, (std::vector<std::uint64_t>{42}));
  EXPECT_EQ(client.kinds, (std::vector<std::size_t>{0, 2, 3})) << "hello, scenes, frame";
}

TEST_F(TcpStreamTest, OneWhoWatchesSensorsOnlyGetsNoPoses) {
  stream_.publish(frame(1));
  stream_.publish_sensors(share(wire::encode(samples::sensors())));
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(wire::Subscribe{.poses = false, .sensors = true, .client = "table"}));
  ASSERT_TRUE(turn_until([&] { return client.sensors.size() == 1; }));
  stream_.publish(frame(2));
  stream_.publish_sensors(share(wire::encode(samples::sensors())));
  ASSERT_TRUE(turn_until([&] { return client.sensors.size() == 2; }));
  EXPECT_EQ(client.kinds, (std::vector<std::size_t>{0, 4, 4}));
}

wire::RawTrace trace_of(const std::string& sensor, std::size_t size = 7) {
  return {
      .sensor = sensor, .received = true, .bytes = wire::Bytes(size, 0x5A), .length = static_cast<std::uint32_t>(size)};
}

TEST_F(TcpStreamTest, RawMessagesGoToThoseWhoAskedForThatSensorAndToNobodyElse) {
  TestClient all(io_, stream_.local_endpoint());
  TestClient roof(io_, stream_.local_endpoint());
  TestClient none(io_, stream_.local_endpoint());
  EXPECT_FALSE(stream_.wants_trace("roof"));
  all.send(wire::encode(wire::Subscribe{.poses = false, .client = "", .raw = true}));
  ASSERT_TRUE(turn_until([&] { return stream_.wants_trace("mast"); }));
  roof.send(
      wire::encode(wire::Subscribe{.poses = false, .sensors = true, .client = "", .raw = true, .raw_sensor = "roof"}));
  none.send(wire::encode(wire::Subscribe{.poses = false, .sensors = true, .client = ""}));
  stream_.publish_sensors(share(wire::encode(samples::sensors())));
  ASSERT_TRUE(turn_until([&] { return !roof.sensors.empty() && !none.sensors.empty(); }));

  stream_.publish_trace(trace_of("mast"));
  stream_.publish_trace(samples::raw_trace());
  ASSERT_TRUE(turn_until([&] { return all.traces.size() == 2 && roof.traces.size() == 1; }));
  EXPECT_EQ(all.traces[0].sensor, "mast");
  EXPECT_EQ(roof.traces[0].sensor, "roof");
  EXPECT_EQ(roof.traces[0].bytes, samples::raw_trace().bytes);
  EXPECT_EQ(roof.traces[0].lost, 3u);
  stream_.publish_sensors(share(wire::encode(samples::sensors())));
  ASSERT_TRUE(turn_until([&] { return none.sensors.size() == 2; }));
  EXPECT_TRUE(none.traces.empty());
}

TEST_F(TcpStreamTest, NobodyWantsTracesAnyMoreOnceTheClientIsGone) {
  {
    TestClient client(io_, stream_.local_endpoint());
    client.send(wire::encode(wire::Subscribe{.poses = false, .client = "", .raw = true, .raw_sensor = "roof"}));
    ASSERT_TRUE(turn_until([&] { return stream_.wants_trace("roof"); }));
    EXPECT_FALSE(stream_.wants_trace("mast"));
  }
  EXPECT_TRUE(turn_until([&] { return !stream_.wants_trace("roof"); }));
}

TEST_F(TcpStreamTest, ASlowReaderOfRawMessagesIsToldHowManyItMissed) {
  constexpr std::uint64_t kMessages = 40'000;
  TestClient slow(io_, stream_.local_endpoint(), 16384);
  slow.send(wire::encode(wire::Subscribe{.poses = false, .client = "", .raw = true}));
  ASSERT_TRUE(turn_until([&] { return stream_.wants_trace("roof"); }));
  slow.pause();
  for (std::uint64_t i = 0; i < kMessages; ++i) stream_.publish_trace(trace_of("roof", wire::kMaxRawBytes));
  slow.resume();

  // One more, once there is room again, tells of all that were missed before it.
  const auto accounted = [&] {
    std::uint64_t count = slow.traces.size();
    for (const wire::RawTrace& trace : slow.traces) count += trace.lost;
    return count;
  };
  std::uint64_t sent = kMessages;
  ASSERT_TRUE(turn_until([&] {
    const std::size_t before = slow.traces.size();
    if (before > 0 && slow.traces.back().lost == 0) {
      stream_.publish_trace(trace_of("roof"));
      ++sent;
    }
    return before > 0 && slow.traces.back().lost > 0;
  }));
  EXPECT_TRUE(turn_until([&] { return accounted() == sent; })) << accounted() << " of " << sent;
  EXPECT_LT(slow.traces.size(), kMessages / 2) << "all of them were kept for it";
}

TEST_F(TcpStreamTest, OneWhoDidNotSubscribeGetsOnlyTheGreeting) {
  TestClient silent(io_, stream_.local_endpoint());
  TestClient watching(io_, stream_.local_endpoint());
  watching.send(wire::encode(wire::Subscribe{.client = ""}));
  ASSERT_TRUE(turn_until([&] { return !watching.scenes.empty() && !silent.hellos.empty(); }));
  stream_.publish(frame(1));
  ASSERT_TRUE(turn_until([&] { return !watching.frames.empty(); }));
  EXPECT_EQ(silent.kinds, (std::vector<std::size_t>{0}));
}

TEST_F(TcpStreamTest, ASlowReaderMissesFramesNeverTheNewestAndHoldsNobodyUp) {
  constexpr std::uint64_t kFrames = 150;
  FrameMaker large(kManyStrands);
  TestClient slow(io_, stream_.local_endpoint(), 16384);
  TestClient fast(io_, stream_.local_endpoint());
  for (TestClient* client : {&slow, &fast}) client->send(wire::encode(wire::Subscribe{.client = ""}));
  ASSERT_TRUE(turn_until([&] { return !slow.scenes.empty() && !fast.scenes.empty(); }));

  slow.pause();
  for (std::uint64_t i = 1; i <= kFrames; ++i) {
    stream_.publish(large.make(i));
    ASSERT_TRUE(turn_until([&] { return fast.frames.size() == i; })) << i;
  }
  slow.resume();
  ASSERT_TRUE(turn_until([&] { return !slow.frames.empty() && slow.frames.back() == kFrames; }));
  EXPECT_LT(slow.frames.size(), 20u) << "old frames were kept for it";
  EXPECT_TRUE(std::is_sorted(slow.frames.begin(), slow.frames.end()));
  EXPECT_EQ(fast.frames.size(), kFrames);
}

TEST_F(TcpStreamTest, AClientThatStopsReadingIsDroppedAfterItsTime) {
  TestClient stuck(io_, stream_.local_endpoint(), 16384);
  TestClient fine(io_, stream_.local_endpoint());
  for (TestClient* client : {&stuck, &fine}) client->send(wire::encode(wire::Subscribe{.client = ""}));
  ASSERT_TRUE(turn_until([&] { return !stuck.scenes.empty() && !fine.scenes.empty(); }));
  stuck.pause();
  FrameMaker large(kManyStrands);
  for (std::uint64_t i = 1; i <= 30; ++i) {
    stream_.publish(large.make(i));
    ASSERT_TRUE(turn_until([&] { return fine.frames.size() == i; }));
  }
  EXPECT_EQ(stream_.client_count(), 2u);

  now_ += 5s;
  ASSERT_TRUE(turn_until([&] { return stream_.client_count() == 1; }));
  EXPECT_EQ(stream_.stuck_clients(), 1u);
  stream_.publish(frame(31));
  EXPECT_TRUE(turn_until([&] { return fine.frames.back() == 31; }));
}

TEST_F(TcpStreamTest, AClientThatNeverSubscribesIsDroppedAfterItsTime) {
  TestClient silent(io_, stream_.local_endpoint());
  TestClient watching(io_, stream_.local_endpoint());
  watching.send(wire::encode(wire::Subscribe{.client = ""}));
  ASSERT_TRUE(turn_until([&] { return !watching.scenes.empty() && !silent.hellos.empty(); }));
  now_ += 5s;
  ASSERT_TRUE(turn_until([&] { return silent.closed; }));
  EXPECT_FALSE(watching.closed);
  EXPECT_EQ(stream_.client_count(), 1u);
  EXPECT_EQ(stream_.stuck_clients(), 0u);
}

TEST_F(TcpStreamTest, WhoeverSendsWhatAClientMayNotSendIsDropped) {
  wire::Bytes two_controls = wire::encode(wire::Subscribe{.client = ""});
  two_controls.insert(two_controls.end(), two_controls.begin(), two_controls.end());
  const std::vector<wire::Bytes> offences{
      {'G', 'E', 'T', ' ', '/', ' ', 'H', 'T', 'T', 'P'},  // an impossible length
      {0x01, 0x10, 0, 0},                                  // one byte more than the server reads
      {0, 0, 0, 0},                                        // nothing
      {8, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8},                // garbage of an honest length
      wire::encode(samples::hello()),                      // a server's message
      wire::encode(wire::Subscribe{.protocol = 2, .client = "new"}),
      two_controls,
  };
  TestClient good(io_, stream_.local_endpoint());
  good.send(wire::encode(wire::Subscribe{.client = ""}));
  for (std::size_t i = 0; i < offences.size(); ++i) {
    TestClient bad(io_, stream_.local_endpoint());
    bad.send(offences[i]);
    EXPECT_TRUE(turn_until([&] { return bad.closed; })) << i;
    EXPECT_EQ(stream_.client_count(), 1u);
  }
  stream_.publish(frame(1));
  EXPECT_TRUE(turn_until([&] { return !good.frames.empty(); }));
}

TEST_F(TcpStreamTest, AClientThatLeavesIsForgotten) {
  {
    TestClient client(io_, stream_.local_endpoint());
    client.send(wire::encode(wire::Subscribe{.client = ""}));
    ASSERT_TRUE(turn_until([&] { return !client.scenes.empty(); }));
  }
  EXPECT_TRUE(turn_until([&] { return stream_.client_count() == 0; }));
  stream_.publish(frame(1));
}

TEST_F(TcpStreamTest, OneClientTooManyIsToldSoUntilAnotherLeaves) {
  std::deque<TestClient> clients;
  for (int i = 0; i < 32; ++i) {
    clients.emplace_back(io_, stream_.local_endpoint());
    clients.back().send(wire::encode(wire::Subscribe{.client = ""}));
  }
  ASSERT_TRUE(turn_until([&] { return stream_.client_count() == 32; }));

  TestClient extra(io_, stream_.local_endpoint());
  ASSERT_TRUE(turn_until([&] { return extra.closed; }));
  ASSERT_EQ(extra.hellos.size(), 1u);
  EXPECT_NE(extra.hellos[0].refused.value().find("32"), std::string::npos);
  EXPECT_EQ(stream_.client_count(), 32u);

  clients.pop_front();
  ASSERT_TRUE(turn_until([&] { return stream_.client_count() == 31; }));
  TestClient next(io_, stream_.local_endpoint());
  ASSERT_TRUE(turn_until([&] { return !next.hellos.empty(); }));
  EXPECT_FALSE(next.hellos[0].refused.has_value());
}

TEST_F(TcpStreamTest, OutOfFileDescriptorsItWaitsAndThenGoesOn) {
  if (!test::NoFreeDescriptor::kNotHere.empty()) GTEST_SKIP() << test::NoFreeDescriptor::kNotHere;
  TestClient client(io_, stream_.local_endpoint());

  // No descriptor is free for the server's end of the connection.
  {
    const test::NoFreeDescriptor none;
    for (int i = 0; i < 20; ++i) {
      io_.restart();
      io_.run_one_for(10ms);
    }
    EXPECT_EQ(stream_.client_count(), 0u);
  }
  EXPECT_TRUE(turn_until([&] { return !client.hellos.empty(); }));
}

TEST_F(TcpStreamTest, ClosingEndsEveryConnection) {
  TestClient client(io_, stream_.local_endpoint());
  ASSERT_TRUE(turn_until([&] { return !client.hellos.empty(); }));
  stream_.close();
  stream_.close();
  EXPECT_EQ(stream_.client_count(), 0u);
  EXPECT_TRUE(turn_until([&] { return client.closed; }));
}

TEST_F(TcpStreamTest, AStreamMayGoWhileItsHandlersAreOnTheirWay) {
  auto other = std::make_unique<TcpStream>(io_, "127.0.0.1:0", settings());
  TestClient client(io_, other->local_endpoint());
  client.send(wire::encode(wire::Subscribe{.client = ""}));
  ASSERT_TRUE(turn_until([&] { return !client.hellos.empty(); }));
  other->publish(frame(1));
  other.reset();
  EXPECT_TRUE(turn_until([&] { return client.closed; }));
}

TEST_F(TcpStreamTest, AnAddressInUseIsNamedWithWhatToDo) {
  try {
    const TcpStream second(io_, stream_.local_endpoint(), settings());
    FAIL() << "two listen on one address";
  } catch (const FailureError& error) {
    EXPECT_EQ(error.kind(), FailureKind::kUnavailable);
    EXPECT_NE(std::string(error.what()).find(stream_.local_endpoint()), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("choose another port"), std::string::npos);
  }
}

TEST_F(TcpStreamTest, AnAddressOfAnotherMachineOrNoneIsRefused) {
  EXPECT_THROW(TcpStream(io_, "192.0.2.1:7410", settings()), FailureError);
  EXPECT_THROW(TcpStream(io_, "nonsense", settings()), FailureError);
}

TEST_F(TcpStreamTest, EveryRequestToShowASceneGetsAReply) {
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(wire::Subscribe{.poses = false, .client = "test"}));
  client.send(wire::encode(wire::Control{.scene = "meadow", .shown = false, .over_s = 1.5}));
  client.send(wire::encode(wire::Control{.scene = "bank"}));
  ASSERT_TRUE(turn_until([&] { return client.replies.size() == 2; }));
  EXPECT_EQ(client.replies[0].message, "it is done");
  ASSERT_EQ(controls_.size(), 2u);
  EXPECT_EQ(controls_[0].scene, "meadow");
  EXPECT_FALSE(controls_[0].shown);
  EXPECT_EQ(controls_[0].over_s, 1.5);
  EXPECT_TRUE(all_were_local_) << "127.0.0.1 is this machine";
}

TEST_F(TcpStreamTest, AControlBeforeTheSubscriptionIsRefused) {
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(wire::Control{.scene = "meadow"}));
  EXPECT_TRUE(turn_until([&] { return client.closed; }));
  EXPECT_TRUE(controls_.empty());
}

TEST_F(TcpStreamTest, AnInvalidControlEndsTheConnection) {
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(wire::Subscribe{.poses = false, .client = "test"}));
  client.send(wire::encode(wire::Control{.scene = "meadow", .over_s = -1.0}));
  EXPECT_TRUE(turn_until([&] { return client.closed; }));
  EXPECT_TRUE(controls_.empty());
}

}  // namespace
}  // namespace yuragi::daemon::stream
