#include "daemon/http/server.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/sslerr.h>

#include "daemon/http/byte_stream.hpp"
#include "daemon/http/certificate_files.hpp"
#include "daemon/http/file_body.hpp"
#include "daemon/http/upgrade.hpp"
#include "daemon/stream/tcp_listening.hpp"
#include "engine/base/address.hpp"
#include "engine/base/close_on_exec.hpp"
#include "engine/base/contain.hpp"

namespace yuragi::daemon::http {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace beast_http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;

constexpr auto kAcceptAgainAfter = std::chrono::milliseconds(100);

std::string text_of(beast::string_view text) {
  return {text.data(), text.size()};
}

Response plain(unsigned status, std::string text) {
  return {.status = status, .content_type = "text/plain; charset=utf-8", .body = std::move(text) + "\n"};
}

/// Returns the refusal of a request that cannot be read; nullopt if the connection has only ended.
std::optional<Response> refusal_of(const error_code& error) {
  if (error == beast_http::error::body_limit) return plain(413, "the body is too long");
  if (error == beast_http::error::header_limit || error == beast_http::error::buffer_overflow)
    return plain(431, "the header is too long");
  if (error == beast_http::error::end_of_stream) return std::nullopt;
  if (error.category() == error_code(beast_http::error::bad_method).category()) return plain(400, "this is not HTTP");
  return std::nullopt;
}

constexpr const char* kRetryAfter_s = "10";

/// An answer outside of Beast: to those who get no place, and to those who do not use TLS.
std::string bare_answer(std::string_view status, std::string_view fields, std::string_view text) {
  return fmt::format(
      "HTTP/1.1 {}\r\nContent-Type: text/plain; charset=utf-8\r\n{}Connection: close\r\nContent-Length: {}\r\n\r\n{}\n",
      status, fields, text.size() + 1, text);
}

/// Returns true if a handshake failed because the client sent a request in the clear.
bool is_clear_http(const error_code& error) {
  return error.category() == asio::error::get_ssl_category() &&
         ERR_GET_REASON(static_cast<unsigned long>(error.value())) == SSL_R_HTTP_REQUEST;
}

/// A file that is being sent.
struct Sending {
  Sending(asio::io_context& io, std::shared_ptr<const FileBody> file) : body(std::move(file)), pipe(io), patience(io) {}

  std::shared_ptr<const FileBody> body;
  beast_http::response<beast_http::empty_body> header{};
  std::optional<beast_http::response_serializer<beast_http::empty_body>> serializer{};
  asio::posix::stream_descriptor pipe;
  asio::steady_timer patience;  ///< with the disk
  std::array<char, 64UL * 1024> piece{};
  std::uint64_t left_bytes = 0;
};

/// One client: request after request. Kept alive by what it waits for.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  /// Why `client` gets no place of Limits::clients; nullopt if it gets one.
  using Admission = std::function<std::optional<std::string>(const stream::Peer& client)>;

  /// `tls`: null: in the clear.
  Connection(asio::io_context& io, tcp::socket socket, asio::ssl::context* tls, stream::Peer client,
             const Limits& limits, const Server::Handler& handler, Admission admission)
      : io_(io),
        stream_(std::move(socket), tls),
        client_(std::move(client)),
        limits_(limits),
        handler_(handler),
        admission_(std::move(admission)),
        buffer_(limits.header_bytes + limits.body_bytes) {}

  void begin() {
    if (!stream_.is_tls()) return read();
    error_code ignored;
    stream_.socket().set_option(tcp::no_delay(true), ignored);  // an answer takes several writes
    stream_.tcp().expires_after(limits_.time);
    stream_.tls().async_handshake(asio::ssl::stream_base::server, [self = shared_from_this()](const error_code& error) {
      self->go_on([&] { self->finish_handshake(error); });
    });
  }
  void end() {
    if (std::exchange(has_ended_, true)) return;  // its stream may be another's by now
    error_code ignored;
    stream_.socket().close(ignored);
    if (sending_) {
      sending_->pipe.close(ignored);
      sending_->patience.cancel();
    }
  }
  bool has_ended() const { return has_ended_; }
  const stream::Peer& client() const { return client_; }
  /// Returns true if it has a place of Limits::clients; before that it is one of Limits::newcomers.
  bool has_place() const { return has_place_; }

