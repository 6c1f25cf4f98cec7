// [osc_query] by real connections to the loopback. The feed works while moments are sent to it: a thread does that, and
// a test waits for answers.
#include "daemon/feeds/osc_query_feed.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/feeds/osc_addresses.hpp"
#include "drivers/bus/osc_message.hpp"
#include "engine/base/address.hpp"

namespace yuragi::daemon::feeds {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using drivers::bus::OscMessage;
using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;
using values::Quantity;

std::shared_ptr<const values::Names> names_of(std::vector<std::string> places) {
  return std::make_shared<const values::Names>(
      values::Names{.sensors = {"roof"}, .places = std::move(places), .scenes = {"meadow"}});
}

/// A feed, and the thread that sends it moments: a tick each millisecond.
class Running {
 public:
  explicit Running(const settings::feeds::OscQuery& config)
      : feed_(make_osc_query_feed(config, {})), thread_([this] { run(); }) {}
  ~Running() {
    is_ending_ = true;
    thread_.join();
  }

  /// Between two ticks.
  template <class Work>
  auto between(const Work& work) {
    const std::lock_guard lock(mutex_);
    return work(moment_);
  }
  Status status() {
    const std::lock_guard lock(mutex_);
    return feed_->status();
  }
  void wait_until(const std::function<bool(const Status&)>& holds) {
    while (!holds(status())) std::this_thread::yield();
  }
  tcp::endpoint endpoint() {
    wait_until([](const Status& status) { return !status.target.ends_with(":0"); });
    const Address address = parse_address(status().target).value();
    return {asio::ip::make_address(address.host), address.port};
  }

