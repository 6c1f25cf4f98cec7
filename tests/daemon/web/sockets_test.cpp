// WebSockets by real connections to the loopback, with Beast's client. The server works on its own thread: a test waits
// for messages, and for the end of a connection.
#include "daemon/web/sockets.hpp"

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/web/web_server.hpp"
#include "engine/base/address.hpp"
#include "tests/engine/wire/samples.hpp"

namespace yuragi::daemon::web {
namespace {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::asio::ip::tcp;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using namespace std::chrono_literals;

constexpr double kTick_s = 1.0 / 64.0;

struct Received {
  bool is_text = false;
  std::string bytes;
};

tcp::endpoint endpoint_of(const Server& server) {
  const Address address = parse_address(server.local_endpoint()).value();
  return {boost::asio::ip::make_address(address.host), address.port};
}

/// A page's WebSocket.
class Socket {
 public:
  explicit Socket(const Server& server, std::vector<std::pair<std::string, std::string>> fields = {},
                  int receive_buffer_bytes = 0) {
    tcp::socket& socket = stream_.next_layer();
    socket.open(tcp::v4());
    if (receive_buffer_bytes > 0) socket.set_option(tcp::socket::receive_buffer_size(receive_buffer_bytes));
    socket.connect(endpoint_of(server));
    stream_.set_option(websocket::stream_base::decorator([fields](websocket::request_type& request) {
      for (const auto& [name, value] : fields) request.set(name, value);
    }));
    websocket::response_type response;
    boost::system::error_code error;
    stream_.handshake(response, server.local_endpoint(), "/ws", error);
    status_ = response.result_int();
  }

  /// Of the answer to the request: 101 if it is open.
  unsigned status() const { return status_; }
  void send(const std::string& text) {
    stream_.text(true);
    stream_.write(boost::asio::buffer(text));
  }
  void send_binary(const wire::Bytes& bytes) {
    stream_.binary(true);
    stream_.write(boost::asio::buffer(bytes));
  }
  Received receive() {
    beast::flat_buffer buffer;
    stream_.read(buffer);
    return {stream_.got_text(), beast::buffers_to_string(buffer.data())};
  }
  json receive_json() { return json::parse(receive().bytes); }
  wire::Message receive_message() {
    const Received received = receive();
    EXPECT_FALSE(received.is_text);
    const auto* const begin = reinterpret_cast<const std::uint8_t*>(received.bytes.data());
    return wire::decode(std::span(begin, received.bytes.size())).value();
  }
  /// Sends what it wants, and waits until the server has taken it, which it answers with Hello and the scenes.
  void ask(json wish) {
    if (!wish.contains("stream")) wish["stream"] = json::object();
    send(wish.dump());
    EXPECT_EQ(std::get<wire::Hello>(receive_message()).wind_from_deg, 225.0);
    EXPECT_TRUE(std::holds_alternative<wire::Scenes>(receive_message()));
  }
  /// Why the server closes it.
  std::pair<unsigned, std::string> reason() {
    boost::system::error_code error;
    while (!error) {
      beast::flat_buffer buffer;
      stream_.read(buffer, error);
    }
    const auto text = stream_.reason().reason;
    return {stream_.reason().code, {text.data(), text.size()}};
  }
  /// Reads bytes, and answers no ping, until the server closes the connection.
  void read_without_answers() {
    std::string bytes;
    boost::system::error_code error;
    boost::asio::read(stream_.next_layer(), boost::asio::dynamic_buffer(bytes), error);
    EXPECT_TRUE(error.failed());
  }

