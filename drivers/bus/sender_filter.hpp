#pragma once

#include <string>
#include <vector>

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/network_v4.hpp>
#include <boost/asio/ip/network_v6.hpp>

#include "engine/base/result.hpp"

namespace yuragi::drivers::bus {

/// Selects the senders whose datagrams are accepted. Anybody in a sender's network can forge its address: this keeps
/// mistakes and strangers away, and does not replace a firewall.
///
/// Thread-safe: its const functions are.
class SenderFilter {
 public:
  /// From addresses and networks separated by commas: "192.168.1.20, 10.0.0.0/8, fd00::/8". Empty: takes any sender.
  /// The failure's text: which is neither an address nor a net.
  static Result<SenderFilter, Failure> parse(const std::string& senders);

  /// An IPv4 address that came through an IPv6 socket counts as IPv4.
  bool takes(const boost::asio::ip::address& sender) const;

  /// Returns true if each net of `other` lies in one of these.
  bool covers(const SenderFilter& other) const;

 private:
  std::vector<boost::asio::ip::network_v4> v4_;
  std::vector<boost::asio::ip::network_v6> v6_;
};

/// Returns true if `wide` takes every sender that `narrow` names; false if one of them is no list.
bool senders_cover(const std::string& wide, const std::string& narrow);

/// Converts an IPv4 address that was received on an IPv6 socket to its usual form.
boost::asio::ip::address plain_address(const boost::asio::ip::address& address);

/// Returns true if only programs of this machine can send to it. Fails if it is not an address.
Result<bool, Failure> is_loopback(const std::string& address);

}  // namespace yuragi::drivers::bus
