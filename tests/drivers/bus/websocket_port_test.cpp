// The port against the simulators' WebSocket server, and against servers that break the protocol's rules.
#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <string>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "simulators/text/text_wire.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/scripted_server.hpp"

namespace yuragi::drivers::bus {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr auto kForever = 60s;  // so long waits only who waits for something that hangs

/// A server on a thread of its own, which says back what it hears.
class EchoServer {
 public:
  explicit EchoServer(simulators::text::WebSocketWireOptions options = {})
      : wire_(simulators::text::make_websocket_wire(options)), thread_([this] {
          wire_->greet_with("hello\r\n");
          while (is_wanted_) {
            wire_->refuse(refuses_);
            if (const std::string said = wire_->read({}); !said.empty()) wire_->write(said);
            std::this_thread::yield();
          }
        }) {
    const std::string place = wire_->place();
    address.kind = BytePortKind::kWebSocket;
    address.host = "127.0.0.1";
    address.port = static_cast<std::uint16_t>(std::stoi(place.substr(place.rfind(':') + 1)));
    address.path = "/stream";
    address.connect_timeout = kForever;
  }
  ~EchoServer() {
    is_wanted_ = false;
    thread_.join();
  }
  EchoServer(const EchoServer&) = delete;
  EchoServer& operator=(const EchoServer&) = delete;

  void set_refuses(bool refuses) { refuses_ = refuses; }

  BytePortAddress address;

