// A WebSocket server (RFC 6455) by Boost.Beast. Text without a line's end becomes a frame that the next one continues;
// a line's end ends the message and is not sent.
#include <algorithm>
#include <array>
#include <deque>
#include <list>
#include <memory>
#include <sstream>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "simulators/core/tcp_listener.hpp"
#include "simulators/text/text_wire.hpp"

namespace yuragi::simulators::text {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using boost::asio::ip::tcp;
using boost::system::error_code;

/// The longest message that a client may send.
constexpr std::size_t kMaxSaid = 4096;
/// Limit for waiting messages. Only a client that does not read reaches it; it is dropped.
constexpr std::size_t kMaxWaiting = 1000;

/// A client, from its request on. Its handlers own it, so that it outlives its pending operations.
class WebSocketPeer : public std::enable_shared_from_this<WebSocketPeer> {
 public:
  WebSocketPeer(tcp::socket socket, const WebSocketWireOptions& options, bool is_refused, std::string greeting)
      : stream_(std::move(socket)), options_(options), is_refused_(is_refused) {
    if (!greeting.empty()) say(greeting);
  }

  void start() {
    http::async_read(stream_.next_layer(), buffer_, request_,
                     [self = shared_from_this()](const error_code& error, std::size_t) {
                       error ? self->end() : self->take_request();
                     });
  }
  void say(std::string_view bytes) {
    const bool is_whole = bytes.ends_with('\n');
    while (bytes.ends_with('\n') || bytes.ends_with('\r')) bytes.remove_suffix(1);
    waiting_.push_back({std::string(bytes), is_whole});
    if (waiting_.size() > kMaxWaiting) return end();
    send_next();
  }
  /// Returns the messages that it has sent, each with a line's end.
  std::string take_received() { return std::exchange(received_, {}); }
  bool has_spoken() const { return has_spoken_; }
  bool has_ended() const { return has_ended_; }
  void end() {
    error_code ignored;
    stream_.next_layer().close(ignored);
    has_ended_ = true;
  }
  int descriptor() { return stream_.next_layer().native_handle(); }

 private:
  struct Frame {
    std::string bytes;
    bool ends_message;
  };

  void take_request() {
    if (is_refused_) return refuse(http::status::service_unavailable);
    if (!options_.token.empty() && request_[http::field::authorization] != "Bearer " + options_.token)
      return refuse(http::status::unauthorized);
    if (!websocket::is_upgrade(request_) || !std::string_view(request_.target()).starts_with(options_.path))
      return refuse(http::status::not_found);
    stream_.read_message_max(kMaxSaid);
    stream_.auto_fragment(false);
    stream_.async_accept(request_, [self = shared_from_this()](const error_code& error) {
      if (error) return self->end();
      self->is_accepted_ = true;
      self->send_next();
      self->listen();
    });
  }
  void refuse(http::status why) {
    auto response = std::make_shared<http::response<http::empty_body>>(why, request_.version());
    response->prepare_payload();
    http::async_write(stream_.next_layer(), *response,
                      [self = shared_from_this(), response](const error_code&, std::size_t) { self->end(); });
  }
  void listen() {
    stream_.async_read(buffer_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error) return self->end();
      self->has_spoken_ = true;
      self->received_ += beast::buffers_to_string(self->buffer_.data()) + '\n';
      self->buffer_.clear();
      self->listen();
    });
  }
  void send_next() {
    if (!is_accepted_ || is_sending_ || waiting_.empty()) return;
    is_sending_ = true;
    stream_.async_write_some(waiting_.front().ends_message, boost::asio::buffer(waiting_.front().bytes),
                             [self = shared_from_this()](const error_code& error, std::size_t) {
                               self->is_sending_ = false;
                               if (error) return self->end();
                               self->waiting_.pop_front();
                               self->send_next();
                             });
  }

  websocket::stream<tcp::socket, false> stream_;
  WebSocketWireOptions options_;
  bool is_refused_;
  beast::flat_buffer buffer_{kMaxSaid};
  http::request<http::empty_body> request_;
  std::deque<Frame> waiting_;
  std::string received_;
  bool has_spoken_ = false;
  bool is_accepted_ = false;
  bool is_sending_ = false;
  bool has_ended_ = false;
};

class WebSocketWire final : public Wire {
 public:
  explicit WebSocketWire(const WebSocketWireOptions& options)
      : options_(options), listener_(options.host, options.port) {}
  ~WebSocketWire() override { drop_all(); }

  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {core::FaultKind::kException, core::FaultKind::kDisconnect,
                                          core::FaultKind::kUnplug};
    return kKnown;
  }
  std::vector<int> descriptors() const override {
    std::vector<int> all;
    if (listener_.is_open()) all.push_back(const_cast<core::TcpListener&>(listener_).descriptor());
    for (const auto& peer : peers_) {
      if (!peer->has_ended()) all.push_back(peer->descriptor());
    }
    return all;
  }
  std::string read(std::span<const int> /*ready*/) override {
    while (auto client = listener_.accept()) {
      error_code error;
      tcp::socket socket(context_);
      const tcp protocol = listener_.endpoint().protocol();
      if (socket.assign(protocol, client->release(error), error)) continue;
      peers_.push_back(std::make_shared<WebSocketPeer>(std::move(socket), options_, refuses_, greeting_));
      peers_.back()->start();
    }
    turn();
    std::string received;
    for (const auto& peer : peers_) received += peer->take_received();
    std::erase_if(peers_, [](const auto& peer) { return peer->has_ended(); });
    return received;
  }
  void greet_with(const std::string& bytes) override { greeting_ = bytes; }
  void wait_for_clients() override { waits_for_clients_ = true; }
  void write(std::string_view bytes) override {
    for (const auto& peer : peers_) {
      if (peer->has_spoken() || !waits_for_clients_) peer->say(bytes);
    }
    turn();
  }
  void refuse(bool is_wanted) override {
    if (is_wanted && !refuses_) drop_all();
    refuses_ = is_wanted;
  }
  void take_away() override {
    drop_all();
    listener_.close();
  }
  void bring_back() override { listener_.open_again(); }
  std::string place() const override {
    std::ostringstream text;
    text << "listening on " << listener_.endpoint();
    return text.str();
  }

 private:
  void turn() {
    context_.restart();
    context_.poll();
  }
  void drop_all() {
    for (const auto& peer : peers_) peer->end();
    peers_.clear();
    turn();
  }

  WebSocketWireOptions options_;
  core::TcpListener listener_;
  boost::asio::io_context context_{1};
  std::list<std::shared_ptr<WebSocketPeer>> peers_;
  std::string greeting_;
  bool waits_for_clients_ = false;
  bool refuses_ = false;
};

}  // namespace

std::unique_ptr<Wire> make_websocket_wire(const WebSocketWireOptions& options) {
  return std::make_unique<WebSocketWire>(options);
}

}  // namespace yuragi::simulators::text
