#include "simulators/core/tcp_listener.hpp"

#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "simulators/core/socket_address.hpp"

namespace yuragi::simulators::core {

using boost::asio::ip::tcp;

TcpListener::TcpListener(const std::string& host, std::uint16_t port) : endpoint_(socket_address(host), port) {
  if (const auto error = open()) {
    std::ostringstream place;
    place << endpoint_;
    throw std::runtime_error(fmt::format("cannot listen on {} ({}): choose another port, or 0 for a free one",
                                         place.str(), error.message()));
  }
  endpoint_ = acceptor_.local_endpoint();
}

boost::system::error_code TcpListener::open() {
  boost::system::error_code error;
  const bool failed =
      acceptor_.open(endpoint_.protocol(), error) || acceptor_.set_option(tcp::acceptor::reuse_address(true), error) ||
      acceptor_.bind(endpoint_, error) || acceptor_.listen(8, error) || acceptor_.non_blocking(true, error);
  if (failed) close();
  return error;
}

std::optional<tcp::socket> TcpListener::accept() {
  for (;;) {
    boost::system::error_code error;
    tcp::socket client = acceptor_.accept(error);
    if (error) return std::nullopt;
    client.non_blocking(true, error);
    if (!error) return client;
  }
}

void TcpListener::close() {
  boost::system::error_code ignored;
  acceptor_.close(ignored);
}

bool TcpListener::open_again() {
  return is_open() || !open();
}

}  // namespace yuragi::simulators::core
