// Any bytes of a client of the daemon's WebSocket: in the request for it, as frames behind a good one, or as the
// payload of a good frame. The server answers or closes the connection, no handler throws, and the next client is
// served.
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
  auto server = std::make_unique<daemon::web::Server>(daemon::web::Settings{
      .listen = "127.0.0.1:0", .origins = {"https://editor.p5js.org"}, .software = "fuzz", .tick_rate_hz = 60.0});
  server->publish_scenes(share(wire::encode(samples::scenes())));
  server->publish_sensors(share(wire::encode(samples::sensors())), share(wire::encode(samples::sensors())));
  return server;
}

const std::string kFields = "Host: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n";
const std::string kKey = "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

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
      frames = fuzz::web_socket_frame(1, rest);
      break;
    default:
      frames = fuzz::web_socket_frame(2, rest);
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
