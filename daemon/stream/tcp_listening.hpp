#pragma once

#include <string_view>

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>

namespace yuragi::daemon::stream {

// Common parts of TCP servers.

/// Opens the listening socket at HOST:PORT. Throws FailureError (kUnavailable) with what to do.
boost::asio::ip::tcp::acceptor open_acceptor(boost::asio::io_context& io, std::string_view listen);

/// The address as IPv4 if an IPv4 client is on an IPv6 socket.
boost::asio::ip::address unmapped(const boost::asio::ip::address& address);

/// Lets the kernel check whether the other side is still there: a client that vanished is noticed within a minute.
void keep_alive(boost::asio::ip::tcp::socket& socket);

}  // namespace yuragi::daemon::stream
