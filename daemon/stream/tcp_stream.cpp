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

#include "daemon/stream/client_log.hpp"
#include "daemon/stream/frame_pace.hpp"
#include "daemon/stream/pose_views.hpp"
#include "daemon/stream/tcp_listening.hpp"
#include "engine/base/address.hpp"
#include "engine/base/close_on_exec.hpp"
#include "engine/base/contain.hpp"
#include "engine/base/printable_text.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::stream {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMinSendBufferBytes = 256u << 10;
constexpr auto kAcceptBackOff = std::chrono::milliseconds(100);

// The log shows this many characters of a text from a client.
constexpr std::size_t kShownNameCharacters = 64;
constexpr std::size_t kShownReplyCharacters = 200;

constexpr std::string_view kOwnFault = "serving it failed, which is a fault of the daemon";

std::string text_of(const tcp::endpoint& endpoint) {
  return to_string(Address{endpoint.address().to_string(), endpoint.port()});
}

SharedBytes share(wire::Bytes bytes) {
  return std::make_shared<const wire::Bytes>(std::move(bytes));
}

/// The messages and settings that all connections share.
struct Feed {
  TcpStreamSettings settings;
  SharedBytes hello;
  PoseViews poses;
  SharedBytes newest_sensors_here, newest_sensors_elsewhere;
  std::size_t send_buffer_bytes = kMinSendBufferBytes;
  std::unique_ptr<ClientLog> log;
  ClientCounts counts;

  const SharedBytes& newest_sensors(bool is_local) const {
    return is_local ? newest_sensors_here : newest_sensors_elsewhere;
  }

  /// The Hello by which a connection is refused or ended.
  wire::Bytes goodbye(std::string why) const {
    wire::Hello last = settings.hello;
    last.refused = std::move(why);
    return wire::encode(last);
  }
};

