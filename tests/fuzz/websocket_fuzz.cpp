// Any bytes of a server, sent by TCP to the WebSocket port of the drivers: in place of its handshake, or after a good
// one. The port gives messages or is lost, and never hangs.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <future>
#include <string_view>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "drivers/bus/byte_port_kinds.hpp"

namespace {

using namespace yuragi;
using boost::asio::ip::tcp;
namespace beast = boost::beast;

/// Accepts one client, and sends it `bytes`; before them a good handshake, if `is_polite`.
void serve(tcp::acceptor& acceptor, std::string_view bytes, bool is_polite) {
  tcp::socket socket = acceptor.accept();
  boost::system::error_code gone;
  if (is_polite) {
    beast::websocket::stream<tcp::socket&> server(socket);
    server.accept(gone);
  } else {
    beast::flat_buffer buffer;
    beast::http::request<beast::http::string_body> request;
    beast::http::read(socket, buffer, request, gone);
  }
  boost::asio::write(socket, boost::asio::buffer(bytes), gone);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static boost::asio::io_context io;
  static tcp::acceptor acceptor(io, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const bool is_polite = data[0] % 2 == 1;
  const auto server = std::async(std::launch::async, [&] { serve(acceptor, bytes, is_polite); });
  const auto port = drivers::bus::make_byte_port({.kind = drivers::bus::BytePortKind::kWebSocket,
                                                  .path = "/stream",
                                                  .host = "127.0.0.1",
                                                  .port = acceptor.local_endpoint().port(),
                                                  .idle_timeout = std::chrono::seconds(60),
                                                  .connect_timeout = std::chrono::seconds(60)});
  if (!port->open()) return 0;
  std::array<std::uint8_t, 65536> message{};
  using drivers::bus::ByteStatus;
  for (ByteStatus status = ByteStatus::kSilence; status != ByteStatus::kLost;) {
    const auto arrival = port->read(message, std::chrono::seconds(60));
    status = arrival.status;
    if (arrival.size > message.size() || status == ByteStatus::kInterrupted) std::abort();
  }
  return 0;
}
