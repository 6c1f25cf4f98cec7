#pragma once

#include <string>

#include <boost/asio/ip/address.hpp>

namespace yuragi::simulators::core {

/// A numeric address, or localhost. Throws std::runtime_error for any other text.
boost::asio::ip::address socket_address(const std::string& host);

}  // namespace yuragi::simulators::core
