#pragma once

#include <memory>
#include <optional>
#include <utility>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/teardown.hpp>

namespace yuragi::daemon::http {

/// A client's connection, in the clear or by TLS: an asynchronous stream of Asio, also below Beast's WebSockets.
class ByteStream {
 public:
  using Tls = boost::beast::ssl_stream<boost::beast::tcp_stream&>;
  using executor_type = boost::beast::tcp_stream::executor_type;

  /// `tls`: null: in the clear. Otherwise tls().async_handshake() comes first.
  ByteStream(boost::asio::ip::tcp::socket socket, boost::asio::ssl::context* tls)
      : tcp_(std::make_unique<boost::beast::tcp_stream>(std::move(socket))) {
    if (tls != nullptr) tls_.emplace(*tcp_, *tls);
  }

  executor_type get_executor() noexcept { return tcp_->get_executor(); }
  bool is_tls() const { return tls_.has_value(); }
  boost::beast::tcp_stream& tcp() { return *tcp_; }
  boost::asio::ip::tcp::socket& socket() { return tcp_->socket(); }
  Tls& tls() { return *tls_; }

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    if (tls_) return tls_->async_read_some(buffers, std::forward<Handler>(handler));
    tcp_->async_read_some(buffers, std::forward<Handler>(handler));
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    if (tls_) return tls_->async_write_some(buffers, std::forward<Handler>(handler));
    tcp_->async_write_some(buffers, std::forward<Handler>(handler));
  }

  // Beast's WebSocket calls these to end a connection.
  friend void beast_close_socket(ByteStream& stream) {
    boost::system::error_code ignored;
    stream.socket().close(ignored);
  }
  template <class Handler>
  friend void async_teardown(boost::beast::role_type role, ByteStream& stream, Handler&& handler) {
    using boost::beast::websocket::async_teardown;
    if (stream.tls_) return async_teardown(role, *stream.tls_, std::forward<Handler>(handler));
    async_teardown(role, stream.socket(), std::forward<Handler>(handler));
  }

 private:
  std::unique_ptr<boost::beast::tcp_stream> tcp_;  // stays where it is: TLS refers to it
  std::optional<Tls> tls_;
};

}  // namespace yuragi::daemon::http