/// One client. Its pending handlers hold it, so it lives until the last of them has run.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, Peer peer, std::shared_ptr<Feed> feed)
      : socket_(std::move(socket)),
        feed_(std::move(feed)),
        limits_(limits_of(peer, feed_->settings.limits)),
        queue_(limits_, feed_->hello, feed_->settings.now()),
        peer_(std::move(peer)),
        is_trusted_(peer_.is_local && feed_->settings.trusts_this_machine) {
    error_code ignored;
    endpoint_ = text_of(socket_.remote_endpoint(ignored));
    socket_.set_option(tcp::no_delay(true), ignored);
    keep_alive(socket_);
    limit_send_buffer();
  }

  bool is_open() const { return socket_.is_open(); }
  const Peer& peer() const { return peer_; }
  bool is_trusted() const { return is_trusted_; }
  wire::Display display() const { return is_open() ? display_ : wire::Display{}; }
  const std::string& endpoint() const { return endpoint_; }

  void start() {
    feed_->log->info("client {} connected", endpoint_);
    read_prefix();
    write();
  }

  /// Offers the newest frame, unless the client has had it or one has been too short a time ago.
  void offer_frame() {
    if (!is_open() || !queue_.wants_frames() || !poses_->has_frame() || poses_->sequence() == offered_frame_) return;
    if (pace_ && !pace_->take(feed_->settings.now())) return;
    offered_frame_ = poses_->sequence();
    queue_.offer_frame(poses_->frame());
    write();
  }

  void offer_scenes() {
    if (!queue_.wants_poses()) return;
    if (!takes_new_scenes_) return dismiss("the scenes have changed; connect again");
    if (auto why = feed_->poses.refusal(poses_->thinning())) return dismiss(std::move(*why));
    queue_.offer_scenes(poses_->scenes());
    write();
  }

  void offer_newest_sensors() {
    if (const SharedBytes& sensors = feed_->newest_sensors(is_trusted_)) queue_.offer_sensors(sensors);
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
    offer_frame();  // the last one, unless a newer one replaces it
    const auto overdue = is_open() ? queue_.overdue(now) : std::nullopt;
    if (!overdue) return overdue;
    const std::string why = reason_text(*overdue, limits_);
    if (*overdue != Overdue::kStuck) {
      dismiss(why);
      return overdue;
    }
    // It will not read the data that the kernel still holds for it: discard that, too.
    error_code ignored;
    socket_.set_option(asio::socket_base::linger(true, 0), ignored);
    end(why);
    return overdue;
  }

  void end(std::string_view why) {
    if (!is_open()) return;
    feed_->log->info("client {} {} disconnected: {}; {} frames sent, {} skipped", endpoint_, client_name_, why,
                     queue_.frames_sent(), queue_.frames_skipped());
    error_code ignored;
    socket_.close(ignored);
  }

 private:
  /// Handles an event. An exception ends only this connection.
  template <class Work>
  void go_on(Work&& work) {
    if (!contain("a stream connection", std::forward<Work>(work))) end(kOwnFault);
  }

  static ClientLimits limits_of(const Peer& peer, ClientLimits limits) {
    if (peer.only_asks_because) limits.stays_for = kQuestionsFor;
    return limits;
  }

  /// Sends the reason to the client, and disconnects it once that has been sent.
  void dismiss(std::string why) {
    queue_.dismiss(share(feed_->goodbye(why)));
    dismissed_because_ = std::move(why);
    write();
  }

  /// Starts the next write, unless one is in progress.
  void write() {
    if (is_writing_ || !is_open()) return;
    if (queue_.is_done()) return end(dismissed_because_);
    const auto bytes = queue_.to_write(feed_->settings.now());
    if (bytes.empty()) return;
    is_writing_ = true;
    socket_.async_write_some(asio::buffer(bytes.data(), bytes.size()),
                             [self = shared_from_this()](const error_code& error, std::size_t count) {
                               self->is_writing_ = false;
                               if (error) return self->end(error.message());
                               self->go_on([&] {
                                 self->queue_.written(count, self->feed_->settings.now());
                                 self->write();
                               });
                             });
  }

  void read_prefix() {
    asio::async_read(socket_, asio::buffer(prefix_), [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error) return self->end(error == asio::error::eof ? "it closed the connection" : error.message());
      const auto length = wire::read_size_prefix(self->prefix_, wire::kMaxClientMessageBytes);
      if (!length) return self->end("it sent a message of impossible length");
      self->go_on([&] { self->read_body(*length); });
    });
  }

  void read_body(std::size_t length) {
    body_.resize(length);
    asio::async_read(socket_, asio::buffer(body_), [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error) return self->end(error == asio::error::eof ? "it closed the connection" : error.message());
      self->go_on([&] { self->take_message(); });
    });
  }

  /// A client may send one subscription, and after that Controls and Displays.
  void take_message() {
    if (queue_.is_dismissed()) return;  // and nothing more is read
    const auto message = wire::decode(body_);
    if (!message) return end("its message was refused: " + std::string(name_of(message.error())));
    const auto* control = std::get_if<wire::Control>(&*message);
    if (control != nullptr && queue_.is_subscribed()) return take_control(*control);
    const auto* display = std::get_if<wire::Display>(&*message);
    if (display != nullptr && queue_.is_subscribed()) {
      display_ = *display;
      return read_prefix();
    }
    const auto* wish = std::get_if<wire::Subscribe>(&*message);
    if (wish == nullptr || queue_.is_subscribed()) return end("it sent a message that clients must not send");
    if (wish->protocol != wire::kProtocol) return end("it speaks protocol " + std::to_string(wish->protocol));

    client_name_ = "(" + shortened(wish->client, kShownNameCharacters) + ")";
    feed_->log->info("client {} {} subscribes to{}{}{}{}", endpoint_, client_name_,
                     wish->poses  ? " poses"
                     : wish->wind ? " wind"
                                  : "",
                     wish->sensors ? " sensors" : "", wish->raw ? " raw messages" : "",
                     wish->wants_frames() || wish->sensors || wish->raw ? "" : " nothing");
    if (!is_trusted_ && !wish->token.is_empty()) {
      const auto& is_token = feed_->settings.is_token;
      is_trusted_ = is_token && is_token(wish->token.reveal());
      if (!is_trusted_) return dismiss("its token is not that of this installation");
    }
    if (peer_.only_asks_because && (wish->wants_frames() || wish->raw)) {
      ++feed_->counts.refused;
      return dismiss(*peer_.only_asks_because);
    }
    const auto& raw_refusal = feed_->settings.raw_refusal;
    if (wish->raw && raw_refusal) {
      if (auto why = raw_refusal(is_trusted_)) return dismiss(std::move(*why));
    }
    if (wish->poses) {
      if (auto why = feed_->poses.refusal(wish->thinning)) return dismiss(std::move(*why));
    }
    takes_new_scenes_ = wish->takes_new_scenes;
    wants_traces_ = wish->raw;
    traced_sensor_ = wish->raw_sensor;
    const MonoTime now = feed_->settings.now();
    if (wish->wants_frames()) poses_ = feed_->poses.view(wish->frame_thinning());
    if (wish->rate_hz > 0.0) pace_.emplace(wish->rate_hz, now);
    queue_.subscribe({.poses = wish->poses, .sensors = wish->sensors, .traces = wish->raw, .wind = wish->wind},
                     poses_ ? poses_->scenes() : nullptr, nullptr, feed_->newest_sensors(is_trusted_), now);
    offer_frame();
    write();
    read_prefix();  // notices when it closes the connection
  }

  void take_control(const wire::Control& wish) {
    queue_.requested(feed_->settings.now());
    if (wish.reload && feed_->settings.on_reload) return take_reload(*wish.reload);
    if (wish.parameters && feed_->settings.on_parameters) return take_parameters(*wish.parameters);
    const auto& answer = feed_->settings.on_control;
    const wire::ControlReply reply =
        answer ? answer(wish, is_trusted_)
               : wire::ControlReply{.done = false, .message = "this daemon has no scenes", .scenes = {}};
    const bool changes_players = wish.player && wish.player->action != wire::PlayerAction::kReport;
    const bool sets_by_hand = wish.hand && wish.hand->part != wire::HandPart::kReport;
    if (!wish.scene.empty() || changes_players || sets_by_hand) {
      feed_->log->info("client {} {}: {}", endpoint_, client_name_, shortened(reply.message, kShownReplyCharacters));
    }
    send_reply(reply);
    if (is_open()) read_prefix();
  }

  /// The reply is sent later, unless the client has disconnected by then.
  void take_reload(const wire::ReloadCommand& command) {
    feed_->settings.on_reload(command, is_trusted_, [weak = weak_from_this()](const wire::ControlReply& reply) {
      if (const auto self = weak.lock()) self->send_reply(reply);
    });
    if (is_open()) read_prefix();
  }

  void take_parameters(const wire::ParameterCommand& command) {
    const bool sets = !command.edits.empty();
    feed_->settings.on_parameters(command, is_trusted_,
                                  [weak = weak_from_this(), sets](const wire::ControlReply& reply) {
                                    const auto self = weak.lock();
                                    if (!self) return;
                                    if (sets) {
                                      self->feed_->log->info("client {} {}: {}", self->endpoint_, self->client_name_,
                                                             shortened(reply.message, kShownReplyCharacters));
                                    }
                                    self->send_reply(reply);
                                  });
    if (is_open()) read_prefix();
  }

  void send_reply(const wire::ControlReply& reply) {
    if (!is_open()) return;
    if (!queue_.offer_reply(share(wire::encode(reply)))) return end("it sends requests faster than it reads replies");
    write();
  }

  tcp::socket socket_;
  std::shared_ptr<Feed> feed_;
  ClientLimits limits_;
  ClientQueue queue_;
  std::shared_ptr<PoseView> poses_;  // null: it wants no frames
  std::optional<FramePace> pace_;    // none: every frame
  Peer peer_;
  bool is_trusted_;  // of this machine, or it has shown the token
  std::string endpoint_, client_name_;
  std::string dismissed_because_;
  wire::Display display_;  // the last one
  bool takes_new_scenes_ = false;
  bool wants_traces_ = false;
  std::string traced_sensor_;                         // empty: all of them
  std::map<std::string, std::uint64_t> lost_traces_;  // of each sensor, since the last trace that was queued
  std::uint64_t offered_frame_ = 0;                   // by its number in PoseView::sequence()
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
    settings.hello.takes_display = true;
    feed_->hello = share(wire::encode(settings.hello));
    feed_->poses.set_scenes(share(wire::encode(settings.scenes)));
    settings.scenes.scenes.clear();  // only the encoded bytes are needed from here on
    feed_->log = std::make_unique<ClientLog>(settings.log, settings.now);
    feed_->settings = std::move(settings);
    endpoint_ = text_of(acceptor_.local_endpoint());
  }

  void start() {
    accept();
    check_clients();
  }

  const std::string& endpoint() const { return endpoint_; }
  const ClientCounts& counts() const { return feed_->counts; }
  const SharedBytes& scenes() const { return feed_->poses.scenes(); }

  std::size_t client_count() const {
    return static_cast<std::size_t>(
        std::count_if(connections_.begin(), connections_.end(), [](const auto& c) { return c->is_open(); }));
  }

  std::uint8_t given_up() const {
    std::uint8_t most = 0;
    for (const auto& connection : connections_) most = std::max(most, connection->display().given_up);
    return most;
  }

  std::optional<ClientClock> worst_clock() const {
    std::optional<ClientClock> worst;
    for (const auto& connection : connections_) {
      const std::optional<double> offset_s = connection->display().clock_offset_s;
      if (offset_s && (!worst || std::abs(*offset_s) > std::abs(worst->offset_s)))
        worst = {.client = connection->endpoint(), .offset_s = *offset_s};
    }
    return worst;
  }

  bool has_untrusted_clients() const {
    return std::ranges::any_of(connections_, [](const auto& c) { return c->is_open() && !c->is_trusted(); });
  }

  void publish(SharedBytes frame) {
    // Room for two frames in the kernel: one in flight, one ready to follow.
    if (2 * frame->size() > feed_->send_buffer_bytes) {
      feed_->send_buffer_bytes = 2 * frame->size();
      for (const auto& connection : connections_) connection->limit_send_buffer();
    }
    feed_->poses.set_frame(std::move(frame));
    for_each([](Connection& connection) { connection.offer_frame(); });
  }

  void publish_scenes(SharedBytes scenes) {
    feed_->poses.set_scenes(std::move(scenes));
    for_each([](Connection& connection) { connection.offer_scenes(); });
  }

  void publish_sensors(SharedBytes here, SharedBytes elsewhere) {
    feed_->newest_sensors_here = std::move(here);
    feed_->newest_sensors_elsewhere = std::move(elsewhere);
    for_each([](Connection& connection) { connection.offer_newest_sensors(); });
  }

  void set_admission(const AdmissionLimits& admission) { feed_->settings.admission = admission; }

  bool wants_trace(std::string_view sensor) const {
    return std::ranges::any_of(connections_, [&](const auto& connection) { return connection->wants_trace(sensor); });
  }

  void publish_trace(const wire::RawTrace& trace) {
    if (!wants_trace(trace.sensor)) return;
    const SharedBytes bytes = share(wire::encode(trace));
    for_each([&](Connection& connection) {
      if (connection.wants_trace(trace.sensor)) connection.offer_trace(trace, bytes);
    });
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
  /// An exception ends the connection of this one client.
  template <class Work>
  void for_each(Work&& work) {
    for (const auto& connection : connections_) {
      if (!contain("a stream connection", [&] { work(*connection); })) connection->end(kOwnFault);
    }
  }

  void accept() {
    acceptor_.async_accept([self = shared_from_this()](const error_code& error, tcp::socket socket) {
      if (self->closed_) return;
      if (error) return self->accept_later(error);
      self->accept_error_.clear();
      contain("accepting a stream client", [&] { self->welcome(std::move(socket)); });
      self->accept();
    });
  }

  /// Usually out of file descriptors or memory: present clients stay, and accepting is tried again later.
  void accept_later(const error_code& error) {
    if (std::exchange(accept_error_, error) != error) feed_->log->warn("cannot accept a client: {}", error.message());
    accept_timer_.expires_after(kAcceptBackOff);
    accept_timer_.async_wait([self = shared_from_this()](const error_code&) {
      if (!self->closed_) self->accept();
    });
  }

  void welcome(tcp::socket socket) {
    close_on_exec(socket.native_handle());
    forget_closed();
    error_code error;
    const tcp::endpoint endpoint = socket.remote_endpoint(error);
    if (error) return;  // it has gone already
    const std::string address = unmapped(endpoint.address()).to_string();
    Peer peer{address, feed_->settings.is_of_this_machine(address)};
    std::vector<Peer> connected;
    connected.reserve(connections_.size());
    for (const auto& connection : connections_) connected.push_back(connection->peer());
    if (auto why = admission_refusal(feed_->settings.admission, connected, peer)) {
      if (!may_ask(connected, peer)) {
        ++feed_->counts.refused;
        feed_->log->warn("client {} refused: {}", text_of(endpoint), *why);
        return refuse(std::move(socket), std::move(*why));
      }
      peer.only_asks_because = std::move(why);
    }
    connections_.push_back(std::make_shared<Connection>(std::move(socket), std::move(peer), feed_));
    connections_.back()->start();
  }

  /// Sends a Hello with the reason, in one write that fits into an empty socket buffer, and closes.
  void refuse(tcp::socket socket, std::string why) const {
    error_code ignored;
    socket.non_blocking(true, ignored);
    socket.write_some(asio::buffer(feed_->goodbye(std::move(why))), ignored);
    socket.shutdown(tcp::socket::shutdown_send, ignored);
  }

  void check_clients() {
    const MonoTime now = feed_->settings.now();
    for_each([&](Connection& connection) {
      const auto overdue = connection.check(now);
      if (overdue == Overdue::kStuck) ++feed_->counts.stuck;
      if (overdue == Overdue::kNeverSubscribed || overdue == Overdue::kIdle) ++feed_->counts.idle;
    });
    forget_closed();
    feed_->log->report_left_out();
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
  bool closed_ = false;
};

bool TcpStreamSettings::is_loopback(const std::string& address) {
  error_code error;
  const auto parsed = asio::ip::make_address(address, error);
  return !error && unmapped(parsed).is_loopback();
}

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
void TcpStream::publish_scenes(SharedBytes scenes) {
  server_->publish_scenes(std::move(scenes));
}
void TcpStream::publish_sensors(SharedBytes here, SharedBytes elsewhere) {
  server_->publish_sensors(std::move(here), std::move(elsewhere));
}
SharedBytes TcpStream::scenes() const {
  return server_->scenes();
}
std::uint8_t TcpStream::given_up() const {
  return server_->given_up();
}
std::optional<TcpStream::ClientClock> TcpStream::worst_clock() const {
  return server_->worst_clock();
}

bool TcpStream::has_untrusted_clients() const {
  return server_->has_untrusted_clients();
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
void TcpStream::set_admission(const AdmissionLimits& admission) {
  server_->set_admission(admission);
}
const ClientCounts& TcpStream::counts() const {
  return server_->counts();
}

}  // namespace yuragi::daemon::stream
