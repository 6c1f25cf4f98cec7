#include "daemon/stream/tcp_stream.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <sstream>
#include <stdexcept>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <dirent.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/tcp.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

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
  /// `from`: the address that it connects from.
  TestClient(asio::io_context& io, const std::string& endpoint, int receive_buffer_bytes = 0,
             const char* from = "127.0.0.1")
      : socket_(io) {
    const Address address = parse_address(endpoint).value();
    socket_.open(tcp::v4());
    socket_.bind(tcp::endpoint(asio::ip::make_address(from), 0));
    if (receive_buffer_bytes > 0) socket_.set_option(asio::socket_base::receive_buffer_size(receive_buffer_bytes));
    socket_.connect(tcp::endpoint(asio::ip::make_address(address.host), address.port));
    resume();
  }
  ~TestClient() {
    boost::system::error_code ignored;
    socket_.close(ignored);
  }

  void send(const wire::Bytes& bytes) { asio::write(socket_, asio::buffer(bytes)); }

  /// The descriptor of the server's end of the connection, which is in this process, too; -1 where there is none.
  int server_end() const {
    const std::unique_ptr<DIR, int (*)(DIR*)> folder(opendir("/proc/self/fd"), closedir);
    while (const dirent* entry = readdir(folder.get())) {
      const int descriptor = std::atoi(entry->d_name);
      tcp::endpoint peer;
      auto size = static_cast<socklen_t>(peer.capacity());
      if (getpeername(descriptor, peer.data(), &size) == 0 && peer == socket_.local_endpoint()) return descriptor;
    }
    return -1;
  }

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
  wire::Frame last_frame;
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
    if (auto* one = std::get_if<wire::Frame>(&message)) last_frame = std::move(*one);
    if (auto* state = std::get_if<wire::Sensors>(&message)) sensors.push_back(*state);
    if (auto* trace = std::get_if<wire::RawTrace>(&message)) traces.push_back(*trace);
    if (auto* reply = std::get_if<wire::ControlReply>(&message)) replies.push_back(*reply);
  }

  tcp::socket socket_;
  std::shared_ptr<std::array<std::uint8_t, 65536>> chunk_ = std::make_shared<std::array<std::uint8_t, 65536>>();
  wire::MessageReader reader_;
  bool paused_ = false;
};

/// As from another machine: TcpStreamTest takes only 127.0.0.1 for its own.
class RemoteClient : public TestClient {
 public:
  RemoteClient(asio::io_context& io, const std::string& endpoint, const char* from = "127.0.0.2")
      : TestClient(io, endpoint, 0, from) {}
};

/// Keeps what is logged while it lives.
class LogCapture {
 public:
  LogCapture() : before_(spdlog::default_logger()) {
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("captured", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_)));
  }
  ~LogCapture() { spdlog::set_default_logger(before_); }
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

  std::string text() const { return text_.str(); }
  std::size_t lines() const {
    const std::string text = text_.str();
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }

 private:
  std::ostringstream text_;
  std::shared_ptr<spdlog::logger> before_;
};

