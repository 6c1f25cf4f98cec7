#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

namespace yuragi::simulators::core {

/// A TCP server's listening socket, which can be closed and opened again at the same place. Neither it nor the sockets
/// that it accepts block. Thread-safe: no.
class TcpListener {
 public:
  /// Listens; port 0 takes a free one. Throws std::runtime_error for a host that is no numeric address, and if it
  /// cannot listen there.
  TcpListener(const std::string& host, std::uint16_t port);

  /// The address at which it listens, or listened last.
  const boost::asio::ip::tcp::endpoint& endpoint() const noexcept { return endpoint_; }
  bool is_open() const { return acceptor_.is_open(); }
  /// While it is open.
  int descriptor() { return acceptor_.native_handle(); }

  /// Returns a client that has connected; nullopt if none has.
  std::optional<boost::asio::ip::tcp::socket> accept();

  void close();
  /// Returns false if the address is in use.
  bool open_again();

 private:
  boost::system::error_code open();

  boost::asio::io_context context_;
  boost::asio::ip::tcp::endpoint endpoint_;
  boost::asio::ip::tcp::acceptor acceptor_{context_};
};

}  // namespace yuragi::simulators::core
