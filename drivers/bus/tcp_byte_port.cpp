// A TCP client, on a socket of Boost.Asio's that never blocks.
#include <cerrno>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "drivers/bus/descriptor_port.hpp"
#include "drivers/bus/host_lookup.hpp"
#include "engine/base/close_on_exec.hpp"

namespace yuragi::drivers::bus {
namespace {

using boost::asio::ip::tcp;

class TcpBytePort final : public DescriptorPort {
 public:
  explicit TcpBytePort(const BytePortAddress& address) : DescriptorPort(address), lookup_(address.host, address.port) {}

  Result<void, Failure> open() override {
    close();
    if (interruption().is_set()) return Failure{"interrupted"};
    const auto endpoints = lookup_.find(address().connect_timeout);
    if (!endpoints) return endpoints.error();

    // The addresses share the time, so that one that swallows everything leaves some to the next.
    const auto count = static_cast<std::int64_t>(endpoints->size());
    boost::system::error_code error;
    for (const tcp::endpoint& endpoint : *endpoints) {
      error = connect(endpoint, address().connect_timeout / count);
      if (!error) return {};
      close();
    }
    if (interruption().is_set()) return Failure{"interrupted"};
    return Failure{"cannot connect to " + describe(address()) + " (" + error.message() +
                   "): check the host and port, the network, and that the device or server is switched on"};
  }

  void close() noexcept override {
    boost::system::error_code ignored;
    socket_.close(ignored);
  }

  void interrupt() noexcept override {
    DescriptorPort::interrupt();
    lookup_.interrupt();
  }

 protected:
  int descriptor() noexcept override { return socket_.is_open() ? socket_.native_handle() : -1; }

 private:
  boost::system::error_code connect(const tcp::endpoint& endpoint, Nanoseconds timeout) {
    boost::system::error_code error;
    if (socket_.open(endpoint.protocol(), error)) return error;
    close_on_exec(socket_.native_handle());
    if (socket_.non_blocking(true, error)) return error;
    set_keep_alive();

    const int handle = socket_.native_handle();
    if (::connect(handle, endpoint.data(), static_cast<socklen_t>(endpoint.size())) == 0) return {};
    if (errno != EINPROGRESS) return {errno, boost::system::system_category()};
    if (interruption().wait(handle, WaitFor::kWritable, timeout) != WaitEnd::kReady) {
      return {ETIMEDOUT, boost::system::system_category()};
    }
    int result = 0;
    socklen_t size = sizeof result;
    if (getsockopt(handle, SOL_SOCKET, SO_ERROR, &result, &size) != 0) result = errno;
    return {result, boost::system::system_category()};
  }

  /// A peer that vanished silently is noticed after about 25 s, even if nothing is ever sent to it.
  void set_keep_alive() {
    boost::system::error_code ignored;
    socket_.set_option(boost::asio::socket_base::keep_alive(true), ignored);
    socket_.set_option(tcp::no_delay(true), ignored);
    const auto set = [this](int option, int value) {
      setsockopt(socket_.native_handle(), IPPROTO_TCP, option, &value, sizeof value);
    };
    set(TCP_KEEPIDLE, 10);
    set(TCP_KEEPINTVL, 5);
    set(TCP_KEEPCNT, 3);
  }

  HostLookup lookup_;
  boost::asio::io_context context_;
  tcp::socket socket_{context_};
};

}  // namespace

std::unique_ptr<BytePort> make_tcp_port(const BytePortAddress& address) {
  return std::make_unique<TcpBytePort>(address);
}

}  // namespace yuragi::drivers::bus