class TcpStreamTest : public testing::Test {
 protected:
  TcpStreamSettings settings() {
    TcpStreamSettings settings;
    settings.hello = {.software = "test", .tick_rate_hz = 60.0};
    settings.scenes = samples::scenes();
    settings.check_every = 1ms;
    settings.now = [this] { return now_; };
    settings.is_of_this_machine = [](const std::string& address) {
      if (address == "127.0.0.66") throw std::runtime_error("of this address");
      return address == "127.0.0.1";
    };
    settings.raw_refusal = [](bool is_local) {
      return is_local ? std::nullopt : std::optional<std::string>("raw messages are not for other machines");
    };
    settings.is_token = [](const std::string& token) { return token == "a token of this wall"; };
    settings.on_control = [this](const wire::Control& control, bool is_local) {
      controls_.push_back(control);
      all_were_local_ = all_were_local_ && is_local;
      if (control.scene == "faulty") throw std::runtime_error("of this scene");
      return wire::ControlReply{.done = true, .message = "it is done", .scenes = {}};
    };
    settings.on_reload = [this](const wire::ReloadCommand& command, bool is_local, auto reply) {
      all_were_local_ = all_were_local_ && is_local;
      reloads_.emplace_back(command.file, std::move(reply));
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

  void publish_sensors() { stream_.publish_sensors(share(wire::encode(samples::sensors())), nullptr); }

  std::vector<wire::Control> controls_;
  std::vector<std::pair<std::string, std::function<void(const wire::ControlReply&)>>> reloads_;
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

SharedBytes other_scenes() {
  return share(wire::encode(wire::Scenes{{{"pond", "grass", samples::meadow(5)}}}));
}

TEST_F(TcpStreamTest, WhoeverTakesNewScenesGetsThemBeforeTheFirstFrameThatNeedsThem) {
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(wire::Subscribe{.client = "wall", .takes_new_scenes = true}));
  stream_.publish(frame(1));
  ASSERT_TRUE(turn_until([&] { return client.frames.size() == 1; }));
  stream_.publish_scenes(other_scenes());
  stream_.publish(frame(2));
  ASSERT_TRUE(turn_until([&] { return client.frames.size() == 2; }));
  EXPECT_EQ(client.kinds, (std::vector<std::size_t>{0, 2, 3, 2, 3})) << "hello, scenes, frame, scenes, frame";
  EXPECT_EQ(client.scenes[1].scenes.at(0).name, "pond");

  TestClient late(io_, stream_.local_endpoint());
  late.send(wire::encode(wire::Subscribe{.client = "late"}));
  ASSERT_TRUE(turn_until([&] { return late.frames.size() == 1; }));
  EXPECT_EQ(late.scenes.at(0).scenes.at(0).name, "pond");
  EXPECT_EQ(late.kinds, (std::vector<std::size_t>{0, 2, 3}));
}

TEST_F(TcpStreamTest, BetweenNewScenesAndTheirFirstFrameAJoinerIsNotShownAnOldFrame) {
  stream_.publish(frame(1));
  stream_.publish_scenes(other_scenes());
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(wire::Subscribe{.client = "late"}));
  ASSERT_TRUE(turn_until([&] { return client.scenes.size() == 1; }));
  stream_.publish(frame(2));
  ASSERT_TRUE(turn_until([&] { return !client.frames.empty(); }));
  EXPECT_EQ(client.frames, (std::vector<std::uint64_t>{2}));
}

TEST_F(TcpStreamTest, WhoeverDoesNotTakeNewScenesIsToldSoAndLetGoUnlessItWatchesNoPoses) {
  TestClient old(io_, stream_.local_endpoint());
  TestClient table(io_, stream_.local_endpoint());
  old.send(wire::encode(wire::Subscribe{.client = "old"}));
  table.send(wire::encode(wire::Subscribe{.poses = false, .sensors = true, .client = "table"}));
  stream_.publish(frame(1));
  publish_sensors();
  ASSERT_TRUE(turn_until([&] { return old.frames.size() == 1 && table.sensors.size() == 1; }));
  stream_.publish_scenes(other_scenes());
  stream_.publish(frame(2));
  publish_sensors();
  ASSERT_TRUE(turn_until([&] { return old.closed && table.sensors.size() == 2; }));
  ASSERT_EQ(old.hellos.size(), 2U);
  EXPECT_EQ(old.hellos[1].refused, "the scenes have changed; connect again");
  EXPECT_EQ(old.frames.size(), 1U);
  EXPECT_FALSE(table.closed);

  TestClient again(io_, stream_.local_endpoint());
  again.send(wire::encode(wire::Subscribe{.client = "old"}));
  ASSERT_TRUE(turn_until([&] { return again.frames.size() == 1; }));
  EXPECT_EQ(again.scenes.at(0).scenes.at(0).name, "pond");
}

TEST_F(TcpStreamTest, ASlowClientInTheMiddleOfAFrameFinishesItAndThenGetsTheNewScenes) {
  FrameMaker large(kManyStrands);
  TestClient slow(io_, stream_.local_endpoint(), 16384);
  TestClient old(io_, stream_.local_endpoint(), 16384);
  TestClient fast(io_, stream_.local_endpoint());
  for (TestClient* client : {&slow, &fast})
    client->send(wire::encode(wire::Subscribe{.client = "", .takes_new_scenes = true}));
  old.send(wire::encode(wire::Subscribe{.client = "old"}));
  ASSERT_TRUE(turn_until([&] { return !slow.scenes.empty() && !fast.scenes.empty() && !old.scenes.empty(); }));
  slow.pause();
  old.pause();
  constexpr std::uint64_t kFramesEach = 40;
  for (std::uint64_t i = 1; i <= kFramesEach; ++i) {
    stream_.publish(large.make(i));
    ASSERT_TRUE(turn_until([&] { return fast.frames.size() == i; })) << i;
  }
  stream_.publish_scenes(other_scenes());
  for (std::uint64_t i = kFramesEach + 1; i <= 2 * kFramesEach; ++i) {
    stream_.publish(large.make(i));
    ASSERT_TRUE(turn_until([&] { return fast.frames.size() == i; })) << i;
  }
  slow.resume();
  old.resume();
  ASSERT_TRUE(turn_until([&] { return !slow.frames.empty() && slow.frames.back() == 2 * kFramesEach && old.closed; }));

  // Of each client: which of its frames came before the second Scenes, and which behind it?
  for (const TestClient* client : {&slow, &fast}) {
    ASSERT_EQ(client->scenes.size(), 2U);
    std::size_t frame_count = 0;
    int scenes_count = 0;
    for (const std::size_t kind : client->kinds) {
      if (kind == 2) ++scenes_count;
      if (kind != 3) continue;
      EXPECT_EQ(client->frames[frame_count] > kFramesEach, scenes_count == 2);
      ++frame_count;
    }
  }
  EXPECT_LT(slow.frames.size(), 20U);
  EXPECT_LE(old.frames.back(), kFramesEach);
  EXPECT_EQ(old.hellos.back().refused, "the scenes have changed; connect again");
}

wire::Bytes subscribe_with(const char* token) {
  return wire::encode(wire::Subscribe{.sensors = true, .client = "a phone", .raw = true, .token = Secret(token)});
}

TEST_F(TcpStreamTest, WhoeverShowsTheTokenIsTreatedAsOneOfThisMachine) {
  const LogCapture log;
  RemoteClient phone(io_, stream_.local_endpoint());
  phone.send(subscribe_with("a token of this wall"));
  ASSERT_TRUE(turn_until([&] { return !phone.scenes.empty(); }));
  EXPECT_TRUE(stream_.wants_trace("roof"));
  phone.send(wire::encode(samples::control()));
  phone.send(wire::encode(wire::Control{.scene = "", .reload = wire::ReloadCommand{}}));
  ASSERT_TRUE(turn_until([&] { return phone.replies.size() == 1 && reloads_.size() == 1; }));
  EXPECT_TRUE(all_were_local_);
  publish_sensors();  // for clients of this machine alone
  ASSERT_TRUE(turn_until([&] { return phone.sensors.size() == 1; }));
  EXPECT_EQ(log.text().find("a token of"), std::string::npos) << "it is never logged";
}

TEST_F(TcpStreamTest, WhoeverShowsAWrongTokenIsToldSoAndLetGo) {
  const LogCapture log;
  RemoteClient phone(io_, stream_.local_endpoint());
  phone.send(subscribe_with("a token of that wall"));
  ASSERT_TRUE(turn_until([&] { return phone.closed; }));
  ASSERT_EQ(phone.hellos.size(), 2u);
  EXPECT_THAT(phone.hellos[1].refused.value_or(""), testing::HasSubstr("token"));
  EXPECT_TRUE(phone.scenes.empty());
  EXPECT_EQ(log.text().find("a token of"), std::string::npos);
}

TEST_F(TcpStreamTest, WithoutATokenAClientOfAnotherMachineStaysOne) {
  RemoteClient phone(io_, stream_.local_endpoint());
  phone.send(wire::encode(wire::Subscribe{.poses = false, .client = "a phone"}));
  phone.send(wire::encode(samples::control()));
  ASSERT_TRUE(turn_until([&] { return phone.replies.size() == 1; }));
  EXPECT_FALSE(all_were_local_);
}

wire::Bytes subscribe_to(const wire::Thinning& thinning, double rate_hz = 0.0) {
  return wire::encode(
      wire::Subscribe{.client = "a phone", .takes_new_scenes = true, .thinning = thinning, .rate_hz = rate_hz});
}

TEST_F(TcpStreamTest, WhoeverWantsLessGetsLessAndTheOthersAll) {
  TestClient thin(io_, stream_.local_endpoint());
  TestClient all(io_, stream_.local_endpoint());
  thin.send(subscribe_to({.scenes = {"meadow"}, .every = 4}));
  all.send(wire::encode(samples::subscribe()));
  ASSERT_TRUE(turn_until([&] { return !thin.scenes.empty() && !all.scenes.empty(); }));
  stream_.publish(share(samples::frame_bytes()));
  ASSERT_TRUE(turn_until([&] { return !thin.frames.empty() && !all.frames.empty(); }));
  ASSERT_EQ(thin.scenes[0].scenes.size(), 1u);
  EXPECT_EQ(std::get<pose::StrandSkeleton>(thin.scenes[0].scenes[0].skeleton).strand_count, 10u);
  EXPECT_TRUE(wire::fits(thin.last_frame, thin.scenes[0]));
  EXPECT_EQ(all.scenes[0].scenes.size(), 2u);
  EXPECT_TRUE(wire::fits(all.last_frame, all.scenes[0]));
}

TEST_F(TcpStreamTest, WhoeverWantsLessGetsLessOfNewScenesToo) {
  TestClient thin(io_, stream_.local_endpoint());
  thin.send(subscribe_to({.every = 2}));
  ASSERT_TRUE(turn_until([&] { return thin.scenes.size() == 1; }));
  stream_.publish_scenes(share(wire::encode(samples::all_kinds())));
  stream_.publish(share(samples::frame_of_all_kinds()));
  ASSERT_TRUE(turn_until([&] { return thin.frames.size() == 1; }));
  ASSERT_EQ(thin.scenes.size(), 2u);
  EXPECT_EQ(thin.scenes[1].scenes.size(), 5u);
  EXPECT_TRUE(wire::fits(thin.last_frame, thin.scenes[1]));
}

wire::Bytes subscribe_to_wind(double rate_hz = 0.0) {
  return wire::encode(wire::Subscribe{.poses = false, .client = "a lamp", .rate_hz = rate_hz, .wind = true});
}

TEST_F(TcpStreamTest, WhoeverWantsTheWindAloneGetsFramesWithoutScenes) {
  const LogCapture log;
  stream_.publish(frame(1));
  TestClient lamp(io_, stream_.local_endpoint());
  lamp.send(subscribe_to_wind());
  ASSERT_TRUE(turn_until([&] { return lamp.frames.size() == 1; })) << "the newest, at once";
  stream_.publish_scenes(other_scenes());
  stream_.publish(frame(2));
  ASSERT_TRUE(turn_until([&] { return lamp.frames.size() == 2; }));
  EXPECT_EQ(lamp.kinds, (std::vector<std::size_t>{0, 3, 3})) << "hello, frame, frame";
  EXPECT_TRUE(lamp.last_frame.poses.empty());
  EXPECT_NEAR(lamp.last_frame.info.wind.wind.u_m_s, samples::frame_info().wind.wind.u_m_s, 1e-6);
  EXPECT_FALSE(lamp.closed) << "new scenes are nothing to it";
  EXPECT_THAT(log.text(), testing::HasSubstr("(a lamp) subscribes to wind\n"));
}

TEST_F(TcpStreamTest, WithPosesAWishForTheWindChangesNothing) {
  TestClient wall(io_, stream_.local_endpoint());
  wall.send(wire::encode(wire::Subscribe{.client = "wall", .wind = true}));
  stream_.publish(frame(1));
  ASSERT_TRUE(turn_until([&] { return wall.frames.size() == 1; }));
  EXPECT_EQ(wall.kinds, (std::vector<std::size_t>{0, 2, 3}));
  EXPECT_FALSE(wall.last_frame.poses.empty());
}

TEST_F(TcpStreamTest, TheWindAloneKeepsItsRate) {
  TestClient lamp(io_, stream_.local_endpoint());
  TestClient fast(io_, stream_.local_endpoint());
  lamp.send(subscribe_to_wind(10.0));
  fast.send(subscribe_to_wind());
  stream_.publish(frame(1));
  ASSERT_TRUE(turn_until([&] { return lamp.frames.size() == 1 && fast.frames.size() == 1; }));
  for (std::uint64_t i = 2; i <= 60; ++i) {
    now_ += Nanoseconds(1s) / 60;
    stream_.publish(frame(i));
    ASSERT_TRUE(turn_until([&] { return fast.frames.size() == i; })) << i;
  }
  EXPECT_GE(lamp.frames.size(), 9U);
  EXPECT_LE(lamp.frames.size(), 11U);
}

TEST_F(TcpStreamTest, WhoeverNamesASceneThatDoesNotExistIsRefusedWithTheNamesThatExist) {
  for (const char* name : {"medow", "-"}) {  // "-": older programs asked for the wind alone by it
    TestClient client(io_, stream_.local_endpoint());
    client.send(subscribe_to({.scenes = {"meadow", name}}));
    ASSERT_TRUE(turn_until([&] { return client.closed; })) << name;
    ASSERT_EQ(client.hellos.size(), 2U);
    EXPECT_EQ(client.hellos[1].refused,
              "there is no scene \"" + std::string(name) + R"("; the scenes are: "meadow", "bank")");
    EXPECT_TRUE(client.scenes.empty());
  }
  TestClient table(io_, stream_.local_endpoint());
  table.send(wire::encode(
      wire::Subscribe{.poses = false, .sensors = true, .client = "table", .thinning = {.scenes = {"medow"}}}));
  publish_sensors();
  ASSERT_TRUE(turn_until([&] { return !table.sensors.empty(); })) << "without poses the names have no effect";
}

TEST_F(TcpStreamTest, WhoseSceneVanishesIsLetGoWithTheReasonAndTheOthersStay) {
  TestClient bank(io_, stream_.local_endpoint());
  TestClient meadow(io_, stream_.local_endpoint());
  TestClient both(io_, stream_.local_endpoint());
  bank.send(subscribe_to({.scenes = {"bank"}}));
  meadow.send(subscribe_to({.scenes = {"meadow"}}));
  both.send(subscribe_to({.scenes = {"meadow", "bank"}}));
  ASSERT_TRUE(turn_until([&] { return bank.scenes.size() + meadow.scenes.size() + both.scenes.size() == 3; }));
  wire::Scenes left = samples::scenes();
  left.scenes.pop_back();  // the bank
  stream_.publish_scenes(share(wire::encode(left)));
  ASSERT_TRUE(turn_until([&] { return bank.closed && both.closed && meadow.scenes.size() == 2; }));
  for (const TestClient* client : {&bank, &both}) {
    ASSERT_EQ(client->hellos.size(), 2U);
    EXPECT_EQ(client->hellos[1].refused, R"(there is no scene "bank"; the scenes are: "meadow")");
    EXPECT_EQ(client->scenes.size(), 1U);
  }
  EXPECT_FALSE(meadow.closed);
}

TEST_F(TcpStreamTest, ARateIsKeptAndTheLastFrameComesAllTheSame) {
  TestClient slow(io_, stream_.local_endpoint());
  TestClient fast(io_, stream_.local_endpoint());
  slow.send(subscribe_to({}, 10.0));
  fast.send(subscribe_to({}));
  ASSERT_TRUE(turn_until([&] { return !slow.scenes.empty() && !fast.scenes.empty(); }));
  constexpr std::uint64_t kFrames = 61;
  for (std::uint64_t i = 1; i <= kFrames; ++i) {
    stream_.publish(frame(i));
    ASSERT_TRUE(turn_until([&] { return fast.frames.size() == i; })) << i;
    now_ += Nanoseconds(1s) / 60;
  }
  now_ += 1s;  // and no frame comes: the newest is still owed
  ASSERT_TRUE(turn_until([&] { return !slow.frames.empty() && slow.frames.back() == kFrames; }));
  EXPECT_GE(slow.frames.size(), 10u);
  EXPECT_LE(slow.frames.size(), 12u);
}

TEST_F(TcpStreamTest, OneWhoWatchesSensorsOnlyGetsNoPoses) {
  stream_.publish(frame(1));
  publish_sensors();
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(wire::Subscribe{.poses = false, .sensors = true, .client = "table"}));
  ASSERT_TRUE(turn_until([&] { return client.sensors.size() == 1; }));
  stream_.publish(frame(2));
  publish_sensors();
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
  publish_sensors();
  ASSERT_TRUE(turn_until([&] { return !roof.sensors.empty() && !none.sensors.empty(); }));

