#include "daemon/stream/tcp_stream.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/steady_timer.hpp>
#include <spdlog/spdlog.h>

#include "engine/base/address.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::stream {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMinSendBufferBytes = 256u << 10;
constexpr auto kAcceptBackOff = std::chrono::milliseconds(100);

std::string text_of(const tcp::endpoint& endpoint) {
  return to_string(Address{endpoint.address().to_string(), endpoint.port()});
}

SharedBytes share(wire::Bytes bytes) {
  return std::make_shared<const wire::Bytes>(std::move(bytes));
}

/// Loopback, also of an IPv4 client on an IPv6 socket.
bool is_of_this_machine(const asio::ip::address& address) {
  if (address.is_v6() && address.to_v6().is_v4_mapped())
    return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()).is_loopback();
  return address.is_loopback();
}

/// Opens the listening socket. Throws with what to do.
tcp::acceptor open_acceptor(asio::io_context& io, std::string_view listen) {
  const auto address = parse_address(listen);
  if (!address) throw FailureError({"cannot listen: " + address.error().message, FailureKind::kUnavailable});
  try {
    // SO_REUSEADDR, which this constructor sets, lets a restarted daemon have its port back at once.
    tcp::resolver resolver(io);
    const auto found = resolver.resolve(address->host, std::to_string(address->port), tcp::resolver::passive);
    return {io, found.begin()->endpoint()};
  } catch (const boost::system::system_error& error) {
    const bool in_use = error.code() == asio::error::address_in_use;
    throw FailureError(
        {"cannot listen on " + std::string(listen) + ": " + error.code().message() +
             (in_use ? ". Another program uses this address, perhaps another yuragi: stop it, or choose another port."
                     : ". Choose an address of this machine, and a port above 1023."),
         FailureKind::kUnavailable});
  }
}

/// The messages and settings that all connections share.
struct Feed {
  TcpStreamSettings settings;
  SharedBytes hello;
  SharedBytes scenes;
  SharedBytes newest_frame;
  SharedBytes newest_sensors;
  std::size_t send_buffer_bytes = kMinSendBufferBytes;
};

