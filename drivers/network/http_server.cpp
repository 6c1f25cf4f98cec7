#include "drivers/network/http_server.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <fmt/format.h>

#include "engine/base/close_on_exec.hpp"
#include "engine/base/contain.hpp"

namespace yuragi::drivers::network {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::asio::ip::tcp;

constexpr int kListenBacklog = 16;
/// Limit of further data of a client after the reply, before its connection is reset.
constexpr std::size_t kMaxDrained = 64UL * 1024;
/// Limit of steps per serve(), so that a flood does not keep it busy.
constexpr int kMaxSteps = 256;

std::string listen_remedy_of(const boost::system::error_code& error) {
  if (error == boost::asio::error::address_in_use)
    return "another program or sensor uses this port; end it, or choose another port";
  if (error == boost::system::errc::address_not_available)
    return "this machine does not have that address; `ip address` lists its addresses";
  if (error == boost::asio::error::access_denied) return "ports below 1024 need a privilege; choose a higher one";
  return "check host and port";
}

/// A service is there while this is.
class Visit {
 public:
  Visit(HttpService*& place, HttpService& service) : place_(place) { place_ = &service; }
  ~Visit() { place_ = nullptr; }
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;

 private:
  HttpService*& place_;
};

}  // namespace

/// One client: its request is read and answered; all that it still sends is read and dropped until it closes, because
/// closing first could destroy the answer. All of this happens within the stream's time limit. Its pending handlers
/// keep it alive.
class HttpServer::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(HttpServer& server, tcp::socket socket, const boost::asio::ip::address& sender)
      : server_(server),
        sender_(sender),
        stream_(std::move(socket)),
        buffer_(server.limits_.header_bytes + server.limits_.body_bytes) {
    parser_.header_limit(server.limits_.header_bytes);
    parser_.body_limit(server.limits_.body_bytes);
  }

  void begin() {
    stream_.expires_after(server_.limits_.time);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](const beast::error_code& error, std::size_t /*size*/) {
                       self->go_on([&] { self->take(error); });
                     });
  }

  void end() noexcept {
    beast::error_code ignored;
    stream_.socket().close(ignored);
  }

  const boost::asio::ip::address& sender() const noexcept { return sender_; }
  /// Returns true until a whole request was received.
  bool is_waiting() const noexcept { return is_waiting_; }

 private:
  /// Handles an event. An exception ends only this connection.
  template <class Work>
  void go_on(Work&& work) {
    if (!contain("a connection that pushes", std::forward<Work>(work))) end();
  }

  void take(const beast::error_code& error) {
    is_waiting_ = false;
    HttpService* const service = server_.service_;
    if (service == nullptr || error == boost::asio::error::operation_aborted) return;
    if (!error) {
      HttpAnswer answer = {.status = 500, .text = "this request could not be answered"};
      contain("a push", [&] { answer = service->answer(request()); });
      return reply(answer);
    }
    if (error == beast::error::timeout) return service->failed(HttpFailure::kTooSlow, sender_);
    if (error == http::error::end_of_stream) return;  // it sent nothing: a check whether the port is open
    if (error == http::error::partial_message) {
      service->failed(HttpFailure::kCutOff, sender_);
      return reply({.status = 400, .text = "the request is cut off"});
    }
    if (error == http::error::body_limit) {
      service->failed(HttpFailure::kTooLong, sender_);
      return reply({.status = 413, .text = "the body is too long"});
    }
    if (error == http::error::header_limit || error == http::error::buffer_overflow) {
      service->failed(HttpFailure::kTooLong, sender_);
      return reply({.status = 431, .text = "the header is too long"});
    }
    if (error.category() == beast::error_code(http::error::bad_method).category()) {
      service->failed(HttpFailure::kMalformed, sender_);
      return reply({.status = 400, .text = "this is not HTTP"});
    }
    if (parser_.got_some()) service->failed(HttpFailure::kCutOff, sender_);
  }

  HttpRequest request() const {
    const auto& message = parser_.get();
    const auto view_of = [](beast::string_view text) { return std::string_view(text.data(), text.size()); };
    const bool is_of_browser = std::ranges::any_of(
        std::array{"Origin", "Referer", "Sec-Fetch-Site", "Sec-Fetch-Mode", "Sec-Fetch-Dest", "Sec-Fetch-User"},
        [&](const char* field) { return message.count(field) > 0; });
    return {.sender = sender_,
            .method = view_of(message.method_string()),
            .target = view_of(message.target()),
            .host = view_of(message[http::field::host]),
            .is_of_browser = is_of_browser,
            .body = message.body()};
  }

  void reply(const HttpAnswer& answer) {
    response_.version(11);
    response_.result(answer.status);
    response_.set(http::field::content_type, "text/plain");
    response_.body() = answer.text + "\n";
    response_.keep_alive(false);
    response_.prepare_payload();
    http::async_write(stream_, response_,
                      [self = shared_from_this()](const beast::error_code& error, std::size_t /*size*/) {
                        if (error) return;
                        beast::error_code ignored;
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                        self->drain();
                      });
  }

  void drain() {
    stream_.async_read_some(boost::asio::buffer(dropped_),
                            [self = shared_from_this()](const beast::error_code& error, std::size_t size) {
                              self->drained_ += size;
                              if (!error && self->drained_ <= kMaxDrained) self->drain();
                            });
  }

  HttpServer& server_;
  boost::asio::ip::address sender_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  http::request_parser<http::string_body> parser_;
  http::response<http::string_body> response_;
  std::array<char, 1024> dropped_{};
  std::size_t drained_ = 0;
  bool is_waiting_ = true;
};

