// Datagrams that come to a local port, on a socket of Boost.Asio's. A multicast address is joined.
#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/ip/udp.hpp>
#include <sys/socket.h>

#include "drivers/bus/descriptor_port.hpp"
#include "drivers/bus/sender_filter.hpp"
#include "engine/base/close_on_exec.hpp"

namespace yuragi::drivers::bus {
namespace {

using boost::asio::ip::udp;
namespace ip = boost::asio::ip;

/// One datagram as it was received.
struct Datagram {
  ssize_t size = -1;  ///< negative: failed, with the reason in errno
  udp::endpoint from;
  std::uint32_t dropped = 0;  ///< datagrams that the kernel has dropped since the socket was opened; 0: not reported
};

/// With SO_RXQ_OVFL the kernel adds its count of dropped datagrams to each one that follows them (socket(7)).
Datagram receive(int socket, std::span<std::uint8_t> buffer) {
  Datagram datagram;
  iovec where{.iov_base = buffer.data(), .iov_len = buffer.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof datagram.dropped)> more{};
  msghdr message{};
  message.msg_name = datagram.from.data();
  message.msg_namelen = static_cast<socklen_t>(datagram.from.capacity());
  message.msg_iov = &where;
  message.msg_iovlen = 1;
  message.msg_control = more.data();
  message.msg_controllen = more.size();
  datagram.size = recvmsg(socket, &message, 0);
  if (datagram.size < 0) return datagram;
  datagram.from.resize(message.msg_namelen);
  const cmsghdr* const header = CMSG_FIRSTHDR(&message);
  if (header != nullptr && header->cmsg_level == SOL_SOCKET && header->cmsg_type == SO_RXQ_OVFL) {
    std::memcpy(&datagram.dropped, CMSG_DATA(header), sizeof datagram.dropped);
  }
  return datagram;
}

std::string udp_remedy_of(int error) {
  if (error == EADDRINUSE) return "another program uses this port; end it, or choose another port";
  if (error == EADDRNOTAVAIL)
    return "this machine does not have that address; leave host empty to listen on all of them";
  if (error == EACCES) return "ports below 1024 need a privilege; choose a higher one";
  return "check host and port";
}

class UdpBytePort final : public DescriptorPort {
 public:
  using DescriptorPort::DescriptorPort;

  Result<void, Failure> open() override {
    close();
    if (interruption().is_set()) return Failure{"interrupted"};
    boost::system::error_code error;
    const auto local =
        address().host.empty() ? ip::address(ip::address_v4::any()) : ip::make_address(address().host, error);
    if (error)
      return Failure{"host: \"" + address().host + "\" is not an address of this machine; leave it empty for all"};
    auto filter = SenderFilter::parse(address().senders);
    if (!filter) return Failure{"sender: " + filter.error().message};
    filter_ = std::move(*filter);

    error = listen(local);
    if (!error) return {};
    close();
    return Failure{"cannot listen at " + describe(address()) + " (" + error.message() +
                   "): " + udp_remedy_of(error.value())};
  }

  void close() noexcept override {
    boost::system::error_code ignored;
    socket_.close(ignored);
  }

  ByteArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) override {
    if (!socket_.is_open()) return {ByteStatus::kLost};
    switch (interruption().wait(socket_.native_handle(), WaitFor::kReadable, timeout)) {
      case WaitEnd::kInterrupted:
        return {ByteStatus::kInterrupted};
      case WaitEnd::kTimeout:
        return {ByteStatus::kSilence};
      case WaitEnd::kReady:
        break;
    }
    const Datagram datagram = receive(socket_.native_handle(), buffer);
    if (datagram.size < 0) return {errno == EAGAIN || errno == EINTR ? ByteStatus::kSilence : ByteStatus::kLost};

    ByteArrival arrival;
    if (datagram.dropped != 0) arrival.overrun = datagram.dropped - std::exchange(dropped_, datagram.dropped);
    if (!filter_.takes(datagram.from.address())) {
      arrival.status = ByteStatus::kForeign;
      arrival.sender = plain_address(datagram.from.address()).to_string();
    } else if (datagram.size > 0) {
      arrival.status = ByteStatus::kBytes;
      arrival.size = static_cast<std::size_t>(datagram.size);
      arrival.is_whole_datagram = true;
    }
    return arrival;
  }

  /// There is no address to send to: the senders are not known.
  bool write(std::span<const std::uint8_t> /*bytes*/) override { return false; }

 protected:
  int descriptor() noexcept override { return socket_.is_open() ? socket_.native_handle() : -1; }

 private:
  boost::system::error_code listen(const ip::address& local) {
    boost::system::error_code error;
    const udp::endpoint endpoint(local, address().port);
    if (socket_.open(endpoint.protocol(), error)) return error;
    close_on_exec(socket_.native_handle());
    if (socket_.non_blocking(true, error)) return error;
    const int yes = 1;
    setsockopt(socket_.native_handle(), SOL_SOCKET, SO_RXQ_OVFL, &yes, sizeof yes);  // without it no drops are counted
    dropped_ = 0;
    // Shared only if requested: otherwise the last program to bind would receive all datagrams to this machine alone,
    // and the others none, without an error.
    const bool is_shared = local.is_multicast() || address().is_port_shared;
    if (is_shared && socket_.set_option(udp::socket::reuse_address(true), error)) return error;
    if (socket_.bind(endpoint, error)) return error;
    if (local.is_multicast()) socket_.set_option(ip::multicast::join_group(local), error);
    return error;
  }

  boost::asio::io_context context_;
  udp::socket socket_{context_};
  SenderFilter filter_;
  std::uint32_t dropped_ = 0;  ///< the kernel's count as last reported
};

}  // namespace

std::unique_ptr<BytePort> make_udp_port(const BytePortAddress& address) {
  return std::make_unique<UdpBytePort>(address);
}

}  // namespace yuragi::drivers::bus
