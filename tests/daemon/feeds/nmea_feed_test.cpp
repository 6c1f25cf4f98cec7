#include "daemon/feeds/nmea_feed.hpp"

#include <list>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/feeds/line_server.hpp"
#include "daemon/feeds/nmea_sentences.hpp"
#include "drivers/decode/text/nmea.hpp"
#include "engine/base/address.hpp"
#include "tests/daemon/feeds/receiver.hpp"

namespace yuragi::daemon::feeds {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;
using values::Quantity;

TEST(NmeaSentencesTest, HaveTheirFieldsAndAChecksum) {
  EXPECT_EQ(mwv_sentence({.speed_m_s = 5.25, .direction_deg = 7.0}), "$WIMWV,007.0,T,5.25,M,A*13\r\n");
  EXPECT_EQ(mwv_sentence({.speed_m_s = 5.25, .direction_deg = 7.0, .is_valid = false}),
            "$WIMWV,007.0,T,5.25,M,V*04\r\n");
  EXPECT_EQ(mwd_sentence({.speed_m_s = 1852.0 / 360.0, .direction_deg = 270.5}),
            "$WIMWD,270.5,T,,M,10.00,N,5.14,M*45\r\n");
  EXPECT_THAT(mwd_sentence({.is_valid = false}), StartsWith("$WIMWD,,T,,M,,N,,M*"));
  EXPECT_THAT(mwv_sentence({.direction_deg = 359.96}), StartsWith("$WIMWV,000.0,T,0.00,M,A*"));
}

TEST(NmeaSentencesTest, OurOwnDriverReadsThem) {
  for (const auto& sentence : {mwv_sentence({.speed_m_s = 5.25, .direction_deg = 7.5}),
                               mwd_sentence({.speed_m_s = 5.25, .direction_deg = 7.5})}) {
    const auto decoded = drivers::decode::text::decode_nmea({}, sentence.substr(0, sentence.size() - 2));
    ASSERT_TRUE(decoded) << sentence;
    EXPECT_NEAR(*decoded->speed_m_s, 5.25, 1e-9);
    EXPECT_NEAR(*decoded->direction_deg, 7.5, 1e-9);
  }
}

values::Moment moment_at(double time_s, double live = 1.0) {
  values::Moment moment;
  moment.time_s = time_s;
  moment.mono = MonoTime(from_seconds(1000.0 + time_s));
  moment.shaped[Quantity::kSpeed] = 5.0;
  moment.real[Quantity::kLive] = live;
  return moment;
}

TEST(NmeaFeedTest, SendsBothSentencesAtItsRate) {
  Receiver receiver;
  const auto feed = make_nmea_feed({.name = "a", .to = receiver.address(), .listen = {}, .rate_hz = 10.0});
  for (int i = 0; i < 60; ++i) feed->send(moment_at(i / 60.0));
  const auto datagrams = receiver.datagrams();
  EXPECT_THAT(datagrams, SizeIs(10));
  EXPECT_EQ(std::string(datagrams[0].begin(), datagrams[0].end()),
            mwv_sentence({.speed_m_s = 5.0}) + mwd_sentence({.speed_m_s = 5.0}));
  EXPECT_EQ(feed->status().messages, 10U);
  EXPECT_EQ(feed->status().target, receiver.address());
}

TEST(NmeaFeedTest, RealWindIsInvalidWhileNothingIsMeasured) {
  Receiver receiver;
  const auto feed = make_nmea_feed({.name = "a", .to = receiver.address(), .listen = {}, .wind = values::Wind::kReal});
  feed->send(moment_at(0.0, 1.0));
  feed->send(moment_at(1.0, 0.0));
  const auto datagrams = receiver.datagrams();
  ASSERT_THAT(datagrams, SizeIs(2));
  EXPECT_THAT(std::string(datagrams[0].begin(), datagrams[0].end()), HasSubstr(",A*"));
  EXPECT_THAT(std::string(datagrams[1].begin(), datagrams[1].end()), HasSubstr(",V*"));
}

/// A server on a free port, and its clients.
class LineServerTest : public testing::Test {
 protected:
  /// Sends until something is reached: look-ups and connections take their own time.
  template <class Reached>
  void send_until(const std::string& message, const Reached& is_reached) {
    while (!is_reached()) {
      server_.send(message, now_);
      std::this_thread::yield();
    }
  }
  void listen() {
    send_until("", [this] { return !server_.address().ends_with(":0"); });
  }
  tcp::socket& connect() {
    tcp::socket& socket = clients_.emplace_back(io_);
    socket.connect({asio::ip::address_v4::loopback(), parse_address(server_.address()).value().port});
    return socket;
  }
  static std::string line_to(tcp::socket& socket) {
    std::string line;
    char c = 0;
    while (c != '\n' && asio::read(socket, asio::buffer(&c, 1)) == 1) line += c;
    return line;
  }

  LineServer server_{"a", "127.0.0.1:0"};
  asio::io_context io_;
  std::list<tcp::socket> clients_;
  MonoTime now_{std::chrono::seconds(1000)};
};

TEST_F(LineServerTest, SendsToEachOfItsClients) {
  listen();
  tcp::socket& one = connect();
  tcp::socket& two = connect();
  send_until("", [this] { return server_.clients() == 2; });
  server_.send("wind\r\n", now_);
  EXPECT_EQ(line_to(one), "wind\r\n");
  EXPECT_EQ(line_to(two), "wind\r\n");
  EXPECT_EQ(server_.messages(), 2U);
  one.close();
  send_until("wind\r\n", [this] { return server_.clients() == 1; });
  EXPECT_THAT(server_.trouble(), IsEmpty());
}

TEST_F(LineServerTest, TheSeventeenthIsDisconnected) {
  listen();
  for (std::size_t i = 0; i < LineServer::kMaxClients; ++i) connect();
  send_until("", [this] { return server_.clients() == LineServer::kMaxClients; });
  tcp::socket& further = connect();
  further.non_blocking(true);
  boost::system::error_code error;
  send_until("", [&] {
    char c = 0;
    further.read_some(asio::buffer(&c, 1), error);
    return error != asio::error::would_block;
  });
  EXPECT_EQ(error, asio::error::eof);
  EXPECT_EQ(server_.clients(), LineServer::kMaxClients);
}

TEST_F(LineServerTest, ASlowClientLosesWholeMessagesAndThenItsPlace) {
  listen();
  tcp::socket& slow = connect();
  send_until("", [this] { return server_.clients() == 1; });
  const std::string message = std::string(10'000, 'x') + "\r\n";
  std::uint64_t sent = 0;
  do {
    sent = server_.messages();
    server_.send(message, now_);
  } while (server_.messages() > sent);
  server_.send(message, now_);
  ASSERT_EQ(server_.clients(), 1U);
  now_ += std::chrono::seconds(31);
  server_.send(message, now_);
  EXPECT_EQ(server_.clients(), 0U);
  std::string got(message.size(), ' ');
  for (std::uint64_t i = 0; i + 1 < sent; ++i) {
    asio::read(slow, asio::buffer(got));
    EXPECT_EQ(got, message) << "none is cut";
  }
}

TEST_F(LineServerTest, AnAddressInUseIsATrouble) {
  listen();
  LineServer second("b", server_.address());
  while (second.trouble().empty()) second.send("", now_);
  EXPECT_THAT(second.trouble(), HasSubstr("cannot listen at " + server_.address()));
}

}  // namespace
}  // namespace yuragi::daemon::feeds