  stream_.publish_trace(trace_of("mast"));
  stream_.publish_trace(samples::raw_trace());
  ASSERT_TRUE(turn_until([&] { return all.traces.size() == 2 && roof.traces.size() == 1; }));
  EXPECT_EQ(all.traces[0].sensor, "mast");
  EXPECT_EQ(roof.traces[0].sensor, "roof");
  EXPECT_EQ(roof.traces[0].bytes, samples::raw_trace().bytes);
  EXPECT_EQ(roof.traces[0].lost, 3u);
  publish_sensors();
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
  EXPECT_EQ(stream_.counts().stuck, 1U);
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
  EXPECT_EQ(stream_.counts().stuck, 0U);
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
  extra.send(wire::encode(wire::Subscribe{.client = ""}));
  ASSERT_TRUE(turn_until([&] { return extra.closed; }));
  ASSERT_EQ(extra.hellos.size(), 2u);
  EXPECT_THAT(extra.hellos[1].refused.value_or(""), testing::HasSubstr("32"));
  EXPECT_EQ(stream_.client_count(), 32u);
  EXPECT_EQ(stream_.counts().refused, 1U);

  clients.pop_front();
  ASSERT_TRUE(turn_until([&] { return stream_.client_count() == 31; }));
  TestClient next(io_, stream_.local_endpoint());
  ASSERT_TRUE(turn_until([&] { return !next.hellos.empty(); }));
  next.send(wire::encode(wire::Subscribe{.client = ""}));
  ASSERT_TRUE(turn_until([&] { return !next.scenes.empty(); }));
}

