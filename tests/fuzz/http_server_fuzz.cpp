// Any bytes of a client, sent to the whole HTTP server with its page and its routes. The server answers the client or
// closes the connection. It never answers 500, and it goes on answering other clients.
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>

#include "daemon/web/web_server.hpp"
#include "engine/base/address.hpp"

namespace {

using namespace yuragi;
using boost::asio::ip::tcp;

void require(bool holds) {
  if (!holds) std::abort();
}

daemon::web::Settings settings() {
  return {.listen = "127.0.0.1:0",
          .hosts = {"roof"},
          .takes_token = true,
          .token = Secret("correct horse battery staple"),
          .hello = {.software = "yuragi 0.0.0"},
          .ask = [](const wire::Control& control, bool,
                    const auto& reply) { reply({.done = true, .message = control.scene, .scenes = {}}); },
          .history =
              [](unsigned, const auto& reply) {
                reply(Failure{"nothing", FailureKind::kNoInput});
              }};
}

/// Sends these bytes and no more, and returns what the server says until it closes the connection. Returns nothing
/// where the client cannot connect: so many clients in a second can use up the machine's ports.
std::optional<std::string> said_to(std::string_view bytes) {
  static daemon::web::Server server(settings());
  static const Address address = parse_address(server.local_endpoint()).value();
  boost::asio::io_context io;
  tcp::socket socket(io);
  boost::system::error_code gone;
  socket.connect(tcp::endpoint(boost::asio::ip::make_address(address.host), address.port), gone);
  if (gone) return std::nullopt;
  boost::asio::write(socket, boost::asio::buffer(bytes), gone);
  socket.shutdown(tcp::socket::shutdown_send, gone);
  std::string said;
  boost::asio::read(socket, boost::asio::dynamic_buffer(said), gone);
  return said;
}

/// The first byte chooses the part of a request that the others are, so that each is reached.
std::string request_of(std::string_view data) {
  if (data.empty()) return {};
  const std::string rest(data.substr(1));
  switch (static_cast<unsigned char>(data[0]) % 5) {
    case 0:
      return rest;
    case 1:
      return "GET /" + rest + " HTTP/1.1\r\nHost: roof\r\n\r\n";
    case 2:
      return "GET /api/v1/status HTTP/1.1\r\n" + rest + "\r\n\r\n";
    case 3:
      return "GET / HTTP/1.1\r\nHost: " + rest + "\r\n\r\n";
    default:
      return "POST /api/v1/scenes HTTP/1.1\r\nHost: roof\r\nContent-Type: application/json\r\nContent-Length: " +
             std::to_string(rest.size()) + "\r\n\r\n" + rest;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto said = said_to(request_of({reinterpret_cast<const char*>(data), size}));
  require(!said || said->empty() || said->starts_with("HTTP/1."));
  require(!said || !said->starts_with("HTTP/1.1 500"));  // what is said of a host may be any text
  static unsigned count = 0;
  if (++count % 64 != 0) return 0;
  const auto page = said_to("GET / HTTP/1.0\r\nHost: roof\r\n\r\n");
  require(!page || page->starts_with("HTTP/1."));
  return 0;
}
