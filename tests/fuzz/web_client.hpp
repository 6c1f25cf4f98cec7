#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>

#include "engine/base/address.hpp"

namespace yuragi::fuzz {

struct WebReply {
  std::string head;  ///< the answer to the request
  std::string rest;  ///< what comes behind it
};

/// Sends a request, the bytes behind it once it has been answered, and no more; reads until the server closes.
/// Returns nothing if the client cannot connect: so many clients in a second can use up the machine's ports.
inline std::optional<WebReply> web_reply(const Address& server, const std::string& request, const std::string& frames) {
  using boost::asio::ip::tcp;
  boost::asio::io_context io;
  tcp::socket socket(io);
  boost::system::error_code gone;
  socket.connect(tcp::endpoint(boost::asio::ip::make_address(server.host), server.port), gone);
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
  return WebReply{bytes.substr(0, size), bytes.substr(size)};
}

/// The request for a WebSocket.
inline std::string web_socket_request(std::string_view path) {
  return "GET " + std::string(path) +
         " HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
}

/// A frame of a client, which is masked; by zeros, so that the payload stands in it as it is (RFC 6455, 5.2).
inline std::string web_socket_frame(unsigned opcode, std::string_view payload) {
  constexpr std::size_t kMaxShort = 125;
  const bool is_short = payload.size() <= kMaxShort;
  std::string frame = {static_cast<char>(0x80U | opcode),
                       static_cast<char>(0x80U | (is_short ? payload.size() : 126U))};
  if (!is_short) frame += {static_cast<char>(payload.size() >> 8U), static_cast<char>(payload.size() & 0xFFU)};
  return frame + std::string(4, '\0') + std::string(payload);
}

}  // namespace yuragi::fuzz
