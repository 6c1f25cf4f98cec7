// Datagrams that come to a local port, on a socket of Boost.Asio's. A multicast address is joined.
#include <cerrno>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/ip/udp.hpp>

#include "drivers/bus/descriptor_port.hpp"

namespace yuragi::drivers::bus {
namespace {

using boost::asio::ip::udp;
namespace ip = boost::asio::ip;

/// IPv4 addresses that came through an IPv6 socket look like it; people write them as they are.
ip::address plain(const ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return ip::make_address_v4(ip::v4_mapped, address.to_v6());
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
    sender_ = address().sender.empty() ? ip::address() : plain(ip::make_address(address().sender, error));
    if (error) return Failure{"sender: \"" + address().sender + "\" is no address"};

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
    udp::endpoint from;
    boost::system::error_code error;
    const std::size_t size = socket_.receive_from(boost::asio::buffer(buffer.data(), buffer.size()), from, 0, error);
    if (error == boost::asio::error::would_block || error == boost::asio::error::interrupted) {
      return {ByteStatus::kSilence};
    }
    if (error) return {ByteStatus::kLost};
    if (!address().sender.empty() && plain(from.address()) != sender_) return {ByteStatus::kForeign};
    return size > 0 ? ByteArrival{ByteStatus::kBytes, size, true} : ByteArrival{};
  }

  /// There is no address to send to: the senders are not known.
  bool write(std::span<const std::uint8_t> /*bytes*/) override { return false; }

 protected:
  int descriptor() noexcept override { return socket_.is_open() ? socket_.native_handle() : -1; }

 private:
  boost::system::error_code listen(const ip::address& local) {
    boost::system::error_code error;
    const udp::endpoint endpoint(local, address().port);
    if (socket_.open(endpoint.protocol(), error) || socket_.non_blocking(true, error)) return error;
    if (!local.is_multicast()) {
      // Not shared: the last one to bind would get everything, and the others nothing, without an error.
      socket_.bind(endpoint, error);
      return error;
    }
    if (socket_.set_option(udp::socket::reuse_address(true), error) || socket_.bind(endpoint, error)) return error;
    socket_.set_option(ip::multicast::join_group(local), error);
    return error;
  }

  boost::asio::io_context context_;
  udp::socket socket_{context_};
  ip::address sender_;
};

}  // namespace

std::unique_ptr<BytePort> make_udp_port(const BytePortAddress& address) {
  return std::make_unique<UdpBytePort>(address);
}

}  // namespace yuragi::drivers::bus