TEST_F(TcpStreamTest, AQuestionOfThisMachineHasAPlaceBesideAllOthers) {
  std::deque<TestClient> clients;
  for (int i = 0; i < 32; ++i) {
    clients.emplace_back(io_, stream_.local_endpoint());
    clients.back().send(wire::encode(wire::Subscribe{.client = ""}));
  }
  ASSERT_TRUE(turn_until([&] { return stream_.client_count() == 32; }));
  publish_sensors();

  std::deque<TestClient> asking;
  for (std::size_t i = 0; i < kPlacesForQuestions; ++i) {
    asking.emplace_back(io_, stream_.local_endpoint());
    asking.back().send(wire::encode(wire::Subscribe{.poses = false, .sensors = true, .client = "status"}));
    asking.back().send(wire::encode(wire::Control{}));
    ASSERT_TRUE(turn_until([&] { return !asking.back().sensors.empty() && asking.back().replies.size() == 1; })) << i;
  }
  TestClient one_more(io_, stream_.local_endpoint());
  ASSERT_TRUE(turn_until([&] { return one_more.closed; }));
  EXPECT_THAT(one_more.hellos.at(0).refused.value_or(""), testing::HasSubstr("32"));

  now_ += kQuestionsFor;
  ASSERT_TRUE(turn_until([&] { return std::ranges::all_of(asking, &TestClient::closed); }));
  EXPECT_THAT(asking[0].hellos.at(1).refused.value_or(""), testing::HasSubstr("60 s"));
  EXPECT_EQ(stream_.client_count(), 32U);
  EXPECT_EQ(stream_.counts().idle, 0U);
}

