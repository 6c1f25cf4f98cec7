#include "engine/base/address.hpp"

#include <charconv>

namespace yuragi {

Result<Address, Failure> parse_address(std::string_view text, std::optional<std::uint16_t> default_port) {
  const auto refuse = [&] {
    return Failure{
        "'" + std::string(text) +
        "' is not an address; write HOST:PORT, such as 127.0.0.1:7410 or [::1]:7410, with a port up to 65535"};
  };
  // What follows the host, with its colon. The colons of an IPv6 address stand in brackets.
  const bool is_bracketed = text.starts_with('[');
  const std::size_t host_end = is_bracketed ? text.find(']') : text.find(':');
  if (is_bracketed && host_end == std::string_view::npos) return refuse();
  const std::string_view host = is_bracketed ? text.substr(1, host_end - 1) : text.substr(0, host_end);
  const std::string_view rest =
      host_end == std::string_view::npos ? "" : text.substr(host_end + (is_bracketed ? 1 : 0));

  const bool has_colons = host.find(':') != std::string_view::npos;
  if (host.empty() || is_bracketed != has_colons || host.find_first_of("[] \t\n") != std::string_view::npos)
    return refuse();

  Address address{std::string(host)};
  if (rest.empty() && default_port) {
    address.port = *default_port;
    return address;
  }
  if (!rest.starts_with(':')) return refuse();
  const auto [end, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), address.port);
  if (error != std::errc() || end != rest.data() + rest.size()) return refuse();
  return address;
}

std::string to_string(const Address& address) {
  const bool has_colons = address.host.find(':') != std::string::npos;
  return (has_colons ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port);
}

}  // namespace yuragi