HttpServer::HttpServer(const Address& address, const HttpLimits& limits) : address_(address), limits_(limits) {}

HttpServer::~HttpServer() {
  close();
}

Result<void, Failure> HttpServer::open() {
  close();
  boost::system::error_code error;
  const auto host = boost::asio::ip::make_address(address_.host, error);
  if (error) return Failure{"host: \"" + address_.host + "\" is not an address"};
  const tcp::endpoint endpoint(host, address_.port);
  acceptor_.open(endpoint.protocol(), error);
  if (!error) close_on_exec(acceptor_.native_handle());
  const bool failed = error || acceptor_.set_option(tcp::acceptor::reuse_address(true), error) ||
                      acceptor_.bind(endpoint, error) || acceptor_.listen(kListenBacklog, error);
  if (!failed) port_ = acceptor_.local_endpoint(error).port();
  if (error) {
    close();
    return Failure{
        fmt::format("cannot listen at {} ({}): {}", to_string(address_), error.message(), listen_remedy_of(error))};
  }
  failure_.reset();
  accept();
  return {};
}

void HttpServer::close() noexcept {
  boost::system::error_code ignored;
  acceptor_.close(ignored);
  for (const auto& weak : connections_) {
    if (const auto connection = weak.lock()) connection->end();
  }
  connections_.clear();
  // Pending handlers are cancelled, and release their connections.
  context_.restart();
  context_.poll();
}

Result<void, Failure> HttpServer::serve(Nanoseconds timeout, HttpService& service) {
  context_.restart();
  if (is_interrupted_) return {};
  const Visit visit(service_, service);
  if (context_.run_one_for(timeout) > 0) {
    for (int step = 0; step < kMaxSteps && context_.poll_one() > 0; ++step) {
    }
  }
  if (failure_) return *failure_;
  return {};
}

void HttpServer::interrupt() noexcept {
  is_interrupted_ = true;
  context_.stop();
}

void HttpServer::accept() {
  // async_accept returns the sender: remote_endpoint() fails once the client has disconnected.
  acceptor_.async_accept(sender_, [this](const boost::system::error_code& error, tcp::socket socket) {
    if (error == boost::asio::error::operation_aborted) return;
    // It is no error if the client has closed the connection meanwhile.
    if (error && error != boost::asio::error::connection_aborted) {
      failure_ = Failure{"cannot accept connections (" + error.message() + "): reopening it"};
      return;
    }
    if (!error) contain("accepting a connection that pushes", [&] { take(std::move(socket)); });
    accept();
  });
}

void HttpServer::take(tcp::socket socket) {
  close_on_exec(socket.native_handle());
  const auto sender = sender_.address();
  if (service_ == nullptr || !service_->admits(sender)) return;
  std::erase_if(connections_, [](const auto& connection) { return connection.expired(); });
  if (connections_.size() >= limits_.connections) {
    if (const auto oldest = connections_.front().lock()) {
      if (oldest->is_waiting()) service_->failed(HttpFailure::kTooMany, oldest->sender());
      oldest->end();
    }
    connections_.erase(connections_.begin());
  }
  const auto connection = std::make_shared<Connection>(*this, std::move(socket), sender);
  connections_.push_back(connection);
  connection->begin();
}

}  // namespace yuragi::drivers::network