TEST_F(TcpStreamTest, OutOfFileDescriptorsItWaitsAndThenGoesOn) {
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

TEST_F(TcpStreamTest, ARequestThatThrowsEndsItsConnectionOnly) {
  TestClient other(io_, stream_.local_endpoint());
  other.send(wire::encode(wire::Subscribe{.client = "other"}));
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(wire::Subscribe{.poses = false, .client = "unlucky"}));
  client.send(wire::encode(wire::Control{.scene = "faulty"}));
  ASSERT_TRUE(turn_until([&] { return client.closed; }));
  stream_.publish(frame(1));
  ASSERT_TRUE(turn_until([&] { return other.frames.size() == 1; }));
  EXPECT_EQ(stream_.client_count(), 1u);
}

TEST_F(TcpStreamTest, AClientThatCannotBeWelcomedKeepsNobodyOut) {
  TestClient unwelcome(io_, stream_.local_endpoint(), 0, "127.0.0.66");
  ASSERT_TRUE(turn_until([&] { return unwelcome.closed; }));
  TestClient client(io_, stream_.local_endpoint());
  ASSERT_TRUE(turn_until([&] { return !client.hellos.empty(); }));
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

TEST_F(TcpStreamTest, AReloadIsAnsweredWhenItIsDoneAndHoldsUpNothingMeanwhile) {
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(wire::Subscribe{.poses = false, .client = "test"}));
  client.send(wire::encode(wire::Control{.scene = "", .reload = wire::ReloadCommand{"/etc/wall.toml"}}));
  client.send(wire::encode(wire::Control{.scene = "meadow"}));
  ASSERT_TRUE(turn_until([&] { return client.replies.size() == 1; }));
  EXPECT_EQ(client.replies[0].message, "it is done") << "the other request was answered first";
  ASSERT_EQ(reloads_.size(), 1U);
  EXPECT_EQ(reloads_[0].first, "/etc/wall.toml");
  EXPECT_TRUE(all_were_local_);
  reloads_[0].second({.done = true, .message = "read again", .scenes = {}});
  ASSERT_TRUE(turn_until([&] { return client.replies.size() == 2; }));
  EXPECT_EQ(client.replies[1].message, "read again");
}

