#include "drivers/bus/sender_filter.hpp"

#include <algorithm>
#include <sstream>

namespace yuragi::drivers::bus {
namespace {

namespace ip = boost::asio::ip;

constexpr unsigned short kIpv4Bits = 32;
constexpr unsigned short kIpv6Bits = 128;

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

/// Returns the same network for any of its addresses.
ip::network_v4 net_of(const ip::address_v4& address, unsigned short bits) {
  return ip::network_v4(address, bits).canonical();
}
/// Without the interface that a link-local address may name.
ip::network_v6 net_of(const ip::address_v6& address, unsigned short bits) {
  return ip::network_v6(ip::address_v6(address.to_bytes()), bits).canonical();
}

template <class Net, class Address>
bool is_in_any(const std::vector<Net>& nets, const Address& address) {
  return std::ranges::any_of(nets, [&address](const Net& net) { return net_of(address, net.prefix_length()) == net; });
}

template <class Net>
bool each_is_in(const std::vector<Net>& nets, const std::vector<Net>& others) {
  return std::ranges::all_of(others, [&nets](const Net& other) {
    return std::ranges::any_of(nets, [&other](const Net& net) {
      return net.prefix_length() <= other.prefix_length() && net_of(other.address(), net.prefix_length()) == net;
    });
  });
}

}  // namespace

Result<SenderFilter, Failure> SenderFilter::parse(const std::string& senders) {
  SenderFilter filter;
  std::istringstream list(senders);
  for (std::string entry; std::getline(list, entry, ',');) {
    entry = trimmed(entry);
    boost::system::error_code no_address;
    boost::system::error_code no_v4;
    boost::system::error_code no_v6;
    const ip::address address = plain_address(ip::make_address(entry, no_address));
    const ip::network_v4 v4 = ip::make_network_v4(entry, no_v4);
    const ip::network_v6 v6 = ip::make_network_v6(entry, no_v6);
    if (!no_address && address.is_v4()) {
      filter.v4_.push_back(net_of(address.to_v4(), kIpv4Bits));
    } else if (!no_address) {
      filter.v6_.push_back(net_of(address.to_v6(), kIpv6Bits));
    } else if (!no_v4) {
      filter.v4_.push_back(v4.canonical());
    } else if (!no_v6) {
      filter.v6_.push_back(v6.canonical());
    } else {
      return Failure{"\"" + entry + "\" is neither an address (192.168.1.20) nor a network (192.168.1.0/24)"};
    }
  }
  return filter;
}

bool SenderFilter::covers(const SenderFilter& other) const {
  return each_is_in(v4_, other.v4_) && each_is_in(v6_, other.v6_);
}

bool senders_cover(const std::string& wide, const std::string& narrow) {
  const auto nets = SenderFilter::parse(wide);
  const auto others = SenderFilter::parse(narrow);
  return nets && others && nets->covers(*others);
}

bool SenderFilter::takes(const ip::address& sender) const {
  if (v4_.empty() && v6_.empty()) return true;
  const ip::address plain = plain_address(sender);
  return plain.is_v4() ? is_in_any(v4_, plain.to_v4()) : is_in_any(v6_, plain.to_v6());
}

ip::address plain_address(const ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return ip::make_address_v4(ip::v4_mapped, address.to_v6());
}

Result<bool, Failure> is_loopback(const std::string& address) {
  boost::system::error_code error;
  const ip::address parsed = plain_address(ip::make_address(address, error));
  if (error) return Failure{"\"" + address + "\" is not an address"};
  return parsed.is_loopback();
}

}  // namespace yuragi::drivers::bus
