#include "daemon/feeds/datagram_target.hpp"

#include <array>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/ip/udp.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "drivers/bus/host_lookup.hpp"
#include "engine/base/address.hpp"

namespace yuragi::daemon::feeds {
namespace {

namespace asio = boost::asio;
using asio::ip::udp;

/// A socket that cannot be used is opened anew at this interval, when a host may have another address.
constexpr auto kOpenAgainAfter = std::chrono::seconds(5);
/// A trouble that has not come again for so long is over: a receiver's machine refuses only some of the datagrams.
constexpr auto kOverAfter = std::chrono::seconds(5);

std::string text_of(const boost::system::error_code& error, const std::string& address) {
  if (error == asio::error::connection_refused)
    return fmt::format("nothing listens at {}: start the receiver, or correct the port", address);
  return fmt::format("cannot send to {} ({}): check the network", address, error.message());
}

}  // namespace

struct DatagramTarget::Socket {
  explicit Socket(const Address& address) : lookup(address.host, address.port) {}

  drivers::bus::HostLookup lookup;
  asio::io_context io{1};
  udp::socket socket{io};
};

DatagramTarget::DatagramTarget(std::string feed, const std::string& address, std::string interface)
    : feed_(std::move(feed)),
      address_(address),
      interface_(std::move(interface)),
      socket_(std::make_unique<Socket>(parse_address(address).value())) {}
DatagramTarget::~DatagramTarget() {
  socket_->lookup.interrupt();
}

/// Connected, so that the machine of the receiver can refuse.
void DatagramTarget::open(MonoTime now) {
  if (opened_ && now - *opened_ < kOpenAgainAfter && !socket_->lookup.is_under_way()) return;
  opened_ = now;
  const auto found = socket_->lookup.find(Nanoseconds(0));
  if (!found) {
    if (!socket_->lookup.is_under_way()) note(found.error().message, now);
    return;
  }
  const udp::endpoint endpoint(found->front().address(), found->front().port());
  boost::system::error_code error;
  udp::socket& socket = socket_->socket;
  socket.open(endpoint.protocol(), error);
  if (!error) socket.non_blocking(true, error);
  if (!error && endpoint.address().is_v4()) socket.set_option(asio::socket_base::broadcast(true), error);
  if (!error && endpoint.address().is_multicast()) socket.set_option(asio::ip::multicast::hops(1), error);
  if (!error && !interface_.empty() && endpoint.address().is_multicast()) {
    const auto own = asio::ip::make_address_v4(interface_, error);
    if (!error) socket.set_option(asio::ip::multicast::outbound_interface(own), error);
  }
  if (!error) socket.connect(endpoint, error);
  if (!error) return;
  note(text_of(error, address_), now);
  boost::system::error_code ignored;
  socket.close(ignored);
}

void DatagramTarget::send(std::span<const std::uint8_t> datagram, MonoTime now) {
  if (!socket_->socket.is_open()) open(now);
  if (!socket_->socket.is_open()) return;
  boost::system::error_code error;
  const asio::const_buffer buffer(datagram.data(), datagram.size());
  socket_->socket.send(buffer, 0, error);
  if (error == asio::error::connection_refused) {
    // The refusal of an earlier datagram; this one has not been sent yet.
    note(text_of(error, address_), now);
    socket_->socket.send(buffer, 0, error);
  }
  if (error) {
    // A full buffer of the system is no trouble: the next moment is newer.
    if (error != asio::error::would_block) note(text_of(error, address_), now);
    return;
  }
  ++messages_;
  bytes_ += datagram.size();
  last_sent_ = now;
  if (!trouble_.empty() && now - *failed_ >= kOverAfter) {
    trouble_.clear();
    spdlog::info("feed {}: sends to {} again", feed_, address_);
  }
}

void DatagramTarget::note(const std::string& trouble, MonoTime now) {
  failed_ = now;
  if (trouble_.empty()) spdlog::warn("feed {}: {}; it is tried again", feed_, trouble);
  trouble_ = trouble;
}

}  // namespace yuragi::daemon::feeds