TEST_F(TcpStreamTest, AClientThatHasGoneNeedsNoReply) {
  {
    TestClient client(io_, stream_.local_endpoint());
    client.send(wire::encode(wire::Subscribe{.poses = false, .client = "test"}));
    client.send(wire::encode(wire::Control{.scene = "", .reload = wire::ReloadCommand{}}));
    ASSERT_TRUE(turn_until([&] { return reloads_.size() == 1; }));
  }
  ASSERT_TRUE(turn_until([&] { return stream_.client_count() == 0; }));
  reloads_[0].second({.done = true, .message = "read again", .scenes = {}});
}

TEST_F(TcpStreamTest, FewerPlacesAreForThoseWhoComeFromThenOn) {
  TestClient first(io_, stream_.local_endpoint());
  ASSERT_TRUE(turn_until([&] { return stream_.client_count() == 1; }));
  stream_.set_admission({.max_clients = 1, .max_clients_per_address = 1});
  TestClient second(io_, stream_.local_endpoint());
  second.send(wire::encode(wire::Subscribe{.client = ""}));
  ASSERT_TRUE(turn_until([&] { return second.closed; }));
  EXPECT_FALSE(first.closed);
  EXPECT_EQ(stream_.counts().refused, 1U);
}

// ---- clients that take places and log ----