/// One client. Its pending handlers hold it, so it lives until the last of them has run.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, std::shared_ptr<const Feed> feed)
      : socket_(std::move(socket)),
        feed_(std::move(feed)),
        queue_(feed_->settings.limits, feed_->hello, feed_->settings.now()) {
    error_code ignored;
    const tcp::endpoint peer = socket_.remote_endpoint(ignored);
    peer_ = text_of(peer);
    is_local_ = is_of_this_machine(peer.address());
    socket_.set_option(tcp::no_delay(true), ignored);
    limit_send_buffer();
  }

  bool is_open() const { return socket_.is_open(); }

  void start() {
    spdlog::info("client {} connected", peer_);
    read_prefix();
    write();
  }

  void offer_frame(const SharedBytes& frame) {
    queue_.offer_frame(frame);
    write();
  }

  void offer_sensors(const SharedBytes& sensors) {
    queue_.offer_sensors(sensors);
    write();
  }

  bool wants_trace(std::string_view sensor) const {
    return is_open() && wants_traces_ && (traced_sensor_.empty() || traced_sensor_ == sensor);
  }

  /// `bytes`: the encoded `trace`, as most clients get it.
  void offer_trace(const wire::RawTrace& trace, const SharedBytes& bytes) {
    auto& lost = lost_traces_[trace.sensor];
    SharedBytes own = bytes;
    if (lost > 0) {
      wire::RawTrace sent = trace;
      sent.lost += lost;
      own = share(wire::encode(sent));
    }
    lost = queue_.offer_trace(std::move(own)) ? 0 : lost + trace.lost + 1;
    write();
  }

  /// Data in the kernel's buffer is old by the time it is read: keep it small.
  void limit_send_buffer() {
    error_code ignored;
    socket_.set_option(asio::socket_base::send_buffer_size(static_cast<int>(feed_->send_buffer_bytes)), ignored);
  }

  /// Disconnects the client if it has exceeded a time limit, which is returned.
  std::optional<Overdue> check(MonoTime now) {
    const auto overdue = is_open() ? queue_.overdue(now) : std::nullopt;
    if (overdue) {
      // It will not read what the kernel still holds for it: discard that, too.
      error_code ignored;
      socket_.set_option(asio::socket_base::linger(true, 0), ignored);
      end(name_of(*overdue));
    }
    return overdue;
  }

  void end(std::string_view why) {
    if (!is_open()) return;
    spdlog::info("client {} {} disconnected: {}; {} frames sent, {} skipped", peer_, client_name_, why,
                 queue_.frames_sent(), queue_.frames_skipped());
    error_code ignored;
    socket_.close(ignored);
  }

 private:
  /// Starts the next write, unless one is in progress.
  void write() {
    if (is_writing_ || !is_open()) return;
    const auto bytes = queue_.to_write(feed_->settings.now());
    if (bytes.empty()) return;
    is_writing_ = true;
    socket_.async_write_some(asio::buffer(bytes.data(), bytes.size()),
                             [self = shared_from_this()](const error_code& error, std::size_t count) {
                               self->is_writing_ = false;
                               if (error) return self->end(error.message());
                               self->queue_.written(count, self->feed_->settings.now());
                               self->write();
                             });
  }

  void read_prefix() {
    asio::async_read(socket_, asio::buffer(prefix_), [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error) return self->end(error == asio::error::eof ? "it closed the connection" : error.message());
      const auto length = wire::read_size_prefix(self->prefix_, wire::kMaxClientMessageBytes);
      if (!length) return self->end("it sent a message of impossible length");
      self->read_body(*length);
    });
  }

  void read_body(std::size_t length) {
    body_.resize(length);
    asio::async_read(socket_, asio::buffer(body_), [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error) return self->end(error == asio::error::eof ? "it closed the connection" : error.message());
      self->take_message();
    });
  }

  /// A client may send one subscription, and after that Controls.
  void take_message() {
    const auto message = wire::decode(body_);
    if (!message) return end("its message was refused: " + std::string(name_of(message.error())));
    const auto* control = std::get_if<wire::Control>(&*message);
    if (control != nullptr && queue_.is_subscribed()) return take_control(*control);
    const auto* wish = std::get_if<wire::Subscribe>(&*message);
    if (wish == nullptr || queue_.is_subscribed()) return end("it sent a message that clients must not send");
    if (wish->protocol != wire::kProtocol) return end("it speaks protocol " + std::to_string(wish->protocol));

    client_name_ = "(" + wish->client + ")";
    spdlog::info("client {} {} subscribes to{}{}{}{}", peer_, client_name_, wish->poses ? " poses" : "",
                 wish->sensors ? " sensors" : "", wish->raw ? " raw messages" : "",
                 wish->poses || wish->sensors || wish->raw ? "" : " nothing");
    wants_traces_ = wish->raw;
    traced_sensor_ = wish->raw_sensor;
    queue_.subscribe(wish->poses, wish->sensors, feed_->scenes, feed_->newest_frame, feed_->newest_sensors);
    write();
    read_prefix();  // notices when it closes the connection
  }

  void take_control(const wire::Control& wish) {
    const auto& answer = feed_->settings.on_control;
    const wire::ControlReply reply =
        answer ? answer(wish, is_local_)
               : wire::ControlReply{.done = false, .message = "this daemon has no scenes", .scenes = {}};
    const bool changes_players = wish.player && wish.player->action != wire::PlayerAction::kReport;
    if (!wish.scene.empty() || changes_players) spdlog::info("client {} {}: {}", peer_, client_name_, reply.message);
    if (!queue_.offer_reply(share(wire::encode(reply)))) return end("it sends requests faster than it reads replies");
    write();
    read_prefix();
  }

  tcp::socket socket_;
  std::shared_ptr<const Feed> feed_;
  ClientQueue queue_;
  std::string peer_, client_name_;
  bool is_local_ = false;
  bool wants_traces_ = false;
  std::string traced_sensor_;                         // empty: all of them
  std::map<std::string, std::uint64_t> lost_traces_;  // of each sensor, since the last trace that was queued
  bool is_writing_ = false;
  std::array<std::uint8_t, wire::kSizePrefixBytes> prefix_{};
  wire::Bytes body_;
};

}  // namespace

/// The listening side. Pending handlers hold it; after close() they do nothing.
class TcpStream::Server : public std::enable_shared_from_this<Server> {
 public:
  Server(asio::io_context& io, std::string_view listen, TcpStreamSettings settings)
      : acceptor_(open_acceptor(io, listen)), check_timer_(io), accept_timer_(io) {
    feed_->hello = share(wire::encode(settings.hello));
    feed_->scenes = share(wire::encode(settings.scenes));
    settings.scenes.scenes.clear();  // only the encoded bytes are needed from here on
    feed_->settings = std::move(settings);
    endpoint_ = text_of(acceptor_.local_endpoint());
  }

  void start() {
    accept();
    check_clients();
  }

  const std::string& endpoint() const { return endpoint_; }
  std::uint64_t stuck_clients() const { return stuck_clients_; }

  std::size_t client_count() const {
    return static_cast<std::size_t>(
        std::count_if(connections_.begin(), connections_.end(), [](const auto& c) { return c->is_open(); }));
  }

  void publish(SharedBytes frame) {
    // Room for two frames in the kernel: one in flight, one ready to follow.
    if (2 * frame->size() > feed_->send_buffer_bytes) {
      feed_->send_buffer_bytes = 2 * frame->size();
      for (const auto& connection : connections_) connection->limit_send_buffer();
    }
    feed_->newest_frame = std::move(frame);
    for (const auto& connection : connections_) connection->offer_frame(feed_->newest_frame);
  }