 private:
  std::unique_ptr<simulators::text::Wire> wire_;
  std::atomic<bool> is_wanted_ = true;
  std::atomic<bool> refuses_ = false;
  std::thread thread_;
};

std::string next_message(BytePort& port) {
  std::vector<std::uint8_t> buffer(kMaxDatagram);
  const ByteArrival arrival = port.read(buffer, kForever);
  EXPECT_TRUE(arrival.is_whole_datagram);
  return {buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(arrival.size)};
}

ByteStatus next_status(BytePort& port, Nanoseconds timeout = kForever) {
  std::vector<std::uint8_t> buffer(kMaxDatagram);
  return port.read(buffer, timeout).status;
}

bool say(BytePort& port, std::string_view text) {
  return port.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string trouble_at(const BytePortAddress& address) {
  const auto opened = make_byte_port(address)->open();
  return opened ? "none" : opened.error().message;
}

/// What a server says that knows nothing of WebSockets; empty: nothing.
ScriptedServer::Script answering(const std::string& text) {
  return [text](const ScriptedServer::Bytes& /*request*/) -> std::optional<ScriptedServer::Bytes> {
    return ScriptedServer::Bytes(text.begin(), text.end());
  };
}

/// A server that agrees to one client, which has to come, sends these bytes, whatever they are, and then says no more.
/// It keeps what it reads first, so many bytes, and hangs up after the client.
class RawServer {
 public:
  explicit RawServer(std::string sent, std::size_t reads = 0)
      : thread_([this, sent, reads] {
          boost::beast::websocket::stream<boost::asio::ip::tcp::socket> stream(acceptor_.accept());
          stream.accept();
          boost::asio::write(stream.next_layer(), boost::asio::buffer(sent));
          std::string heard(reads, ' ');
          boost::asio::read(stream.next_layer(), boost::asio::buffer(heard));
          heard_.set_value(heard);
          std::array<char, 64> more{};
          boost::system::error_code error;
          while (!error) stream.next_layer().read_some(boost::asio::buffer(more), error);
        }) {
    address.kind = BytePortKind::kWebSocket;
    address.host = "127.0.0.1";
    address.port = acceptor_.local_endpoint().port();
    address.path = "/";
    address.connect_timeout = kForever;
  }
  ~RawServer() { thread_.join(); }
  RawServer(const RawServer&) = delete;
  RawServer& operator=(const RawServer&) = delete;

  std::string heard() { return heard_.get_future().get(); }

  BytePortAddress address;

 private:
  boost::asio::io_context context_;
  boost::asio::ip::tcp::acceptor acceptor_{context_, {boost::asio::ip::address_v4::loopback(), 0}};
  std::promise<std::string> heard_;
  std::thread thread_;
};

/// Bytes as they are, zeroes among them.
template <std::size_t kSize>
std::string frames(const char (&bytes)[kSize]) {
  return std::string(bytes, kSize - 1);
}

TEST(WebSocketPort, CarriesMessagesBothWays) {
  EchoServer server;
  const auto port = make_byte_port(server.address);
  ASSERT_EQ(trouble_at(server.address), "none");
  ASSERT_TRUE(port->open().has_value());
  EXPECT_EQ(next_message(*port), "hello");
  for (const std::string& text : {std::string("a"), std::string("two words"), std::string(4000, 'x')}) {
    ASSERT_TRUE(say(*port, text));
    EXPECT_EQ(next_message(*port), text);
  }
  EXPECT_EQ(next_status(*port, 1ms), ByteStatus::kSilence);
}

TEST(WebSocketPort, IsLostWithItsServerAndCanBeOpenedAgain) {
  EchoServer server;
  const auto port = make_byte_port(server.address);
  ASSERT_TRUE(port->open().has_value());
  EXPECT_EQ(next_message(*port), "hello");
  server.set_refuses(true);
  EXPECT_EQ(next_status(*port), ByteStatus::kLost);
  EXPECT_EQ(next_status(*port), ByteStatus::kLost);
  EXPECT_FALSE(say(*port, "gone"));
  const auto refused = port->open();
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message, HasSubstr("(HTTP 503 Service Unavailable): check the server"));
  server.set_refuses(false);
  bool is_open = false;
  while (!is_open) is_open = port->open().has_value();
  EXPECT_EQ(next_message(*port), "hello");
}

TEST(WebSocketPort, SaysWhyAServerRefuses) {
  EchoServer server({.path = "/stream", .token = "abc.def"});
  EXPECT_THAT(trouble_at(server.address), HasSubstr("(HTTP 401 Unauthorized): it requires a token"));
  server.address.token = Secret("abc.xyz");
  const std::string trouble = trouble_at(server.address);
  EXPECT_THAT(trouble, HasSubstr("(HTTP 401 Unauthorized): check the token"));
  EXPECT_THAT(trouble, testing::Not(HasSubstr("abc")));
  server.address.token = Secret("abc.def");
  EXPECT_EQ(trouble_at(server.address), "none");
  server.address.path = "/other";
  EXPECT_THAT(trouble_at(server.address), HasSubstr("(HTTP 404 Not Found): check the path"));
}

TEST(WebSocketPort, SaysWhatIsNoWebSocketServer) {
  BytePortAddress address{
      .kind = BytePortKind::kWebSocket, .path = "/", .host = "127.0.0.1", .port = free_port(SOCK_STREAM)};
  EXPECT_THAT(trouble_at(address), HasSubstr("cannot connect to ws://127.0.0.1:"));
  for (const std::string& answer :
       {std::string("220 smtp ready\r\n"), std::string("HTTP/1.1 200 OK\r\nContent-Length: 0\r\n\r\n"),
        std::string("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                    "Sec-WebSocket-Accept: bm90IHRoZSBrZXkncyBoYXNo\r\n\r\n"),
        "HTTP/1.1 101 Switching Protocols\r\nX: " + std::string(100'000, 'x')}) {
    ScriptedServer server(answering(answer));
    address.port = server.port();
    EXPECT_THAT(trouble_at(address), HasSubstr("check")) << answer.substr(0, 40);
  }
  ScriptedServer silent(answering(""));
  address.port = silent.port();
  address.connect_timeout = 50ms;
  EXPECT_THAT(trouble_at(address), testing::AnyOf(HasSubstr("does not reply"), HasSubstr("is not a WebSocket server")));
}

TEST(WebSocketPort, JoinsFragmentsAndKeepsMessagesApart) {
  RawServer server(
      frames("\x01\x01"
             "a"
             "\x89\x00"
             "\x80\x01"
             "b"
             "\x81\x01"
             "c"
             "\x82\x01"
             "d"));
  const auto port = make_byte_port(server.address);
  ASSERT_TRUE(port->open().has_value());
  EXPECT_EQ(next_message(*port), "ab");
  EXPECT_EQ(next_message(*port), "c");
  EXPECT_EQ(next_message(*port), "d");
}

TEST(WebSocketPort, AnswersAPing) {
  RawServer server(frames("\x89\x00"), 6);
  const auto port = make_byte_port(server.address);
  ASSERT_TRUE(port->open().has_value());
  auto heard = std::async(std::launch::async, [&server] { return server.heard(); });
  while (heard.wait_for(0s) != std::future_status::ready) ASSERT_EQ(next_status(*port, 1ms), ByteStatus::kSilence);
  EXPECT_EQ(heard.get().substr(0, 2), frames("\x8A\x80"));
}

TEST(WebSocketPort, EndsAConnectionThatBreaksTheRules) {
  for (const std::string& bytes : {
           frames("\x88\x02\x03\xE8"),                          // closed by the server
           frames("\x81\x7F\x00\x00\x00\x00\x00\x01\x00\x01"),  // a message of 64 KiB and a byte
           frames("\x81\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF"),  // one of more than there is
           std::string(16, '\xFF'),                             // no frame
           frames("\xC1\x01"
                  "a"),  // compressed, which was not agreed
           frames("\x81\x81"
                  "keys"
                  "a"),                 // masked, which a server's never are
           frames("\x81\x02\xC3\x28"),  // no UTF-8
           frames("\x80\x01"
                  "a"),  // goes on with nothing
       }) {
    RawServer server(bytes);
    const auto port = make_byte_port(server.address);
    ASSERT_TRUE(port->open().has_value());
    EXPECT_EQ(next_status(*port), ByteStatus::kLost);
    EXPECT_EQ(next_status(*port), ByteStatus::kLost);
  }
}

TEST(WebSocketPort, NoticesAServerThatHasVanishedSilently) {
  RawServer server("");
  server.address.idle_timeout = 200ms;
  const auto port = make_byte_port(server.address);
  ASSERT_TRUE(port->open().has_value());
  EXPECT_EQ(next_status(*port), ByteStatus::kLost);
}

TEST(WebSocketPort, SaysGoodbye) {
  RawServer server("", 8);
  const auto port = make_byte_port(server.address);
  ASSERT_TRUE(port->open().has_value());
  EXPECT_EQ(next_status(*port, 1ms), ByteStatus::kSilence) << "a read is under way";
  port->close();
  EXPECT_EQ(server.heard().substr(0, 2), frames("\x88\x82")) << "a closing frame with a reason";
  EXPECT_EQ(next_status(*port), ByteStatus::kLost);
}

TEST(WebSocketPort, CanBeInterrupted) {
  EchoServer server;
  const auto port = make_byte_port(server.address);
  ASSERT_TRUE(port->open().has_value());
  EXPECT_EQ(next_message(*port), "hello");
  std::thread other([&port] {
    std::this_thread::yield();
    port->interrupt();
  });
  EXPECT_EQ(next_status(*port, 1h), ByteStatus::kInterrupted);
  other.join();
  EXPECT_EQ(next_status(*port, 1h), ByteStatus::kInterrupted);
  EXPECT_TRUE(say(*port, "a last word")) << "what needs no wait is still sent";
  EXPECT_FALSE(port->open().has_value());
}

// Whose queue of connections is full does not answer another one.
TEST(WebSocketPort, CanBeInterruptedWhileItConnects) {
  using boost::asio::ip::tcp;
  boost::asio::io_context context;
  tcp::acceptor busy(context);
  busy.open(tcp::v4());
  busy.bind({boost::asio::ip::address_v4::loopback(), 0});
  busy.listen(0);
  tcp::socket first(context);
  first.connect(busy.local_endpoint());
  const auto port = make_byte_port({.kind = BytePortKind::kWebSocket,
                                    .path = "/",
                                    .host = "127.0.0.1",
                                    .port = busy.local_endpoint().port(),
                                    .connect_timeout = kForever});
  auto opened = std::async(std::launch::async, [&port] { return port->open(); });
  EXPECT_EQ(opened.wait_for(50ms), std::future_status::timeout);
  port->interrupt();
  const auto result = opened.get();
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().message, "interrupted");
}

TEST(WebSocketPort, CanBeInterruptedInItsHandshake) {
  ScriptedServer silent(answering(""));
  const auto port = make_byte_port({.kind = BytePortKind::kWebSocket,
                                    .path = "/",
                                    .host = "127.0.0.1",
                                    .port = silent.port(),
                                    .connect_timeout = kForever});
  std::thread other([&port] {
    std::this_thread::yield();
    port->interrupt();
  });
  const auto opened = port->open();
  other.join();
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().message, "interrupted");
}

}  // namespace
}  // namespace yuragi::drivers::bus
