// Any bytes of a client of [osc_query]: as a request, as frames behind a good request for a WebSocket, or as the text
// of a good frame. It is answered or disconnected, no handler throws, and the next client is served.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>

#include "daemon/feeds/osc_query_feed.hpp"
#include "engine/base/address.hpp"
#include "engine/base/contain.hpp"

namespace {

using namespace yuragi;
using boost::asio::ip::tcp;

void require(bool holds) {
  if (!holds) std::abort();
}

/// A feed that gets moments as fast as it takes them, for as long as the program runs.
Address serve() {
  static const auto feed = daemon::feeds::make_osc_query_feed({.listen = "127.0.0.1:0", .name = "fuzz"}, {});
  daemon::values::Moment moment;
  moment.sensors.resize(1);
  moment.names = std::make_shared<const daemon::values::Names>(daemon::values::Names{.sensors = {"roof"}});
  feed->send(moment);
  const Address address = parse_address(feed->status().target).value();
  std::thread([moment]() mutable {
    for (int tick = 0;; ++tick) {
      moment.time_s = tick * 0.001;
      moment.mono = MonoTime(from_seconds(moment.time_s));
      contain("a feed", [&] { feed->send(moment); });
      std::this_thread::yield();
    }
  }).detach();
  return address;
}

const std::string kUpgrade =
    "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";

/// Sends a request, the bytes behind it once it has been answered, and no more; reads until the server closes.
/// Returns nothing if the client cannot connect: so many clients in a second can use up the machine's ports.
std::optional<std::string> reply_to(const std::string& request, const std::string& frames) {
  static const Address address = serve();
  boost::asio::io_context io;
  tcp::socket socket(io);
  boost::system::error_code gone;
  socket.connect(tcp::endpoint(boost::asio::ip::make_address(address.host), address.port), gone);
  if (gone) return std::nullopt;
  boost::asio::write(socket, boost::asio::buffer(request), gone);
  if (frames.empty()) socket.shutdown(tcp::socket::shutdown_send, gone);
  std::string bytes;
  boost::asio::read_until(socket, boost::asio::dynamic_buffer(bytes), "\r\n\r\n", gone);
  if (!frames.empty()) {
    boost::system::error_code ignored;
    boost::asio::write(socket, boost::asio::buffer(frames), ignored);
    socket.shutdown(tcp::socket::shutdown_send, ignored);
  }
  if (!gone) boost::asio::read(socket, boost::asio::dynamic_buffer(bytes), gone);
  return bytes;
}

/// A text as a frame of a client, which is masked; by zeros (RFC 6455, 5.2).
std::string frame_of(std::string_view text) {
  constexpr std::size_t kMaxShort = 125;
  const bool is_short = text.size() <= kMaxShort;
  std::string frame = {'\x81', static_cast<char>(0x80U | (is_short ? text.size() : 126U))};
  if (!is_short) frame += {static_cast<char>(text.size() >> 8U), static_cast<char>(text.size() & 0xFFU)};
  return frame + std::string(4, '\0') + std::string(text);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  report_faults_to([](std::string_view, const char*) noexcept { std::abort(); });
  if (size == 0 || size > 60'000) return 0;
  const std::string rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::string request = kUpgrade, frames;
  switch (data[0] % 4) {
    case 0:
      request = rest;
      break;
    case 1:
      request = "GET " + rest + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n";
      break;
    case 2:
      frames = rest;
      break;
    default:
      frames = frame_of(rest);
  }
  const auto reply = reply_to(request, frames);
  require(!reply || reply->empty() || reply->starts_with("HTTP/1.1 "));
  require(!reply || !reply->starts_with("HTTP/1.1 500"));
  static unsigned count = 0;
  if (++count % 64 != 0) return 0;
  const auto served = reply_to("GET /?HOST_INFO HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n", "");
  require(!served || served->empty() || served->find("\"NAME\":\"fuzz\"") != std::string::npos);
  return 0;
}