  void publish_sensors(SharedBytes sensors) {
    feed_->newest_sensors = std::move(sensors);
    for (const auto& connection : connections_) connection->offer_sensors(feed_->newest_sensors);
  }

  bool wants_trace(std::string_view sensor) const {
    return std::ranges::any_of(connections_, [&](const auto& connection) { return connection->wants_trace(sensor); });
  }

  void publish_trace(const wire::RawTrace& trace) {
    if (!wants_trace(trace.sensor)) return;
    const SharedBytes bytes = share(wire::encode(trace));
    for (const auto& connection : connections_) {
      if (connection->wants_trace(trace.sensor)) connection->offer_trace(trace, bytes);
    }
  }

  void close() {
    if (std::exchange(closed_, true)) return;
    error_code ignored;
    acceptor_.close(ignored);
    check_timer_.cancel();
    accept_timer_.cancel();
    for (const auto& connection : connections_) connection->end("the daemon is stopping");
    connections_.clear();
  }

 private:
  void accept() {
    acceptor_.async_accept([self = shared_from_this()](const error_code& error, tcp::socket socket) {
      if (self->closed_) return;
      if (error) return self->accept_later(error);
      self->accept_error_.clear();
      self->welcome(std::move(socket));
      self->accept();
    });
  }

  /// Usually out of file descriptors or memory: present clients stay, and accepting is tried again later.
  void accept_later(const error_code& error) {
    if (std::exchange(accept_error_, error) != error) spdlog::warn("cannot accept a client: {}", error.message());
    accept_timer_.expires_after(kAcceptBackOff);
    accept_timer_.async_wait([self = shared_from_this()](const error_code&) {
      if (!self->closed_) self->accept();
    });
  }

  void welcome(tcp::socket socket) {
    forget_closed();
    if (connections_.size() >= feed_->settings.max_clients) return refuse(std::move(socket));
    connections_.push_back(std::make_shared<Connection>(std::move(socket), feed_));
    connections_.back()->start();
  }

  /// Sends a Hello that says why, in one write that fits into an empty socket buffer, and closes.
  void refuse(tcp::socket socket) const {
    error_code ignored;
    const auto peer = socket.remote_endpoint(ignored);
    spdlog::warn("client {} refused: {} clients are connected already", text_of(peer), connections_.size());
    wire::Hello hello = feed_->settings.hello;
    hello.refused = "the maximum number of clients is connected: " + std::to_string(connections_.size());
    socket.non_blocking(true, ignored);
    socket.write_some(asio::buffer(wire::encode(hello)), ignored);
    socket.shutdown(tcp::socket::shutdown_send, ignored);
  }

  void check_clients() {
    const MonoTime now = feed_->settings.now();
    for (const auto& connection : connections_) {
      if (connection->check(now) == Overdue::kStuck) ++stuck_clients_;
    }
    forget_closed();
    check_timer_.expires_after(feed_->settings.check_every);
    check_timer_.async_wait([self = shared_from_this()](const error_code&) {
      if (!self->closed_) self->check_clients();
    });
  }

  void forget_closed() {
    std::erase_if(connections_, [](const auto& connection) { return !connection->is_open(); });
  }

  tcp::acceptor acceptor_;
  asio::steady_timer check_timer_, accept_timer_;
  std::string endpoint_;
  std::shared_ptr<Feed> feed_ = std::make_shared<Feed>();
  std::vector<std::shared_ptr<Connection>> connections_;
  error_code accept_error_;
  std::uint64_t stuck_clients_ = 0;
  bool closed_ = false;
};

TcpStream::TcpStream(asio::io_context& io, std::string_view listen, TcpStreamSettings settings)
    : server_(std::make_shared<Server>(io, listen, std::move(settings))) {
  server_->start();
}

TcpStream::~TcpStream() {
  try {
    server_->close();
  } catch (...) {
    // A destructor cannot report errors. The sockets are closed with the last reference to the server.
  }
}

std::string TcpStream::local_endpoint() const {
  return server_->endpoint();
}
void TcpStream::publish(SharedBytes frame) {
  server_->publish(std::move(frame));
}
void TcpStream::publish_sensors(SharedBytes sensors) {
  server_->publish_sensors(std::move(sensors));
}
std::size_t TcpStream::client_count() const {
  return server_->client_count();
}
bool TcpStream::wants_trace(std::string_view sensor) const {
  return server_->wants_trace(sensor);
}
void TcpStream::publish_trace(const wire::RawTrace& trace) {
  server_->publish_trace(trace);
}
void TcpStream::close() {
  server_->close();
}
std::uint64_t TcpStream::stuck_clients() const {
  return server_->stuck_clients();
}

}  // namespace yuragi::daemon::stream
