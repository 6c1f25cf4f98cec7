#include "daemon/stream/stream_client.hpp"

#include <thread>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <gtest/gtest.h>

#include "daemon/stream/tcp_stream.hpp"
#include "tests/engine/wire/samples.hpp"

namespace yuragi::daemon::stream {
namespace {

namespace asio = boost::asio;
using namespace std::chrono_literals;

/// A server on a thread of its own, since the client blocks.
class StreamClientTest : public testing::Test {
 protected:
  StreamClientTest() : stream_(io_, "127.0.0.1:0", settings()), thread_([this] { io_.run(); }) {}
  ~StreamClientTest() override {
    io_.stop();
    thread_.join();
  }

  static TcpStreamSettings settings() {
    TcpStreamSettings settings;
    settings.hello = {.software = "test", .tick_rate_hz = 60.0};
    settings.scenes = samples::scenes();
    return settings;
  }

  template <class Work>
  void on_server(Work work) {
    asio::post(io_, work);
  }

  asio::io_context io_{1};
  TcpStream stream_;
  std::thread thread_;
};

TEST_F(StreamClientTest, ItReceivesWhatItSubscribedTo) {
  auto client = Client::connect(stream_.local_endpoint(), 5s);
  ASSERT_TRUE(client.has_value()) << client.error().message;
  EXPECT_EQ(std::get<wire::Hello>(client->receive(5s).value()).software, "test");
  ASSERT_TRUE(client->subscribe({.poses = true, .sensors = true, .client = "a test"}));
  EXPECT_EQ(std::get<wire::Scenes>(client->receive(5s).value()).scenes.size(), 2u);
  on_server([this] { stream_.publish(std::make_shared<const wire::Bytes>(samples::frame_bytes(20'000))); });
  EXPECT_EQ(std::get<wire::Frame>(client->receive(5s).value()).info.sequence, 7u);
  on_server([this] {
    stream_.publish_sensors(std::make_shared<const wire::Bytes>(wire::encode(samples::sensors())), nullptr);
  });
  EXPECT_EQ(std::get<wire::Sensors>(client->receive(5s).value()).sensors.size(), 2u);
}

TEST_F(StreamClientTest, ATimeOutIsNotTheEnd) {
  auto client = Client::connect(stream_.local_endpoint(), 5s);
  ASSERT_TRUE(client.has_value());
  ASSERT_TRUE(client->receive(5s).has_value());
  EXPECT_EQ(client->receive(1ms).error(), End::kTimeout);
  ASSERT_TRUE(client->subscribe({.client = "a test"}));
  EXPECT_TRUE(std::holds_alternative<wire::Scenes>(client->receive(5s).value()));
}

TEST_F(StreamClientTest, AClosedConnectionIsTold) {
  auto client = Client::connect(stream_.local_endpoint(), 5s);
  ASSERT_TRUE(client.has_value());
  ASSERT_TRUE(client->receive(5s).has_value());
  on_server([this] { stream_.close(); });
  EXPECT_EQ(client->receive(5s).error(), End::kClosed);
  EXPECT_EQ(client->receive(5s).error(), End::kClosed);
}

TEST_F(StreamClientTest, WhereNobodyListensTheFailureNamesTheAddress) {
  // A port that was free a moment ago.
  std::string address;
  {
    asio::io_context io;
    address = TcpStream(io, "127.0.0.1:0", settings()).local_endpoint();
  }
  const auto client = Client::connect(address, 5s);
  ASSERT_FALSE(client.has_value());
  EXPECT_NE(client.error().message.find(address), std::string::npos);
  EXPECT_FALSE(Client::connect("nonsense", 1s).has_value());
}

}  // namespace
}  // namespace yuragi::daemon::stream