TEST_F(TcpStreamTest, TheKernelAsksWhetherAClientIsStillThere) {
  TestClient client(io_, stream_.local_endpoint());
  ASSERT_TRUE(turn_until([&] { return !client.hellos.empty(); }));
  const int server_end = client.server_end();
  ASSERT_GE(server_end, 0);
  const auto option = [server_end](int level, int name) {
    int value = -1;
    socklen_t size = sizeof value;
    EXPECT_EQ(getsockopt(server_end, level, name, &value, &size), 0);
    return value;
  };
  EXPECT_EQ(option(SOL_SOCKET, SO_KEEPALIVE), 1);
  EXPECT_EQ(option(IPPROTO_TCP, TCP_KEEPIDLE), 30);
  EXPECT_EQ(option(IPPROTO_TCP, TCP_KEEPINTVL), 10);
  EXPECT_EQ(option(IPPROTO_TCP, TCP_KEEPCNT), 3);
  EXPECT_EQ(option(IPPROTO_TCP, TCP_USER_TIMEOUT), 60'000) << "also while something is on its way to it";
}

TEST_F(TcpStreamTest, AClientThatAsksForNothingIsToldSoAndLetGo) {
  TestClient idle(io_, stream_.local_endpoint());
  TestClient watching(io_, stream_.local_endpoint());
  TestClient asking(io_, stream_.local_endpoint());
  idle.send(wire::encode(wire::Subscribe{.poses = false, .client = "idle"}));
  watching.send(wire::encode(wire::Subscribe{.client = "watching"}));
  asking.send(wire::encode(wire::Subscribe{.poses = false, .client = "asking"}));
  asking.send(wire::encode(wire::Control{}));
  ASSERT_TRUE(turn_until([&] { return !watching.scenes.empty() && asking.replies.size() == 1; }));
  now_ += 9min;
  asking.send(wire::encode(wire::Control{}));
  ASSERT_TRUE(turn_until([&] { return asking.replies.size() == 2; }));
  EXPECT_EQ(stream_.client_count(), 3U);

  now_ += 1min;
  ASSERT_TRUE(turn_until([&] { return idle.closed; }));
  ASSERT_EQ(idle.hellos.size(), 2U);
  EXPECT_THAT(idle.hellos[1].refused.value_or(""), testing::HasSubstr("10 min"));
  EXPECT_FALSE(asking.closed);
  EXPECT_FALSE(watching.closed);
  EXPECT_EQ(stream_.client_count(), 2U);
}

TEST_F(TcpStreamTest, AnotherMachineHasItsShareOfThePlacesAndThisOneItsOwn) {
  std::deque<TestClient> clients;
  const auto connect = [&](const char* from) {
    clients.emplace_back(io_, stream_.local_endpoint(), 0, from);
    clients.back().send(wire::encode(wire::Subscribe{.poses = false, .client = ""}));
    EXPECT_TRUE(turn_until([&] { return !clients.back().hellos.empty(); }));
    return clients.back().hellos[0].refused.value_or("welcome");
  };
  for (const char* from : {"127.0.0.2", "127.0.0.3", "127.0.0.4"}) {
    for (int i = 0; i < 8; ++i) EXPECT_EQ(connect(from), "welcome");
    EXPECT_THAT(connect(from), testing::HasSubstr("the maximum number of clients from " + std::string(from)));
  }
  for (int i = 0; i < 4; ++i) EXPECT_EQ(connect("127.0.0.5"), "welcome");
  EXPECT_EQ(stream_.client_count(), 28U);
  EXPECT_THAT(connect("127.0.0.6"), testing::HasSubstr("the daemon's own machine"));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(connect("127.0.0.1"), "welcome");
  for (std::size_t i = 0; i < kPlacesForQuestions; ++i) EXPECT_EQ(connect("127.0.0.1"), "welcome");
  EXPECT_THAT(connect("127.0.0.1"), testing::HasSubstr("32"));
  EXPECT_EQ(stream_.counts().refused, 5U);
  EXPECT_EQ(stream_.counts().idle, 0U);

  // And in time they lose the places that they do not use.
  now_ += 10min;
  EXPECT_TRUE(turn_until([&] { return stream_.client_count() == 0; }));
  EXPECT_EQ(stream_.counts().idle, 32U);
  EXPECT_EQ(stream_.counts().stuck, 0U);
}

TEST_F(TcpStreamTest, RawMessagesAreRefusedToWhoeverMayNotHaveThem) {
  RemoteClient remote(io_, stream_.local_endpoint());
  remote.send(wire::encode(wire::Subscribe{.poses = false, .sensors = true, .client = "", .raw = true}));
  ASSERT_TRUE(turn_until([&] { return remote.closed; }));
  ASSERT_EQ(remote.hellos.size(), 2U);
  EXPECT_EQ(remote.hellos[1].refused, "raw messages are not for other machines");
  EXPECT_FALSE(stream_.wants_trace("roof"));

  RemoteClient without(io_, stream_.local_endpoint());
  without.send(wire::encode(wire::Subscribe{.poses = false, .sensors = true, .client = ""}));
  TestClient local(io_, stream_.local_endpoint());
  local.send(wire::encode(wire::Subscribe{.poses = false, .client = "", .raw = true}));
  ASSERT_TRUE(turn_until([&] { return stream_.wants_trace("roof"); }));
  EXPECT_FALSE(without.closed);
}

TEST_F(TcpStreamTest, OtherMachinesGetAStateOfTheSensorsOfTheirOwn) {
  const auto sensors_with = [](const char* detail) {
    wire::Sensors sensors = samples::sensors();
    sensors.sensors[0].detail = detail;
    return share(wire::encode(sensors));
  };
  TestClient local(io_, stream_.local_endpoint());
  local.send(wire::encode(wire::Subscribe{.poses = false, .sensors = true, .client = ""}));
  stream_.publish_sensors(sensors_with("here"), nullptr);
  ASSERT_TRUE(turn_until([&] { return local.sensors.size() == 1; }));
  EXPECT_FALSE(stream_.has_untrusted_clients());

  // Who comes from there waits for the first that is made for it.
  {
    RemoteClient remote(io_, stream_.local_endpoint());
    remote.send(wire::encode(wire::Subscribe{.poses = false, .sensors = true, .client = ""}));
    remote.send(wire::encode(wire::Control{}));
    ASSERT_TRUE(turn_until([&] { return remote.replies.size() == 1; }));
    EXPECT_TRUE(stream_.has_untrusted_clients());
    EXPECT_TRUE(remote.sensors.empty());
    EXPECT_FALSE(all_were_local_);
    stream_.publish_sensors(sensors_with("here"), sensors_with("elsewhere"));
    ASSERT_TRUE(turn_until([&] { return local.sensors.size() == 2 && remote.sensors.size() == 1; }));
    EXPECT_EQ(remote.sensors[0].sensors[0].detail, "elsewhere");
    RemoteClient late(io_, stream_.local_endpoint());
    late.send(wire::encode(wire::Subscribe{.poses = false, .sensors = true, .client = ""}));
    ASSERT_TRUE(turn_until([&] { return late.sensors.size() == 1; }));
    EXPECT_EQ(late.sensors[0].sensors[0].detail, "elsewhere");
  }
  for (const wire::Sensors& sensors : local.sensors) EXPECT_EQ(sensors.sensors[0].detail, "here");
  EXPECT_TRUE(turn_until([&] { return !stream_.has_untrusted_clients(); }));
}

TEST_F(TcpStreamTest, KnowsTheMostThatAPartOfAWallGivesUp) {
  TestClient left(io_, stream_.local_endpoint());
  left.send(wire::encode(wire::Subscribe{.sensors = true, .client = ""}));
  EXPECT_EQ(stream_.given_up(), 0);
  {
    RemoteClient right(io_, stream_.local_endpoint());
    right.send(wire::encode(wire::Subscribe{.sensors = true, .client = ""}));
    right.send(wire::encode(wire::Display{.given_up = 4}));
    left.send(wire::encode(wire::Display{.given_up = 1}));
    ASSERT_TRUE(turn_until([&] { return stream_.given_up() == 4; }));
    right.send(wire::encode(wire::Display{.given_up = 0}));
    ASSERT_TRUE(turn_until([&] { return stream_.given_up() == 1; }));
    right.send(wire::encode(wire::Display{.given_up = 200}));
    ASSERT_TRUE(turn_until([&] { return stream_.given_up() == 200; }));
  }
  EXPECT_TRUE(turn_until([&] { return stream_.given_up() == 1; })) << "what is gone gives up nothing";
  EXPECT_FALSE(left.closed);
}

TEST_F(TcpStreamTest, KnowsTheClientWhoseClockIsFarthestFromUtc) {
  TestClient left(io_, stream_.local_endpoint());
  left.send(wire::encode(wire::Subscribe{.sensors = true, .client = ""}));
  left.send(wire::encode(wire::Display{.clock_offset_s = 0.002}));
  ASSERT_TRUE(turn_until([&] { return stream_.worst_clock().has_value(); }));
  {
    RemoteClient right(io_, stream_.local_endpoint());
    right.send(wire::encode(wire::Subscribe{.sensors = true, .client = ""}));
    right.send(wire::encode(wire::Display{.given_up = 1, .clock_offset_s = -0.03}));
    ASSERT_TRUE(turn_until([&] { return stream_.worst_clock()->offset_s == -0.03; }));
    EXPECT_NE(stream_.worst_clock()->client, "");
  }
  ASSERT_TRUE(turn_until([&] { return stream_.worst_clock()->offset_s == 0.002; })) << "what is gone has no clock";
  left.send(wire::encode(wire::Display{}));
  EXPECT_TRUE(turn_until([&] { return !stream_.worst_clock(); }));
}

TEST_F(TcpStreamTest, ADisplayBeforeTheSubscriptionEndsTheConnection) {
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(wire::Display{.given_up = 4}));
  EXPECT_TRUE(turn_until([&] { return client.closed; }));
  EXPECT_EQ(stream_.given_up(), 0);
}

