#include "drivers/bus/datagram_inquiry.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/ip/udp.hpp>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>

#include "drivers/bus/byte_port.hpp"
#include "engine/base/close_on_exec.hpp"

namespace yuragi::drivers::bus {
namespace {

using boost::asio::ip::address_v4;
using boost::asio::ip::udp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxAnswers = 1000;
constexpr std::array<std::chrono::seconds, 3> kAskedAfter = {std::chrono::seconds(0), std::chrono::seconds(1),
                                                             std::chrono::seconds(3)};

/// An interface that is up and has an IPv4 address.
struct Interface {
  address_v4 address = {};
  address_v4 broadcast = {};
  bool can_broadcast = false;
  bool can_multicast = false;
};

address_v4 address_in(const sockaddr* address) {
  return address_v4(ntohl(reinterpret_cast<const sockaddr_in*>(address)->sin_addr.s_addr));
}

std::vector<Interface> interfaces() {
  std::vector<Interface> found;
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return found;
  for (const ifaddrs* each = first; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET || (each->ifa_flags & IFF_UP) == 0U) continue;
    Interface one{.address = address_in(each->ifa_addr)};
    one.can_broadcast = (each->ifa_flags & IFF_BROADCAST) != 0U && each->ifa_broadaddr != nullptr;
    one.can_multicast = (each->ifa_flags & IFF_MULTICAST) != 0U;
    if (one.can_broadcast) one.broadcast = address_in(each->ifa_broadaddr);
    found.push_back(one);
  }
  freeifaddrs(first);
  return found;
}

/// Sends the question to all its destinations. Returns the last error if it could not be sent to any.
error_code ask(udp::socket& socket, const DatagramInquiry& inquiry, const address_v4* to) {
  error_code error = boost::asio::error::network_unreachable;
  bool is_sent = false;
  const auto send_to = [&](const address_v4& address) {
    socket.send_to(boost::asio::buffer(inquiry.question), udp::endpoint(address, inquiry.port), 0, error);
    is_sent = is_sent || !error;
  };
  if (to != nullptr && !to->is_multicast()) {
    send_to(*to);
  } else {
    for (const Interface& each : interfaces()) {
      if (to == nullptr && each.can_broadcast) send_to(each.broadcast);
      if (to == nullptr || !each.can_multicast) continue;
      if (!socket.set_option(boost::asio::ip::multicast::outbound_interface(each.address), error)) send_to(*to);
    }
  }
  return is_sent ? error_code() : error;
}

/// Waits until a datagram is there, or it is that time.
void wait_for_datagram(udp::socket& socket, Clock::time_point until) {
  const auto rest = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
  pollfd wait{.fd = socket.native_handle(), .events = POLLIN, .revents = 0};
  if (rest.count() > 0) poll(&wait, 1, static_cast<int>(std::min<std::int64_t>(rest.count(), 1000)));
}

}  // namespace

Result<std::vector<DatagramAnswer>, Failure> ask_networks(const DatagramInquiry& inquiry) {
  error_code error;
  address_v4 to;
  if (!inquiry.to.empty()) to = boost::asio::ip::make_address_v4(inquiry.to, error);
  if (error) return Failure{"\"" + inquiry.to + "\" is not an IPv4 address", FailureKind::kUsage};
  boost::asio::io_context context;
  udp::socket socket(context);
  socket.open(udp::v4(), error);
  if (!error) close_on_exec(socket.native_handle());
  if (error || socket.set_option(udp::socket::broadcast(true), error) ||
      socket.set_option(boost::asio::ip::multicast::hops(1), error) ||
      socket.bind(udp::endpoint(udp::v4(), 0), error) || socket.non_blocking(true, error))
    return Failure{"cannot open a UDP socket: " + error.message(), FailureKind::kUnavailable};

  std::vector<DatagramAnswer> answers;
  std::vector<std::uint8_t> buffer(kMaxDatagram);
  const auto start = Clock::now();
  const auto end = start + inquiry.duration;
  for (std::size_t asked = 0; Clock::now() < end && answers.size() < kMaxAnswers;) {
    if (asked < kAskedAfter.size() && Clock::now() >= start + kAskedAfter.at(asked)) {
      error = ask(socket, inquiry, inquiry.to.empty() ? nullptr : &to);
      if (error && asked == 0)
        return Failure{"cannot send the request to any network: " + error.message(), FailureKind::kUnavailable};
      ++asked;
    }
    wait_for_datagram(socket, asked < kAskedAfter.size() ? std::min(end, start + kAskedAfter.at(asked)) : end);
    udp::endpoint from;
    const std::size_t size = socket.receive_from(boost::asio::buffer(buffer), from, 0, error);
    if (error) continue;  // nothing received, or a host has reported that the port is closed
    DatagramAnswer answer{{buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size)},
                          from.address().to_string()};
    if (std::ranges::find(answers, answer) == answers.end()) answers.push_back(std::move(answer));
  }
  return answers;
}

}  // namespace yuragi::drivers::bus
