#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>

namespace yuragi::daemon::feeds {

/// A program that listens on a free port of this machine.
class Receiver {
 public:
  using Datagram = std::vector<std::uint8_t>;

  std::string address() const { return "127.0.0.1:" + std::to_string(port()); }
  std::uint16_t port() const { return socket_.local_endpoint().port(); }

  /// The datagrams that have arrived.
  std::vector<Datagram> datagrams() {
    std::vector<Datagram> all;
    while (socket_.available() > 0) {
      Datagram datagram(65'536);
      datagram.resize(socket_.receive(boost::asio::buffer(datagram)));
      all.push_back(std::move(datagram));
    }
    return all;
  }

 private:
  boost::asio::io_context io_;
  boost::asio::ip::udp::socket socket_{io_, boost::asio::ip::udp::endpoint(boost::asio::ip::address_v4::loopback(), 0)};
};

}  // namespace yuragi::daemon::feeds