 private:
  void run() {
    for (int tick = 0; !is_ending_; ++tick) {
      {
        const std::lock_guard lock(mutex_);
        moment_.time_s = tick * 0.1;
        moment_.mono = MonoTime(from_seconds(moment_.time_s));
        for (const Quantity quantity : {Quantity::kSpeed, Quantity::kU, Quantity::kGust})
          moment_.shaped[quantity] = tick;
        feed_->send(moment_);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  static values::Moment first_moment() {
    values::Moment moment;
    moment.names = names_of({"door"});
    moment.sensors.resize(1);
    moment.shaped_places.resize(1);
    moment.opacities = {1.0};
    return moment;
  }

  std::mutex mutex_;
  values::Moment moment_ = first_moment();
  std::unique_ptr<Feed> feed_;
  std::atomic<bool> is_ending_ = false;
  std::thread thread_;
};

const settings::feeds::OscQuery kConfig{.listen = "127.0.0.1:0", .name = "hall"};

/// Sends bytes and reads until the server closes the connection.
std::string answer_to(Running& running, const std::string& request) {
  asio::io_context io;
  tcp::socket socket(io);
  socket.connect(running.endpoint());
  asio::write(socket, asio::buffer(request));
  std::string bytes;
  boost::system::error_code closed;
  asio::read(socket, asio::dynamic_buffer(bytes), closed);
  return bytes;
}

std::string get(Running& running, const std::string& target, const std::string& fields = "Host: 127.0.0.1\r\n") {
  return answer_to(running, "GET " + target + " HTTP/1.1\r\nConnection: close\r\n" + fields + "\r\n");
}

class Listener {
 public:
  explicit Listener(Running& running, int receive_buffer_bytes = 1 << 16) {
    stream_.next_layer().open(tcp::v4());
    stream_.next_layer().set_option(tcp::socket::receive_buffer_size(receive_buffer_bytes));
    stream_.next_layer().connect(running.endpoint());
    stream_.handshake("127.0.0.1", "/");
  }

  void send(const json& command) { send_text(command.dump()); }
  void send_text(const std::string& text) {
    stream_.text(true);
    stream_.write(asio::buffer(text));
  }
  void send_binary(const std::vector<std::uint8_t>& bytes) {
    stream_.binary(true);
    stream_.write(asio::buffer(bytes));
  }
  /// The next frame.
  std::string receive() {
    beast::flat_buffer buffer;
    stream_.read(buffer);
    return beast::buffers_to_string(buffer.data());
  }
  OscMessage receive_message() {
    const std::string bytes = receive();
    EXPECT_TRUE(stream_.got_binary());
    const auto* const begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
    return drivers::bus::decode_osc(std::span(begin, bytes.size()))->at(0);
  }
  /// Reads until the server closes.
  bool is_closed() {
    boost::system::error_code error;
    while (!error) {
      beast::flat_buffer buffer;
      stream_.read(buffer, error);
    }
    return true;
  }

 private:
  asio::io_context io_;
  websocket::stream<tcp::socket, false> stream_{io_};
};

json listen(const std::string& path) {
  return {{"COMMAND", "LISTEN"}, {"DATA", path}};
}

TEST(OscQueryFeedTest, AnswersByHttp) {
  Running running(kConfig);
  EXPECT_THAT(get(running, "/?HOST_INFO"), HasSubstr(R"("NAME":"hall")"));
  EXPECT_THAT(get(running, "/wind/speed?UNIT"), HasSubstr(R"({"UNIT":["speed.m/s"]})"));
  EXPECT_THAT(get(running, "/wind/nothing"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(get(running, "/wind?NOTHING"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(get(running, "/?VALUE"), StartsWith("HTTP/1.1 204"));
}

TEST(OscQueryFeedTest, NothingIsSetAndNoForeignPageReads) {
  Running running(kConfig);
  EXPECT_THAT(answer_to(running, "PUT /wind HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n"),
              StartsWith("HTTP/1.1 405"));
  EXPECT_THAT(get(running, "/", "Host: evil.example\r\n"), StartsWith("HTTP/1.1 421"));
  EXPECT_THAT(get(running, "/", "Host: 127.0.0.1\r\nOrigin: http://evil.example\r\n"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(answer_to(running, "\x01\x02\r\n\r\n"), StartsWith("HTTP/1.1 400"));
}

TEST(OscQueryFeedTest, AListenerGetsEachValueThatChangesAndNoOther) {
  Running running(kConfig);
  Listener listener(running);
  listener.send(listen("/wind/speed"));
  const double first = *listener.receive_message().numbers.at(0);
  for (int i = 1; i < 20; ++i) EXPECT_GE(*listener.receive_message().numbers.at(0), first + i);
  listener.send(listen("/scene/meadow/opacity"));
  OscMessage message = listener.receive_message();
  while (message.address != "/scene/meadow/opacity") message = listener.receive_message();
  EXPECT_EQ(message.numbers.at(0), 1.0);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(listener.receive_message().address, "/wind/speed") << "it does not change";
  running.between([](values::Moment& moment) { moment.opacities = {0.25}; });
  while (message.address != "/scene/meadow/opacity" || message.numbers.at(0) != 0.25)
    message = listener.receive_message();
  listener.send({{"COMMAND", "IGNORE"}, {"DATA", "/wind/speed"}});
  listener.send(listen("/wind/state"));
  while (message.address != "/wind/state") message = listener.receive_message();
  EXPECT_GT(running.status().messages, 40U);
  EXPECT_EQ(running.status().sends, "30 values to 1 listener");
}

TEST(OscQueryFeedTest, AnotherListOfNamesIsToldAndWhatStaysGoesOn) {
  Running running(kConfig);
  Listener listener(running);
  listener.send(listen("/place/door/speed"));
  EXPECT_EQ(listener.receive_message().address, "/place/door/speed");
  running.between([](values::Moment& moment) {
    moment.names = names_of({"gate", "door"});
    moment.shaped_places.assign(2, {});
    moment.shaped_places[1][Quantity::kSpeed] = 7.0;
  });
  EXPECT_EQ(json::parse(listener.receive()), (json{{"COMMAND", "PATH_CHANGED"}, {"DATA", "/"}}));
  const OscMessage message = listener.receive_message();
  EXPECT_EQ(message.address, "/place/door/speed");
  EXPECT_EQ(message.numbers.at(0), 7.0);
}

TEST(OscQueryFeedTest, WhatIsNoCommandEndsTheConnectionAndNoOther) {
  Running running(kConfig);
  Listener good(running);
  good.send(listen("/wind/speed"));
  for (const std::string bad : {"", "{", "[]", "7", R"({"COMMAND":7})", R"({"COMMAND":"LISTEN","DATA":["/wind"]})"}) {
    Listener listener(running);
    listener.send_text(bad);
    EXPECT_TRUE(listener.is_closed()) << bad;
  }
  Listener tolerated(running);
  tolerated.send({{"COMMAND", "START_OSC_STREAMING"}, {"DATA", {{"LOCAL_SERVER_PORT", 9000}}}});
  tolerated.send(listen("/no/such/path"));
  tolerated.send_binary(drivers::bus::encode_osc("/wind/speed", std::array{99.0F}));
  tolerated.send(listen("/wind/speed"));
  EXPECT_LT(*tolerated.receive_message().numbers.at(0), *good.receive_message().numbers.at(0) + 1e6);
}

TEST(OscQueryFeedTest, CommandsThatComeFasterThanTheyAreTakenAreAllTaken) {
  Running running(kConfig);
  Listener listener(running);
  for (int i = 0; i < 1000; ++i) listener.send(listen("/wind/mean"));
  listener.send(listen("/wind/live"));
  while (listener.receive_message().address != "/wind/live") {
  }
}

TEST(OscQueryFeedTest, AListenerThatTakesNothingIsDisconnectedAndTheOthersGoOn) {
  Running running(kConfig);
  Listener stuck(running, 4096), good(running);
  for (const OscAddress& address : osc_addresses_of(*names_of({"door"}))) stuck.send(listen(address.path));
  good.send(listen("/wind/speed"));
  // Until the buffers are full and 5 s of the moments have passed.
  while (!running.status().sends.ends_with("to 1 listener")) good.receive_message();
  EXPECT_EQ(good.receive_message().address, "/wind/speed");
}

TEST(OscQueryFeedTest, APortInUseIsTriedAgain) {
  asio::io_context io;
  std::optional<tcp::acceptor> other(std::in_place, io, tcp::endpoint(asio::ip::address_v4::loopback(), 0));
  const tcp::endpoint endpoint = other->local_endpoint();
  Running running({.listen = "127.0.0.1:" + std::to_string(endpoint.port()), .name = "hall"});
  running.wait_until([](const Status& status) { return !status.trouble.empty(); });
  EXPECT_THAT(running.status().trouble, HasSubstr("Another program uses this address"));
  other.reset();
  running.wait_until([](const Status& status) { return status.trouble.empty(); });
  EXPECT_THAT(get(running, "/?HOST_INFO"), StartsWith("HTTP/1.1 200"));
}

}  // namespace
}  // namespace yuragi::daemon::feeds