 private:
  /// Does what an event is about. An exception ends this connection, and no other.
  template <class Work>
  void go_on(Work&& work) {
    if (!contain("an HTTP connection", std::forward<Work>(work))) end();
  }

  void finish_handshake(const error_code& error) {
    if (has_ended_) return;
    if (!error) return read();
    if (!is_clear_http(error)) return end();
    bare_ = bare_answer("400 Bad Request", "", "this port is for HTTPS: the address begins with https://");
    asio::async_write(stream_.tcp(), asio::buffer(bare_),
                      [self = shared_from_this()](const error_code& failed, std::size_t) {
                        self->go_on([&] { failed || self->has_ended_ ? self->end() : self->hang_up_tcp(); });
                      });
  }

  void read() {
    parser_.emplace();
    parser_->header_limit(limits_.header_bytes);
    parser_->body_limit(limits_.body_bytes);
    stream_.tcp().expires_after(limits_.time);
    beast_http::async_read(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](const error_code& error, std::size_t) { self->go_on([&] { self->take(error); }); });
  }

  void take(const error_code& error) {
    if (has_ended_) return;
    if (error) {
      is_last_ = true;
      auto refusal = refusal_of(error);
      return refusal ? write(std::move(*refusal)) : end();
    }
    const auto& message = parser_->get();
    is_last_ = !message.keep_alive();
    is_head_ = message.method() == beast_http::verb::head;
    const auto field = [&message](beast_http::field name) { return text_of(message[name]); };
    const std::string target = text_of(message.target());
    const std::size_t mark = std::min(target.find('?'), target.size());
    const Request request{
        .method = text_of(message.method_string()),
        .path = target.substr(0, mark),
        .query = mark < target.size() ? target.substr(mark + 1) : std::string(),
        .host = field(beast_http::field::host),
        .origin = field(beast_http::field::origin),
        .fetch_site = text_of(message["Sec-Fetch-Site"]),
        .method_to_come = field(beast_http::field::access_control_request_method),
        .content_type = field(beast_http::field::content_type),
        .authorization = field(beast_http::field::authorization),
        .cookie = field(beast_http::field::cookie),
        .if_none_match = field(beast_http::field::if_none_match),
        .accept_encoding = field(beast_http::field::accept_encoding),
        .body = message.body(),
        .forwarded_for = text_of(message["X-Forwarded-For"]),
        .is_forwarded = message.count("Forwarded") + message.count("X-Forwarded-For") + message.count("X-Real-IP") > 0,
        .is_https = stream_.is_tls() || text_of(message["X-Forwarded-Proto"]) == "https",
        .is_websocket = parser_->upgrade() && beast::iequals(message[beast_http::field::upgrade], "websocket"),
        .client = client_};
    if (!request.is_websocket && !has_place_) {
      if (const auto why = admission_(client_)) {
        is_last_ = true;
        Response refusal = plain(503, *why);
        refusal.fields.emplace_back("Retry-After", kRetryAfter_s);
        return write(std::move(refusal));
      }
      has_place_ = true;
    }
    ask(request);
  }

  /// A handler that throws costs its answer only.
  void ask(const Request& request) {
    const auto waits = std::make_shared<bool>(true);
    const Reply reply = [self = shared_from_this(), waits](Response response) {
      if (std::exchange(*waits, false)) self->write(std::move(response));
    };
    contain(
        "an HTTP request", [&] { handler_(request, reply); },
        [&](const char*) { reply(plain(500, "this request could not be answered, which is a fault of the program")); });
  }

  void write(Response response) {
    if (has_ended_) return;
    if (response.take_over) return hand_over(response.take_over);
    if (response.file) return send_file(response);
    message_ = {};
    set_header(message_, response);
    message_.body() = std::move(response.body);
    message_.prepare_payload();
    if (is_head_) message_.body().clear();  // its length stays in the header
    stream_.tcp().expires_after(limits_.time);
    beast_http::async_write(stream_, message_, [self = shared_from_this()](const error_code& error, std::size_t) {
      self->go_on([&] { self->finish(error); });
    });
  }

  template <class Message>
  void set_header(Message& message, const Response& response) const {
    message.version(11);
    message.result(response.status);
    message.set(beast_http::field::content_type, response.content_type);
    message.set(beast_http::field::cache_control, "no-store");
    message.set("Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'");
    message.set("Referrer-Policy", "no-referrer");
    message.set("X-Content-Type-Options", "nosniff");
    for (const auto& [name, value] : response.fields) message.set(name, value);
    message.keep_alive(!is_last_);
  }

  /// An answer has been sent.
  void finish(const error_code& error) {
    if (error || has_ended_) return end();
    sending_.reset();
    is_last_ ? hang_up() : read();
  }

  /// Header, then piece after piece.
  void send_file(const Response& response) {
    sending_ = std::make_unique<Sending>(io_, response.file);
    set_header(sending_->header, response);
    sending_->header.content_length(response.file->bytes());
    sending_->serializer.emplace(sending_->header);
    stream_.tcp().expires_after(limits_.time);
    beast_http::async_write_header(stream_, *sending_->serializer,
                                   [self = shared_from_this()](const error_code& error, std::size_t) {
                                     self->go_on([&] { self->begin_file(error); });
                                   });
  }
  void begin_file(const error_code& error) {
    if (error || has_ended_) return end();
    sending_->left_bytes = is_head_ ? 0 : sending_->body->bytes();
    if (sending_->left_bytes == 0) return finish({});
    sending_->pipe.assign(sending_->body->begin());
    read_piece();
  }
  void read_piece() {
    sending_->patience.expires_after(limits_.time);
    sending_->patience.async_wait([self = shared_from_this()](const error_code& error) {
      if (!error) self->end();
    });
    sending_->pipe.async_read_some(asio::buffer(sending_->piece),
                                   [self = shared_from_this()](const error_code& error, std::size_t size) {
                                     self->go_on([&] { self->send_piece(error, size); });
                                   });
  }
  void send_piece(const error_code& error, std::size_t size) {
    if (error || has_ended_) return end();
    sending_->patience.cancel();
    sending_->left_bytes -= size;
    stream_.tcp().expires_after(limits_.time);
    asio::async_write(stream_, asio::buffer(sending_->piece, size),
                      [self = shared_from_this()](const error_code& failed, std::size_t) {
                        self->go_on([&] {
                          if (failed || self->has_ended_) return self->end();
                          self->sending_->left_bytes == 0 ? self->finish({}) : self->read_piece();
                        });
                      });
  }

  void hand_over(const std::function<void(Upgrade&)>& take_over) {
    // RFC 6455, 4.1: a client waits for the answer.
    if (buffer_.size() > 0) {
      is_last_ = true;
      return write(plain(400, "bytes follow the request for a WebSocket before it is answered"));
    }
    stream_.tcp().expires_never();
    Upgrade upgrade{.bytes = std::move(stream_), .request = parser_->release(), .client = client_};
    has_ended_ = true;
    contain("opening a WebSocket", [&] { take_over(upgrade); });
  }

  /// Closes once the client has: closing before it does would take the answer from it.
  void hang_up() {
    if (!stream_.is_tls()) return hang_up_tcp();
    stream_.tcp().expires_after(limits_.time);
    stream_.tls().async_shutdown([self = shared_from_this()](const error_code&) { self->end(); });
  }
  void hang_up_tcp() {
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    buffer_.clear();
    stream_.tcp().expires_after(limits_.time);
    stream_.tcp().async_read_some(buffer_.prepare(buffer_.max_size()),
                                  [self = shared_from_this()](const error_code&, std::size_t) { self->end(); });
  }

  asio::io_context& io_;
  ByteStream stream_;
  stream::Peer client_;
  const Limits& limits_;
  const Server::Handler& handler_;
  Admission admission_;
  beast::flat_buffer buffer_;
  std::optional<beast_http::request_parser<beast_http::string_body>> parser_;
  beast_http::response<beast_http::string_body> message_;
  std::string bare_;                  ///< an answer in the clear to who does not use TLS
  std::unique_ptr<Sending> sending_;  ///< null: no file is being sent
  bool has_place_ = false;
  bool is_head_ = false;
  bool is_last_ = false;  ///< the connection is closed after this reply
  bool has_ended_ = false;
};

}  // namespace