TEST_F(TcpStreamTest, OnlyLoopbackIsThisMachine) {
  for (const char* address : {"127.0.0.1", "127.8.9.10", "::1", "::ffff:127.0.0.1"}) {
    EXPECT_TRUE(TcpStreamSettings::is_loopback(address)) << address;
  }
  for (const char* address : {"10.0.0.1", "::ffff:10.0.0.1", "fe80::1", "::", "0.0.0.0", "nonsense", ""}) {
    EXPECT_FALSE(TcpStreamSettings::is_loopback(address)) << address;
  }
}

TEST_F(TcpStreamTest, WhatAClientCallsItselfIsCutAndCleanInTheLog) {
  const LogCapture log;
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(wire::Subscribe{.client = "a\x1b[2J\xff\xfe" + std::string(900, 'x')}));
  ASSERT_TRUE(turn_until([&] { return !client.scenes.empty(); }));
  EXPECT_THAT(log.text(), testing::HasSubstr("(a?[2J??xxx"));
  EXPECT_THAT(log.text(), testing::Not(testing::HasSubstr(std::string(64, 'x'))));
  EXPECT_THAT(log.text(), testing::Not(testing::HasSubstr("\xff")));
}

TEST_F(TcpStreamTest, ClientsCannotFillTheLog) {
  const LogCapture log;
  TestClient client(io_, stream_.local_endpoint());
  client.send(wire::encode(wire::Subscribe{.poses = false, .client = "flood"}));
  for (std::size_t i = 1; i <= 2000; ++i) {
    client.send(wire::encode(wire::Control{.scene = std::string(1000, 'x')}));
    ASSERT_TRUE(turn_until([&] { return client.replies.size() == i; }));
  }
  EXPECT_LT(log.lines(), 100U);
  EXPECT_GT(log.lines(), 10U) << "usual traffic is logged";
  EXPECT_THAT(log.text(), testing::Not(testing::HasSubstr("left out")));

  // What was left out is told in one line, once.
  now_ += 10s;
  ASSERT_TRUE(turn_until([&] { return log.text().find("left out") != std::string::npos; }));
  const std::size_t lines = log.lines();
  TestClient next(io_, stream_.local_endpoint());
  ASSERT_TRUE(turn_until([&] { return !next.hellos.empty(); }));
  EXPECT_EQ(log.lines(), lines + 1);
}

}  // namespace
}  // namespace yuragi::daemon::stream
