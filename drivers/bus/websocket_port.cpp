// A client of a WebSocket server (I. Fette and A. Melnikov, RFC 6455, "The WebSocket Protocol", 2011), by Boost.Beast.
// Pings are answered, and the server is pinged, while somebody reads; there is no thread behind it.
#include <algorithm>
#include <array>
#include <cctype>
#include <new>
#include <optional>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/bind_handler.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/beast/http/status.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include "drivers/bus/descriptor_port.hpp"
#include "drivers/bus/host_lookup.hpp"
#include "drivers/bus/tcp_connect.hpp"

namespace yuragi::drivers::bus {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;

/// A server that accepts no bytes for this time will not accept them later.
constexpr Nanoseconds kMessagePatience = std::chrono::seconds(1);

class WebSocketSocket : public asio::ip::tcp::socket {
 public:
  using asio::ip::tcp::socket::socket;
};

/// Called by Beast after the closing frames: closes at once, because a server may never close its side.
template <class Handler>
void async_teardown(beast::role_type /*role*/, WebSocketSocket& socket, Handler&& handler) {
  error_code ignored;
  socket.close(ignored);
  asio::post(socket.get_executor(), beast::bind_front_handler(std::forward<Handler>(handler), error_code()));
}

/// A connection and its pending operations, which its handlers own, too. Messages are never compressed.
struct WebSocketConnection {
  explicit WebSocketConnection(asio::io_context& context) : stream(context) {}

  websocket::stream<WebSocketSocket, false> stream;
  websocket::response_type response;
  std::optional<error_code> handshake;  ///< how it has ended
  beast::flat_buffer message;
  bool is_reading = false;
  std::optional<error_code> arrival;  ///< how reading the message has ended
  std::vector<std::uint8_t> sent;
  std::optional<error_code> sending;  ///< how it has ended
};

/// Makes a connected socket the stream's own.
error_code adopt(int socket, asio::ip::tcp::socket& stream) {
  int family = AF_INET;
  socklen_t size = sizeof family;
  getsockopt(socket, SOL_SOCKET, SO_DOMAIN, &family, &size);
  error_code error;
  if (stream.assign(family == AF_INET6 ? asio::ip::tcp::v6() : asio::ip::tcp::v4(), socket, error)) ::close(socket);
  return error;
}

class WebSocketPort final : public BytePort {
 public:
  explicit WebSocketPort(const BytePortAddress& address) : address_(address), lookup_(address.host, address.port) {}
  ~WebSocketPort() override { close(); }

  Result<void, Failure> open() override {
    close();
    if (interruption_.is_set()) return Failure{"interrupted"};
    const auto socket = connect_tcp(lookup_, address_.connect_timeout, interruption_);
    if (interruption_.is_set()) {
      if (socket) ::close(*socket);
      return Failure{"interrupted"};
    }
    if (!socket) {
      return Failure{"cannot connect to " + describe(address_) + " (" + socket.error().message +
                     "): check the host and port, the network, and that the server is switched on"};
    }
    connection_ = std::make_shared<WebSocketConnection>(context_);
    if (const error_code error = adopt(*socket, connection_->stream.next_layer())) {
      connection_.reset();
      return Failure{"cannot use a connection to " + describe(address_) + " (" + error.message() + ")"};
    }
    set_up(connection_->stream);
    connection_->stream.async_handshake(
        connection_->response, fmt::format("{}:{}", host_of_url(), address_.port), address_.path,
        [connection = connection_](const error_code& error) { connection->handshake = error; });
    run(address_.connect_timeout, [this] { return connection_->handshake.has_value(); });
    if (connection_->handshake == error_code()) return {};
    const std::string why = trouble_of_handshake();
    drop();
    return Failure{why};
  }

  /// Says so to the server, without a wait.
  void close() noexcept override {
    if (!connection_) return;
    try {
      if (connection_->stream.is_open()) {
        connection_->stream.async_close(websocket::close_code::going_away,
                                        [connection = connection_](const error_code& /*error*/) {});
        context_.restart();
        context_.poll();
      }
    } catch (const std::bad_alloc&) {
      // The server gets no closing frame, and notices only that the connection ends.
    }
    drop();
  }

  ByteArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) override {
    if (interruption_.is_set()) return {ByteStatus::kInterrupted};
    if (!connection_) return {ByteStatus::kLost};
    WebSocketConnection& connection = *connection_;
    if (!connection.is_reading && !connection.arrival) {
      connection.is_reading = true;
      connection.stream.async_read(connection.message,
                                   [owned = connection_](const error_code& error, std::size_t /*size*/) {
                                     owned->is_reading = false;
                                     owned->arrival = error;
                                   });
    }
    run(timeout, [&connection] { return connection.arrival.has_value(); });
    if (!connection.arrival) {
      return {interruption_.is_set() ? ByteStatus::kInterrupted : ByteStatus::kSilence};
    }
    if (connection.arrival != error_code()) return {ByteStatus::kLost};

    connection.arrival.reset();
    const std::size_t size = asio::buffer_copy(asio::buffer(buffer.data(), buffer.size()), connection.message.data());
    connection.message.clear();
    if (size == 0) return {ByteStatus::kSilence};
    return {.status = ByteStatus::kBytes, .size = size, .is_whole_datagram = true};
  }

  bool write(std::span<const std::uint8_t> bytes) override {
    if (!connection_) return false;
    connection_->sent.assign(bytes.begin(), bytes.end());
    connection_->sending.reset();
    connection_->stream.async_write(
        asio::buffer(connection_->sent),
        [connection = connection_](const error_code& error, std::size_t /*size*/) { connection->sending = error; });
    run(kMessagePatience, [this] { return connection_->sending.has_value(); });
    if (connection_->sending == error_code()) return true;
    drop();  // a message that is half sent cannot be taken back
    return false;
  }

  void interrupt() noexcept override {
    interruption_.set();
    lookup_.interrupt();
    context_.stop();
  }

 private:
  template <class Stream>
  void set_up(Stream& stream) const {
    stream.set_option(websocket::stream_base::timeout{.handshake_timeout = address_.connect_timeout,
                                                      .idle_timeout = address_.idle_timeout,
                                                      .keep_alive_pings = true});
    stream.set_option(websocket::stream_base::decorator([token = address_.token](websocket::request_type& request) {
      if (!token.is_empty()) request.set(beast::http::field::authorization, "Bearer " + token.reveal());
    }));
    stream.read_message_max(kMaxDatagram);
    stream.text(true);
  }

  /// Runs the connection until the condition is true, the time is over, or the wait is interrupted; after that only
  /// without waiting.
  template <class Condition>
  void run(Nanoseconds timeout, Condition&& has_happened) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    if (interruption_.is_set()) context_.restart();
    context_.poll();
    while (!has_happened() && !interruption_.is_set() && context_.run_one_until(end) > 0) {
    }
  }

  /// Ends the connection and all pending operations.
  void drop() noexcept {
    error_code ignored;
    connection_->stream.next_layer().close(ignored);
    connection_.reset();
  }

  std::string host_of_url() const {
    return address_.host.find(':') == std::string::npos ? address_.host : "[" + address_.host + "]";
  }

  std::string trouble_of_handshake() const {
    const std::string where = describe(address_);
    if (!connection_->handshake) {
      return interruption_.is_set() ? "interrupted"
                                    : where + " does not reply: check that a WebSocket server uses this port";
    }
    if (*connection_->handshake != websocket::error::upgrade_declined) {
      return fmt::format("{} is not a WebSocket server ({}): check host and port", where,
                         connection_->handshake->message());
    }
    const beast::http::status status = connection_->response.result();
    const auto reason = beast::http::obsolete_reason(status);
    return fmt::format("{} refuses the connection (HTTP {} {}): {}", where, connection_->response.result_int(),
                       std::string_view(reason.data(), reason.size()), remedy_of(status));
  }

  std::string_view remedy_of(beast::http::status status) const {
    if (status == beast::http::status::unauthorized || status == beast::http::status::forbidden)
      return address_.token.is_empty() ? "it requires a token: set token" : "check the token, which may have expired";
    if (status == beast::http::status::not_found) return "check the path";
    return "check the server";
  }

  BytePortAddress address_;
  HostLookup lookup_;
  Interruption interruption_;
  asio::io_context context_{1};
  asio::executor_work_guard<asio::io_context::executor_type> work_ = asio::make_work_guard(context_);
  std::shared_ptr<WebSocketConnection> connection_;
};

}  // namespace

std::unique_ptr<BytePort> make_websocket_port(const BytePortAddress& address) {
  return std::make_unique<WebSocketPort>(address);
}

}  // namespace yuragi::drivers::bus