class Server::Listener : public std::enable_shared_from_this<Listener> {
 public:
  Listener(asio::io_context& io, std::string_view listen, const Limits& limits, Handler handler,
           std::shared_ptr<const CertificateFiles> certificate)
      : io_(io),
        acceptor_(stream::open_acceptor(io, listen)),
        again_(io),
        limits_(limits),
        handler_(std::move(handler)),
        certificate_(std::move(certificate)) {
    const tcp::endpoint endpoint = acceptor_.local_endpoint();
    endpoint_ = to_string(Address{endpoint.address().to_string(), endpoint.port()});
  }

  const std::string& endpoint() const { return endpoint_; }
  std::size_t client_count() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(connections_, [](const auto& connection) { return !connection->has_ended(); }));
  }

  void accept() {
    acceptor_.async_accept([self = shared_from_this()](const error_code& error, tcp::socket socket) {
      if (self->is_closed_) return;
      if (error) return self->accept_later();
      contain("accepting an HTTP client", [&] { self->welcome(std::move(socket)); });
      self->accept();
    });
  }
  void close() {
    is_closed_ = true;
    error_code ignored;
    acceptor_.close(ignored);
    again_.cancel();
    for (const auto& connection : connections_) connection->end();
    connections_.clear();
  }

 private:
  /// Usually out of file descriptors: those who are there stay.
  void accept_later() {
    again_.expires_after(kAcceptAgainAfter);
    again_.async_wait([self = shared_from_this()](const error_code& error) {
      if (!error && !self->is_closed_) self->accept();
    });
  }
  void welcome(tcp::socket socket) {
    close_on_exec(socket.native_handle());
    std::erase_if(connections_, [](const auto& connection) { return connection->has_ended(); });
    error_code error;
    const tcp::endpoint endpoint = socket.remote_endpoint(error);
    if (error) return;  // it has gone already
    stream::keep_alive(socket);
    const asio::ip::address address = stream::unmapped(endpoint.address());
    stream::Peer client{.address = address.to_string(), .is_local = address.is_loopback()};
    if (const auto why = stream::admission_refusal(limits_.newcomers, present(false), client)) {
      if (!certificate_) turn_away(std::move(socket), *why);
      return;
    }
    const auto tls = certificate_ ? certificate_->context() : nullptr;  // OpenSSL keeps what a connection uses
    connections_.push_back(std::make_shared<Connection>(
        io_, std::move(socket), tls.get(), std::move(client), limits_, handler_, [this](const stream::Peer& asking) {
          return stream::admission_refusal(limits_.clients, present(true), asking);
        }));
    connections_.back()->begin();
  }

  std::vector<stream::Peer> present(bool with_place) const {
    std::vector<stream::Peer> peers;
    for (const auto& connection : connections_) {
      if (!connection->has_ended() && connection->has_place() == with_place) peers.push_back(connection->client());
    }
    return peers;
  }

  /// In one write that fits into an empty socket buffer.
  static void turn_away(tcp::socket socket, const std::string& why) {
    const std::string answer =
        bare_answer("503 Service Unavailable", fmt::format("Retry-After: {}\r\n", kRetryAfter_s), why);
    error_code ignored;
    socket.non_blocking(true, ignored);
    socket.write_some(asio::buffer(answer), ignored);
    socket.shutdown(tcp::socket::shutdown_send, ignored);
  }

  asio::io_context& io_;
  tcp::acceptor acceptor_;
  asio::steady_timer again_;
  Limits limits_;
  Handler handler_;
  std::shared_ptr<const CertificateFiles> certificate_;  ///< null: in the clear
  std::string endpoint_;
  std::vector<std::shared_ptr<Connection>> connections_;
  bool is_closed_ = false;
};

Server::Server(asio::io_context& io, std::string_view listen, const Limits& limits, Handler handler,
               std::shared_ptr<const CertificateFiles> certificate)
    : listener_(std::make_shared<Listener>(io, listen, limits, std::move(handler), std::move(certificate))) {
  listener_->accept();
}
Server::~Server() {
  close();
}
std::string Server::local_endpoint() const {
  return listener_->endpoint();
}
std::size_t Server::client_count() const {
  return listener_->client_count();
}
void Server::close() {
  listener_->close();
}

}  // namespace yuragi::daemon::http
