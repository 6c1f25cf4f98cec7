// Any bytes of a client of the daemon's WebSocket: in the request for it, as frames behind a good one, or as the
// payload of a good frame. The server answers or closes the connection, no handler throws, and the next client is
// served.
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>

#include "daemon/web/web_server.hpp"
#include "engine/base/address.hpp"
#include "engine/base/contain.hpp"
#include "tests/engine/wire/samples.hpp"

namespace {

using namespace yuragi;
using boost::asio::ip::tcp;

void require(bool holds) {
  if (!holds) std::abort();
}

daemon::stream::SharedBytes share(wire::Bytes bytes) {
  return std::make_shared<const wire::Bytes>(std::move(bytes));
}

std::unique_ptr<daemon::web::Server> make_server() {
  auto server = std::make_unique<daemon::web::Server>(daemon::web::Settings{
      .listen = "127.0.0.1:0", .origins = {"https://editor.p5js.org"}, .software = "fuzz", .tick_rate_hz = 60.0});
  server->publish_scenes(share(wire::encode(samples::scenes())));
  server->publish_sensors(share(wire::encode(samples::sensors())), share(wire::encode(samples::sensors())));
  return server;
}

const std::string kFields = "Host: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n";
const std::string kKey = "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

struct Reply {
  std::string head;  ///< the answer to the request
  std::string rest;  ///< what comes behind it
};

/// Sends a request, the bytes behind it once it has been answered, and no more; reads until the server closes.
/// Returns nothing if the client cannot connect: so many clients in a second can use up the machine's ports.
std::optional<Reply> reply_to(const std::string& request, const std::string& frames) {
  static const std::unique_ptr<daemon::web::Server> server = make_server();
  static const Address address = parse_address(server->local_endpoint()).value();
  boost::asio::io_context io;
  tcp::socket socket(io);
  boost::system::error_code gone;
  socket.connect(tcp::endpoint(boost::asio::ip::make_address(address.host), address.port), gone);
  if (gone) return std::nullopt;
  boost::asio::write(socket, boost::asio::buffer(request), gone);
  if (frames.empty()) socket.shutdown(tcp::socket::shutdown_send, gone);
  std::string bytes;
  const std::size_t size = boost::asio::read_until(socket, boost::asio::dynamic_buffer(bytes), "\r\n\r\n", gone);
  boost::system::error_code ignored;
  if (!frames.empty()) {
    boost::asio::write(socket, boost::asio::buffer(frames), ignored);
    socket.shutdown(tcp::socket::shutdown_send, ignored);
  }
  if (!gone) boost::asio::read(socket, boost::asio::dynamic_buffer(bytes), gone);
  return Reply{bytes.substr(0, size), bytes.substr(size)};
}

/// A frame of a client, which is masked; by zeros, so that the payload stands in it as it is (RFC 6455, 5.2).
std::string frame_of(unsigned opcode, std::string_view payload) {
  constexpr std::size_t kMaxShort = 125;
  const bool is_short = payload.size() <= kMaxShort;
  std::string frame = {static_cast<char>(0x80U | opcode),
                       static_cast<char>(0x80U | (is_short ? payload.size() : 126U))};
  if (!is_short) frame += {static_cast<char>(payload.size() >> 8U), static_cast<char>(payload.size() & 0xFFU)};
  return frame + std::string(4, '\0') + std::string(payload);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  report_faults_to([](std::string_view, const char*) noexcept { std::abort(); });
  if (size == 0 || size > 60'000) return 0;
  const std::string rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string upgrade = "GET /ws HTTP/1.1\r\n" + kFields + kKey + "\r\n";
  std::string request = upgrade, frames;
  switch (data[0] % 6) {
    case 0:
      request = "GET /ws HTTP/1.1\r\n" + kFields + rest + "\r\n\r\n";
      break;
    case 1:
      request = "GET /ws HTTP/1.1\r\n" + kFields + kKey + "Origin: " + rest + "\r\n\r\n";
      break;
    case 2:
      request = upgrade + rest;
      break;
    case 3:
      frames = rest;
      break;
    case 4:
      frames = frame_of(1, rest);
      break;
    default:
      frames = frame_of(2, rest);
  }
  const auto reply = reply_to(request, frames);
  require(!reply || reply->head.empty() || reply->head.starts_with("HTTP/1.1 "));
  require(!reply || !reply->head.starts_with("HTTP/1.1 500"));
  static unsigned count = 0;
  if (++count % 64 != 0) return 0;
  // The scenes come as a binary message.
  const auto served = reply_to(upgrade, frame_of(1, R"({"stream":{}})"));
  require(!served || served->head.empty() ||
          (served->head.starts_with("HTTP/1.1 101") && served->rest.find("YURA") != std::string::npos));
  return 0;
}
