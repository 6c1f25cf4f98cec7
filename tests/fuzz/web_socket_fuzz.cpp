// Any bytes of a client of the daemon's WebSocket: in the request for it, as frames behind a good one, as frames with
// sound lengths and masks, or as the payload of a good frame. The server answers or closes the connection, no handler
// throws, and the next client is served.
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/web/web_server.hpp"
#include "engine/base/address.hpp"
#include "engine/base/contain.hpp"
#include "tests/engine/wire/samples.hpp"
#include "tests/fuzz/web_client.hpp"

namespace {

using namespace yuragi;

void require(bool holds) {
  if (!holds) std::abort();
}

daemon::stream::SharedBytes share(wire::Bytes bytes) {
  return std::make_shared<const wire::Bytes>(std::move(bytes));
}

std::unique_ptr<daemon::web::Server> make_server() {
  auto server =
      std::make_unique<daemon::web::Server>(daemon::web::Settings{.listen = "127.0.0.1:0",
                                                                  .origins = {"https://editor.p5js.org"},
                                                                  .hello = {.software = "fuzz", .tick_rate_hz = 60.0}});
  server->publish_scenes(share(wire::encode(samples::scenes())));
  server->publish_sensors(share(wire::encode(samples::sensors())), share(wire::encode(samples::sensors())));
  return server;
}

const std::string kFields = "Host: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n";
const std::string kKey = "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

constexpr unsigned char kAbsurd = 0xF0;  ///< from this on the length is one that nobody sends

/// Of the extended length of a frame (RFC 6455, 5.2).
unsigned length_bytes(unsigned char kind, std::size_t payload_bytes) {
  if (kind >= kAbsurd || (kind & 0x20U) != 0) return 8;
  return payload_bytes > 125 || (kind & 0x40U) != 0 ? 2 : 0;
}

/// Frames of any kind, so that fragments and control frames are reached, and what stands behind them. Of each the first
/// byte of `data` is its first, the second chooses its mask and its length.
std::string frames_of(std::string_view data) {
  std::string frames;
  while (data.size() >= 2) {
    const auto kind = static_cast<unsigned char>(data[1]);
    const std::string payload(data.substr(2, (kind & 0x0FU) * 20U));
    const bool is_masked = (kind & 0x10U) == 0;  // a server refuses the others
    const unsigned bytes = length_bytes(kind, payload.size());
    const std::size_t length = bytes == 0 ? payload.size() : bytes == 2 ? 126 : 127;
    frames += data[0];
    frames += static_cast<char>((is_masked ? 0x80U : 0U) | length);
    for (unsigned i = bytes; i-- > 0;)
      frames += static_cast<char>(kind >= kAbsurd ? 0x7FU : (payload.size() >> (8U * i)) & 0xFFU);
    if (is_masked) frames += std::string(4, '\0');
    frames += payload;
    data.remove_prefix(2 + payload.size());
  }
  return frames;
}

std::optional<fuzz::WebReply> reply_to(const std::string& request, const std::string& frames) {
  static const std::unique_ptr<daemon::web::Server> server = make_server();
  return fuzz::web_reply(parse_address(server->local_endpoint()).value(), request, frames);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  report_faults_to([](std::string_view, const char*) noexcept { std::abort(); });
  if (size == 0 || size > 60'000) return 0;
  const std::string rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string upgrade = fuzz::web_socket_request("/ws");
  std::string request = upgrade, frames;
  switch (data[0] % 7) {
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
      frames = fuzz::web_socket_frame(1, rest);
      break;
    case 5:
      frames = fuzz::web_socket_frame(2, rest);
      break;
    default:
      frames = frames_of(rest);
  }
  const auto reply = reply_to(request, frames);
  require(!reply || reply->head.empty() || reply->head.starts_with("HTTP/1.1 "));
  require(!reply || !reply->head.starts_with("HTTP/1.1 500"));
  static unsigned count = 0;
  if (++count % 64 != 0) return 0;
  // The scenes come as a binary message.
  const auto served = reply_to(upgrade, fuzz::web_socket_frame(1, R"({"stream":{}})"));
  require(!served || served->head.empty() ||
          (served->head.starts_with("HTTP/1.1 101") && served->rest.find("YURA") != std::string::npos));
  return 0;
}