 private:
  boost::asio::io_context io_;
  websocket::stream<tcp::socket, false> stream_{io_};
  unsigned status_ = 0;
};

stream::SharedBytes share(wire::Bytes bytes) {
  return std::make_shared<const wire::Bytes>(std::move(bytes));
}

class SocketsTest : public testing::Test {
 protected:
  /// Its 96 places, unless the test chooses others.
  void start(Settings settings = {}) {
    settings.listen = "127.0.0.1:0";
    settings.hello.tick_rate_hz = 1.0 / kTick_s;
    settings.hello.wind_from_deg = 225.0;
    server_ = std::make_unique<Server>(std::move(settings));
    server_->publish_scenes(share(wire::encode(samples::scenes())));
  }
  std::shared_ptr<values::Moment> moment(int tick) const {
    auto made = std::make_shared<values::Moment>();
    made->tick = static_cast<std::uint64_t>(tick);
    made->time_s = tick * kTick_s;
    made->mono = MonoTime(from_seconds(made->time_s));
    made->utc = UtcTime(1'800'000'000'123ms);
    made->source = wind::Source::kLive;
    made->shaped[values::Quantity::kSpeed] = 4.5;
    made->names = std::make_shared<const values::Names>(values::Names{.sensors = {}, .places = places_, .scenes = {}});
    made->shaped_places.resize(places_.size());
    return made;
  }
  void publish(int tick) { server_->publish_moment(moment(tick)); }

