#include "daemon/stream/tcp_listening.hpp"

#include <string>

#include <boost/asio/io_context.hpp>

#include "engine/base/address.hpp"
#include "engine/base/close_on_exec.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::stream {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

// A client that vanished without a word is noticed after 30 s + 3 * 10 s without an answer from its machine, and after
// the same time if something is on its way to it.
constexpr int kKeepAliveIdle_s = 30;
constexpr int kKeepAliveInterval_s = 10;
constexpr int kKeepAliveProbes = 3;
constexpr int kUnacknowledged_ms = 60'000;

/// A number that TCP takes as an option, for which Asio has no type.
template <int kName>
struct TcpNumber {
  int value;

  template <class Protocol>
  int level(const Protocol& /*protocol*/) const {
    return IPPROTO_TCP;
  }
  template <class Protocol>
  int name(const Protocol& /*protocol*/) const {
    return kName;
  }
  template <class Protocol>
  const int* data(const Protocol& /*protocol*/) const {
    return &value;
  }
  template <class Protocol>
  std::size_t size(const Protocol& /*protocol*/) const {
    return sizeof value;
  }
};

}  // namespace

asio::ip::address unmapped(const asio::ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
}

void keep_alive(tcp::socket& socket) {
  error_code ignored;  // without them a vanished client stays longer
  socket.set_option(asio::socket_base::keep_alive(true), ignored);
  socket.set_option(TcpNumber<TCP_KEEPIDLE>{kKeepAliveIdle_s}, ignored);
  socket.set_option(TcpNumber<TCP_KEEPINTVL>{kKeepAliveInterval_s}, ignored);
  socket.set_option(TcpNumber<TCP_KEEPCNT>{kKeepAliveProbes}, ignored);
  socket.set_option(TcpNumber<TCP_USER_TIMEOUT>{kUnacknowledged_ms}, ignored);
}

tcp::acceptor open_acceptor(asio::io_context& io, std::string_view listen) {
  const auto address = parse_address(listen);
  if (!address) throw FailureError({"cannot listen: " + address.error().message, FailureKind::kUnavailable});
  try {
    // SO_REUSEADDR, which this constructor sets, lets a restarted daemon have its port back at once.
    tcp::resolver resolver(io);
    const auto found = resolver.resolve(address->host, std::to_string(address->port), tcp::resolver::passive);
    tcp::acceptor acceptor(io, found.begin()->endpoint());
    close_on_exec(acceptor.native_handle());
    return acceptor;
  } catch (const boost::system::system_error& error) {
    const bool in_use = error.code() == asio::error::address_in_use;
    throw FailureError(
        {"cannot listen on " + std::string(listen) + ": " + error.code().message() +
             (in_use ? ". Another program uses this address, perhaps another yuragi: stop it, or choose another port."
                     : ". Choose an address of this machine, and a port above 1023."),
         FailureKind::kUnavailable});
  }
}

}  // namespace yuragi::daemon::stream
