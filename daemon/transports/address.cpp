#include "daemon/transports/address.hpp"

#include <charconv>

namespace yuragi {

Result<Address, Failure> parse_address(std::string_view text) {
  const auto refuse = [&] {
    return Failure{"'" + std::string(text) + "' is no address: write HOST:PORT, like 127.0.0.1:7410 or [::1]:7410"};
  };
  const auto colon = text.rfind(':');
  if (colon == std::string_view::npos) return refuse();
  std::string_view host = text.substr(0, colon);
  const std::string_view port_text = text.substr(colon + 1);

  // Brackets around what has colons of its own, and around nothing else.
  const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (bracketed) host = host.substr(1, host.size() - 2);
  const bool has_colons = host.find(':') != std::string_view::npos;
  if (host.empty() || bracketed != has_colons || host.find_first_of("[] \t\n") != std::string_view::npos)
    return refuse();

  Address address{std::string(host)};
  const auto [end, error] = std::from_chars(port_text.data(), port_text.data() + port_text.size(), address.port);
  if (error != std::errc() || end != port_text.data() + port_text.size()) return refuse();
  return address;
}

std::string to_string(const Address& address) {
  const bool has_colons = address.host.find(':') != std::string::npos;
  return (has_colons ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port);
}

}  // namespace yuragi