  std::vector<std::string> places_ = {"door \"1\""};
  std::unique_ptr<Server> server_;
};

TEST_F(SocketsTest, TheWindWithItsPlaces) {
  start();
  Socket page(*server_);
  ASSERT_EQ(page.status(), 101U);
  page.ask({{"wind", 64}, {"places", {"door \"1\"", "nowhere"}}});
  publish(32);
  const Received received = page.receive();
  EXPECT_TRUE(received.is_text);
  const json message = json::parse(received.bytes);
  EXPECT_EQ(message["t"], 0.5);
  EXPECT_EQ(message["utc"], "2027-01-15T08:00:00.123Z");
  EXPECT_EQ(message["wind"]["speed"], 4.5);
  EXPECT_EQ(message["wind"]["source"], "live");
  EXPECT_EQ(message["wind"].size(), values::kQuantityCount + 1);
  EXPECT_EQ(message["places"]["door \"1\""]["gust_norm"], 0.0);
  EXPECT_TRUE(message["places"]["nowhere"].is_null());
}

TEST_F(SocketsTest, EachGetsItsRate_AndAtMostTheTicks) {
  start();
  Socket slow(*server_);
  Socket half(*server_);
  Socket all(*server_);  // the last: if it has a moment, the others were offered it before
  slow.ask({{"wind", 1}});
  half.ask({{"wind", 32}});
  all.ask({{"wind", 240}});
  for (int tick = 0; tick < 128; ++tick) {
    publish(tick);
    EXPECT_EQ(all.receive_json()["t"], tick * kTick_s);
  }
  for (int tick = 0; tick < 128; tick += 2) EXPECT_EQ(half.receive_json()["t"], tick * kTick_s);
  for (int tick = 0; tick < 128; tick += 64) EXPECT_EQ(slow.receive_json()["t"], tick * kTick_s);
}

TEST_F(SocketsTest, AMomentIsNotTouchedWhileNobodyWantsIt) {
  start();
  Socket page(*server_);
  page.ask({{"status", 1}});
  const auto unwanted = moment(1);
  server_->publish_moment(unwanted);
  EXPECT_EQ(unwanted.use_count(), 1);
}

TEST_F(SocketsTest, ASlowReaderLosesMomentsButNeverTheLast_AndDelaysNobody) {
  for (int i = 0; i < 64; ++i) places_.push_back("place " + std::to_string(i));
  start({.sockets = {.stuck_after = 60s}});
  Socket slow(*server_, {}, 4096);
  Socket quick(*server_);
  slow.ask({{"wind", 64}, {"places", std::vector(places_.begin(), places_.begin() + 64)}});
  quick.ask({{"wind", 64}});
  constexpr int kMoments = 400;  // of 13 kB
  for (int tick = 0; tick < kMoments; ++tick) {
    publish(tick);
    EXPECT_EQ(quick.receive_json()["t"], tick * kTick_s);
  }
  int count = 1;
  double before = -1.0, time = slow.receive_json()["t"];
  for (; time < (kMoments - 1) * kTick_s; ++count) {
    EXPECT_GT(time, std::exchange(before, time));
    time = slow.receive_json()["t"];
  }
  EXPECT_LT(count, kMoments);
}

TEST_F(SocketsTest, TheStreamsOwnMessages_AndNewScenesBeforeTheirFrames) {
  start();
  Socket page(*server_);
  page.ask({{"stream", {{"scenes", {samples::scenes().scenes[0].name}}, {"every", 2}}}});
  server_->publish(share(samples::frame_bytes()));
  EXPECT_EQ(std::get<wire::Frame>(page.receive_message()).poses.size(), 1U);
  server_->publish_scenes(share(wire::encode(samples::scenes())));
  server_->publish(share(samples::frame_bytes()));
  EXPECT_EQ(std::get<wire::Scenes>(page.receive_message()).scenes.size(), 1U);
  EXPECT_EQ(std::get<wire::Frame>(page.receive_message()).poses.size(), 1U);
  server_->publish_scenes(share(wire::encode(wire::Scenes{})));
  EXPECT_THAT(page.reason(), testing::Pair(1008U, HasSubstr("there are no scenes")));
}

TEST_F(SocketsTest, ASubscribeOfTheStreamAsABinaryMessage) {
  start();
  server_->publish_sensors(share(wire::encode(samples::sensors())), nullptr);
  Socket page(*server_);
  wire::Bytes wish = wire::encode(wire::Subscribe{.sensors = true, .client = "page"});
  wish.erase(wish.begin(), wish.begin() + wire::kSizePrefixBytes);
  page.send_binary(wish);
  EXPECT_TRUE(std::holds_alternative<wire::Hello>(page.receive_message()));
  EXPECT_TRUE(std::holds_alternative<wire::Scenes>(page.receive_message()));
  EXPECT_TRUE(std::holds_alternative<wire::Sensors>(page.receive_message()));
  server_->publish_scenes(share(wire::encode(samples::scenes())));
  EXPECT_THAT(page.reason(), testing::Pair(1008U, HasSubstr("connect again"))) << "it does not take new scenes";
}

TEST_F(SocketsTest, TheState) {
  start();
  Socket page(*server_);
  page.ask({{"status", 2}});
  wire::Sensors sensors;
  sensors.sensors.emplace_back().name = "roof";
  server_->publish_sensors(share(wire::encode(sensors)), nullptr);
  EXPECT_EQ(page.receive_json()["status"]["sensors"][0]["name"], "roof");
}

TEST_F(SocketsTest, WhatIsNotUnderstoodIsRefusedWithItsReason) {
  start();
  const auto refusal = [this](const std::string& text) {
    Socket page(*server_);
    page.send(text);
    return page.reason();
  };
  using testing::Pair;
  EXPECT_THAT(refusal("{"), Pair(1007U, HasSubstr("JSON")));
  EXPECT_THAT(refusal(R"({"wind": 241})"), Pair(1007U, HasSubstr("wind: must be a number from 0 to 240")));
  EXPECT_THAT(refusal(R"({"wnd": 60})"), Pair(1007U, HasSubstr("wnd: is not known here")));
  EXPECT_THAT(refusal(R"({"stream": {"every": 0}})"), Pair(1007U, HasSubstr("stream: every: must be")));
  EXPECT_THAT(refusal(R"({"stream": {"scenes": ["moon"]}})"), Pair(1008U, HasSubstr("there is no scene \"moon\"")));
  EXPECT_THAT(refusal("{\"\xff\": 1}").first, 1007U) << "not UTF-8";
  EXPECT_THAT(refusal(std::string(4097, ' ')).first, 1009U);

  Socket binary(*server_);
  binary.send_binary({1, 2, 3});
  EXPECT_THAT(binary.reason(), Pair(1007U, HasSubstr("not a message")));
  Socket control(*server_);
  wire::Bytes bytes = wire::encode(wire::Control{.scene = "meadow"});
  bytes.erase(bytes.begin(), bytes.begin() + wire::kSizePrefixBytes);
  control.send_binary(bytes);
  EXPECT_THAT(control.reason(), Pair(1008U, HasSubstr("only Subscribe")));
  Socket twice(*server_);
  twice.ask({{"stream", json::object()}});
  twice.send(R"({"stream": {}})");
  EXPECT_THAT(twice.reason(), Pair(1008U, HasSubstr("already")));
}

TEST_F(SocketsTest, AWishReplacesTheOneBefore) {
  start();
  Socket page(*server_);
  page.ask({{"wind", 64}});
  publish(0);
  EXPECT_TRUE(page.receive_json()["places"].empty());
  page.send(json({{"wind", 64}, {"places", places_}}).dump());
  json places;
  for (int tick = 1; !places.contains(places_[0]); ++tick) {
    publish(tick);
    places = page.receive_json()["places"];
  }
}

TEST_F(SocketsTest, OtherOriginsAreRefusedUnlessTheyAreListed) {
  start({.hosts = {"roof"}, .origins = {"https://editor.p5js.org"}});
  EXPECT_EQ(Socket(*server_, {{"Origin", "http://" + server_->local_endpoint()}}).status(), 101U);
  EXPECT_EQ(Socket(*server_, {{"Origin", "https://editor.p5js.org"}}).status(), 101U);
  for (const char* const origin : {"http://evil.example", "null", "https://editor.p5js.org.evil.example"})
    EXPECT_EQ(Socket(*server_, {{"Origin", origin}}).status(), 403U) << origin;
  EXPECT_EQ(Socket(*server_, {{"Host", "evil.example"}}).status(), 421U);
  EXPECT_EQ(Socket(*server_, {{"Host", "roof"}, {"Origin", "http://roof"}}).status(), 101U);
}

TEST_F(SocketsTest, WhereReadingTakesTheTokenSoDoesAWebSocket) {
  start({.takes_token = true, .token = Secret("correct horse battery staple"), .reading_takes_token = true});
  EXPECT_EQ(Socket(*server_).status(), 401U);
  EXPECT_EQ(Socket(*server_, {{"Authorization", "Bearer wrong"}}).status(), 401U);
  EXPECT_EQ(Socket(*server_, {{"Authorization", "Bearer correct horse battery staple"}}).status(), 101U);
}

TEST_F(SocketsTest, PlacesAreTheirOwnAndBounded_AndComeBack) {
  start({.clients = {.max_clients = 1}, .sockets = {.places = {.max_clients = 3}}});
  std::vector<std::unique_ptr<Socket>> pages;
  for (int i = 0; i < 3; ++i) {
    pages.push_back(std::make_unique<Socket>(*server_));
    EXPECT_EQ(pages.back()->status(), 101U);
  }
  EXPECT_EQ(Socket(*server_).status(), 503U);
  pages.pop_back();
  unsigned status = 0;
  for (const auto hangs = std::chrono::steady_clock::now() + 60s;
       status != 101U && std::chrono::steady_clock::now() < hangs;)
    status = Socket(*server_).status();
  EXPECT_EQ(status, 101U);
}

TEST_F(SocketsTest, PagesThatOpenAtOnceTakeNoPlacesOfHttp) {
  start({.clients = {.max_clients = 1}, .sockets = {.places = {.max_clients = 3}}});
  boost::asio::io_context io;
  std::vector<tcp::socket> without_a_request;
  for (int i = 0; i < 20; ++i) without_a_request.emplace_back(io).connect(endpoint_of(*server_));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(Socket(*server_).status(), 101U);
}

TEST_F(SocketsTest, WhoAnswersNoPingHasToGo) {
  start({.sockets = {.silent_after = 50ms, .wish_within = 60s}});
  Socket page(*server_);
  ASSERT_EQ(page.status(), 101U);
  page.read_without_answers();
}
TEST_F(SocketsTest, WhoAsksForNothingHasToGo) {
  start({.sockets = {.wish_within = 50ms, .check_every = 10ms}});
  Socket page(*server_);
  page.send("{}");
  EXPECT_THAT(page.reason(), testing::Pair(1008U, HasSubstr("asked for nothing")));
}
TEST_F(SocketsTest, WhoSendsAFloodHasToGo) {
  start({.sockets = {.check_every = 60s}});
  Socket page(*server_);
  for (int i = 0; i < 33; ++i) page.send("{}");
  EXPECT_THAT(page.reason(), testing::Pair(1008U, HasSubstr("too many messages")));
}
TEST_F(SocketsTest, EndsWithTheServer) {
  start();
  Socket page(*server_);
  page.ask({{"wind", 64}});
  server_.reset();
  page.read_without_answers();
}

}  // namespace
}  // namespace yuragi::daemon::web
