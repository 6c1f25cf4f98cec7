#include "simulators/core/socket_address.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace yuragi::simulators::core {

boost::asio::ip::address socket_address(const std::string& host) {
  boost::system::error_code error;
  auto address = boost::asio::ip::make_address(host == "localhost" ? "127.0.0.1" : host, error);
  if (error)
    throw std::runtime_error(fmt::format("\"{}\" is not an address; allowed: a numeric one such as 127.0.0.1", host));
  return address;
}

}  // namespace yuragi::simulators::core
