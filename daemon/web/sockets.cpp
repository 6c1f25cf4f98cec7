#include "daemon/web/sockets.hpp"

#include <algorithm>
#include <atomic>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "daemon/http/upgrade.hpp"
#include "daemon/stream/client_log.hpp"
#include "daemon/stream/client_queue.hpp"
#include "daemon/stream/frame_pace.hpp"
#include "daemon/stream/pose_views.hpp"
#include "daemon/web/request_body.hpp"
#include "engine/base/contain.hpp"
#include "engine/base/printable_text.hpp"

namespace yuragi::daemon::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using websocket::close_code;

/// Of a binary message, in one frame: a client that reads slowly is seen to read.
constexpr std::size_t kMaxFragmentBytes = 64UL << 10;
constexpr std::size_t kMaxReasonBytes = 120;  // RFC 6455, 5.5: 123
/// More than these in SocketLimits::check_every are a flood.
constexpr unsigned kMaxMessages = 32;

MonoTime now() {
  return std::chrono::time_point_cast<Nanoseconds>(std::chrono::steady_clock::now());
}

websocket::close_reason reason_of(close_code code, std::string text) {
  make_printable(text);
  std::size_t size = std::min(text.size(), kMaxReasonBytes);
  while (size < text.size() && size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  return {code, beast::string_view(text.data(), size)};
}

/// What all clients share.
struct Feed {
  explicit Feed(Sockets::Settings given) : settings(std::move(given)) {}

  Sockets::Settings settings;
  stream::SharedBytes hello = std::make_shared<const wire::Bytes>(wire::encode(settings.hello));
  stream::ClientLog log{{}, now};
  stream::PoseViews poses;
  stream::SharedBytes sensors_here, sensors_elsewhere;
  SharedText status_here, status_elsewhere;
  std::atomic<std::size_t> clients = 0, wind = 0, frames = 0, status = 0;  ///< how many want it
};

/// What a client is counted for.
struct Counted {
  bool wind = false, frames = false, status = false;
};

class Client : public std::enable_shared_from_this<Client> {
 public:
  Client(http::Upgrade& upgrade, Sockets::Visitor visitor, std::shared_ptr<Feed> feed)
      : stream_(std::move(upgrade.bytes)),
        request_(std::move(upgrade.request)),
        peer_(std::move(upgrade.client)),
        visitor_(std::move(visitor)),
        feed_(std::move(feed)) {
    error_code ignored;
    socket().set_option(tcp::no_delay(true), ignored);
    limit_send_buffer(limits().send_buffer_bytes);
    stream_.set_option(websocket::stream_base::timeout{
        .handshake_timeout = limits().stuck_after, .idle_timeout = limits().silent_after, .keep_alive_pings = true});
    stream_.read_message_max(wire::kMaxClientMessageBytes);
    stream_.auto_fragment(false);
  }

  const stream::Peer& peer() const { return peer_; }
  const Sockets::Visitor& visitor() const { return visitor_; }
  bool has_ended() const { return has_ended_; }

  void accept() {
    stream_.async_accept(request_, [self = shared_from_this()](const error_code& error) {
      if (error) return self->end(error.message());
      self->go_on([&] {
        self->is_open_ = true;
        self->feed_->log.info("http: {} opens a WebSocket", self->visitor_.address);
        self->read();
      });
    });
  }

  void offer_moment(MomentTexts& texts) {
    if (!is_served() || wish_.wind_hz <= 0.0) return;
    const double tick_rate_hz = feed_->settings.hello.tick_rate_hz;
    if (wish_.wind_hz < tick_rate_hz) {
      // Half a tick: a tick that comes a little early is not left out.
      const MonoTime time = texts.moment().mono + from_seconds(0.5 / tick_rate_hz);
      if (!wind_pace_) wind_pace_.emplace(wish_.wind_hz, time);
      if (!wind_pace_->take(time)) return;
    }
    wind_ = texts.of(wish_.places);
    write();
  }

  void offer_status() {
    if (!is_served() || wish_.status_hz <= 0.0) return;
    const SharedText& newest = visitor_.is_trusted ? feed_->status_here : feed_->status_elsewhere;
    if (!newest) return;
    constexpr auto kEarly = std::chrono::milliseconds(50);
    if (!status_pace_) status_pace_.emplace(wish_.status_hz, now());
    if (!status_pace_->take(now() + kEarly)) return;
    status_ = newest;
    write();
  }

  /// Offers the newest frame, unless the client has had it or one has been too short a time ago.
  void offer_frame() {
    if (!is_served() || !queue_ || !queue_->wants_frames() || !poses_->has_frame()) return;
    if (poses_->sequence() == offered_frame_ || (frame_pace_ && !frame_pace_->take(now()))) return;
    offered_frame_ = poses_->sequence();
    const stream::SharedBytes frame = poses_->frame();
    limit_send_buffer(2 * frame->size());  // one in flight, one ready to follow
    queue_->offer_frame(frame);
    write();
  }

  void offer_scenes() {
    if (!is_served() || !queue_ || !queue_->wants_poses()) return;
    if (!takes_new_scenes_) return close(close_code::policy_error, "the scenes have changed; connect again");
    if (auto why = feed_->poses.refusal(poses_->thinning())) return close(close_code::policy_error, std::move(*why));
    queue_->offer_scenes(poses_->scenes());
    write();
  }

  void offer_sensors() {
    if (!is_served() || !queue_) return;
    if (const auto& sensors = visitor_.is_trusted ? feed_->sensors_here : feed_->sensors_elsewhere)
      queue_->offer_sensors(sensors);
    write();
  }

  void check() {
    messages_ = 0;
    if (is_writing_ && now() - moved_ >= limits().stuck_after) return end("it stopped reading");
    offer_frame();  // the last one, unless a newer one replaces it
    const bool wants_nothing = !counted_.wind && !counted_.frames && !counted_.status && !queue_;
    if (is_served() && wants_nothing && now() - since_ >= limits().wish_within)
      close(close_code::policy_error, "it asked for nothing");
  }

  void close(close_code code, std::string why) {
    if (!is_served()) return;
    is_closing_ = true;
    count({});
    stream_.async_close(reason_of(code, why), [self = shared_from_this(), why](const error_code&) { self->end(why); });
  }

  void end(const std::string& why) {
    if (std::exchange(has_ended_, true)) return;
    count({});
    --feed_->clients;
    feed_->log.info("http: the WebSocket of {} has ended: {}", visitor_.address, why);
    error_code ignored;
    socket().close(ignored);
  }

 private:
  /// Does what an event is about. An exception ends this connection, and no other.
  template <class Work>
  void go_on(Work&& work) {
    if (!contain("a WebSocket", std::forward<Work>(work))) end("serving it failed, which is a fault of the daemon");
  }

  tcp::socket& socket() { return stream_.next_layer().socket(); }
  const SocketLimits& limits() const { return feed_->settings.limits; }
  bool is_served() const { return is_open_ && !is_closing_ && !has_ended_; }

  void limit_send_buffer(std::size_t bytes) {
    if (bytes <= send_buffer_bytes_) return;
    send_buffer_bytes_ = bytes;
    error_code ignored;
    socket().set_option(asio::socket_base::send_buffer_size(static_cast<int>(bytes)), ignored);
  }

  void count(Counted wanted) {
    const auto change = [](std::atomic<std::size_t>& all, bool before, bool after) {
      if (after && !before) ++all;
      if (before && !after) --all;
    };
    change(feed_->wind, counted_.wind, wanted.wind);
    change(feed_->frames, counted_.frames, wanted.frames);
    change(feed_->status, counted_.status, wanted.status);
    counted_ = wanted;
  }

  void read() {
    stream_.async_read(message_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (self->is_closing_) return;  // close() ends it
      if (error) {
        const bool has_closed = error == websocket::error::closed || error == asio::error::eof;
        return self->end(has_closed ? "the client closed it" : error.message());
      }
      self->go_on([&] {
        self->take_message();
        self->message_.consume(self->message_.size());
        if (self->is_served()) self->read();
      });
    });
  }

  void take_message() {
    if (++messages_ > kMaxMessages) return close(close_code::policy_error, "it sends too many messages");
    if (stream_.got_binary()) {
      const auto* const begin = static_cast<const std::uint8_t*>(message_.data().data());
      const auto message = wire::decode(std::span(begin, message_.size()));
      if (!message) return close(close_code::bad_payload, "not a message: " + std::string(name_of(message.error())));
      const auto* const wish = std::get_if<wire::Subscribe>(&*message);
      if (wish == nullptr) return close(close_code::policy_error, "only Subscribe is taken as a binary message");
      return subscribe(*wish);
    }
    auto wish = socket_wish_of(beast::buffers_to_string(message_.data()));
    if (!wish) return close(close_code::bad_payload, wish.error().message);
    wish_ = std::move(*wish);
    wind_pace_.reset();
    status_pace_.reset();
    wind_.reset();
    status_.reset();
    count({.wind = wish_.wind_hz > 0.0, .frames = counted_.frames, .status = wish_.status_hz > 0.0});
    if (wish_.stream) subscribe(*wish_.stream);
    offer_status();
  }

  /// As by TCP, but for raw messages.
  void subscribe(const wire::Subscribe& wish) {
    if (queue_) return close(close_code::policy_error, "the stream was asked for already; connect again");
    if (wish.protocol != wire::kProtocol)
      return close(close_code::policy_error, "this daemon speaks protocol " + std::to_string(wire::kProtocol));
    if (wish.raw) return close(close_code::policy_error, "raw messages are sent by TCP only");
    if (!visitor_.is_trusted && !wish.token.is_empty()) {
      const auto& is_token = feed_->settings.is_token;
      visitor_.is_trusted = is_token && is_token(wish.token.reveal());
      if (!visitor_.is_trusted) return close(close_code::policy_error, "its token is not that of this installation");
    }
    if (wish.poses) {
      if (auto why = feed_->poses.refusal(wish.thinning)) return close(close_code::policy_error, std::move(*why));
    }
    takes_new_scenes_ = wish.takes_new_scenes;
    if (wish.wants_frames()) poses_ = feed_->poses.view(wish.frame_thinning());
    if (wish.rate_hz > 0.0 && wish.rate_hz < feed_->settings.hello.tick_rate_hz)
      frame_pace_.emplace(wish.rate_hz, now());
    queue_.emplace(stream::ClientLimits{}, feed_->hello, now());
    queue_->subscribe({.poses = wish.poses, .sensors = wish.sensors, .traces = false, .wind = wish.wind},
                      poses_ ? poses_->scenes() : nullptr, nullptr,
                      visitor_.is_trusted ? feed_->sensors_here : feed_->sensors_elsewhere, now());
    Counted wanted = counted_;
    wanted.frames = wish.wants_frames();
    count(wanted);
    offer_frame();
    write();
  }

  /// Starts the next write, unless one is in progress.
  void write() {
    if (is_writing_ || !is_served()) return;
    if (!is_within_binary_) {
      for (SharedText* const text : {&wind_, &status_}) {
        if (*text) return write_text(std::exchange(*text, nullptr));
      }
    }
    if (!queue_) return;
    auto bytes = queue_->to_write(now());
    if (bytes.empty()) return;
    if (!std::exchange(is_within_binary_, true)) {
      stream_.binary(true);
      queue_->written(wire::kSizePrefixBytes, now());  // a WebSocket's message has its own length
      bytes = queue_->to_write(now());
    }
    const std::size_t size = std::min(bytes.size(), kMaxFragmentBytes);
    const bool is_last = size == bytes.size();
    begin_write();
    stream_.async_write_some(is_last, asio::buffer(bytes.data(), size),
                             [self = shared_from_this(), size, is_last](const error_code& error, std::size_t) {
                               self->go_on([&] {
                                 if (is_last) self->is_within_binary_ = false;
                                 self->queue_->written(size, now());
                                 self->after_write(error);
                               });
                             });
  }

  void write_text(SharedText text) {
    stream_.text(true);
    begin_write();
    const auto buffer = asio::buffer(*text);
    stream_.async_write(buffer,
                        [self = shared_from_this(), text = std::move(text)](const error_code& error, std::size_t) {
                          self->go_on([&] { self->after_write(error); });
                        });
  }

  void begin_write() {
    is_writing_ = true;
    moved_ = now();
  }
  void after_write(const error_code& error) {
    is_writing_ = false;
    if (is_closing_) return;
    if (error) return end(error.message());
    write();
  }

  websocket::stream<http::ByteStream, false> stream_;
  boost::beast::http::request<boost::beast::http::string_body> request_;
  stream::Peer peer_;
  Sockets::Visitor visitor_;
  std::shared_ptr<Feed> feed_;
  Counted counted_;
  MonoTime since_ = now();
  std::size_t send_buffer_bytes_ = 0;
  beast::flat_buffer message_;
  unsigned messages_ = 0;  // since the last check

  SocketWish wish_;
  std::optional<stream::FramePace> wind_pace_, status_pace_, frame_pace_;  // nullopt: not begun, or all are sent
  SharedText wind_, status_;                                               // that wait
  std::optional<stream::ClientQueue> queue_;                               // nullopt: it wants nothing of the stream
  std::shared_ptr<stream::PoseView> poses_;                                // null: it wants no frames
  std::uint64_t offered_frame_ = 0;                                        // by its number in PoseView::sequence()
  bool takes_new_scenes_ = false;
  bool is_within_binary_ = false;  // its other fragments follow

  bool is_writing_ = false;
  MonoTime moved_{};  // when the write began
  bool is_open_ = false, is_closing_ = false, has_ended_ = false;
};

}  // namespace

class Sockets::Server : public std::enable_shared_from_this<Server> {
 public:
  Server(asio::io_context& io, Settings settings) : timer_(io), feed_(std::make_shared<Feed>(std::move(settings))) {}

  Feed& feed() { return *feed_; }

  std::optional<std::string> refusal(const stream::Peer& client) const {
    std::vector<stream::Peer> present;
    for (const auto& other : clients_) {
      if (!other->has_ended()) present.push_back(other->peer());
    }
    return stream::admission_refusal(feed_->settings.limits.places, present, client);
  }

  void open(http::Upgrade& upgrade, Visitor visitor) {
    std::erase_if(clients_, [](const auto& client) { return client->has_ended(); });
    clients_.push_back(std::make_shared<Client>(upgrade, std::move(visitor), feed_));
    ++feed_->clients;
    clients_.back()->accept();
    if (!std::exchange(is_checking_, true)) check_later();
  }

  /// An exception ends the connection of this one client.
  template <class Work>
  void for_each(Work&& work) {
    for (const auto& client : clients_) {
      if (!contain("a WebSocket", [&] { work(*client); })) client->end("serving it failed, a fault of the daemon");
    }
  }

  void close() {
    timer_.cancel();
    for_each([](Client& client) { client.end("the daemon is stopping"); });
    clients_.clear();
  }

 private:
  void check_later() {
    timer_.expires_after(feed_->settings.limits.check_every);
    timer_.async_wait([self = shared_from_this()](const error_code& error) {
      if (error) return;
      self->for_each([](Client& client) { client.check(); });
      std::erase_if(self->clients_, [](const auto& client) { return client->has_ended(); });
      self->feed_->log.report_left_out();
      self->is_checking_ = !self->clients_.empty();
      if (self->is_checking_) self->check_later();
    });
  }

  asio::steady_timer timer_;
  std::shared_ptr<Feed> feed_;
  std::vector<std::shared_ptr<Client>> clients_;
  bool is_checking_ = false;
};

Sockets::Sockets(asio::io_context& io, Settings settings)
    : server_(std::make_shared<Server>(io, std::move(settings))) {}
Sockets::~Sockets() {
  close();
}

std::optional<std::string> Sockets::refusal(const stream::Peer& client) const {
  return server_->refusal(client);
}
void Sockets::open(http::Upgrade& upgrade, Visitor visitor) {
  server_->open(upgrade, std::move(visitor));
}
bool Sockets::wants_wind() const noexcept {
  return server_->feed().wind > 0;
}
bool Sockets::wants_frames() const noexcept {
  return server_->feed().frames > 0;
}
bool Sockets::wants_status() const noexcept {
  return server_->feed().status > 0;
}
std::size_t Sockets::client_count() const noexcept {
  return server_->feed().clients;
}
void Sockets::publish_moment(std::shared_ptr<const values::Moment> moment) {
  MomentTexts texts(std::move(moment));
  server_->for_each([&](Client& client) { client.offer_moment(texts); });
}
void Sockets::publish_frame(stream::SharedBytes frame) {
  server_->feed().poses.set_frame(std::move(frame));
  server_->for_each([](Client& client) { client.offer_frame(); });
}
void Sockets::publish_scenes(stream::SharedBytes scenes) {
  server_->feed().poses.set_scenes(std::move(scenes));
  server_->for_each([](Client& client) { client.offer_scenes(); });
}
void Sockets::publish_sensors(stream::SharedBytes here, stream::SharedBytes elsewhere) {
  server_->feed().sensors_here = std::move(here);
  server_->feed().sensors_elsewhere = std::move(elsewhere);
  server_->for_each([](Client& client) { client.offer_sensors(); });
}
void Sockets::publish_status(SharedText here, SharedText elsewhere) {
  server_->feed().status_here = std::move(here);
  server_->feed().status_elsewhere = std::move(elsewhere);
  server_->for_each([](Client& client) { client.offer_status(); });
}
void Sockets::end_session(const std::string& id) {
  server_->for_each([&id](Client& client) {
    if (client.visitor().session == id) client.close(close_code::policy_error, "its session has ended");
  });
}
void Sockets::close() {
  server_->close();
}

}  // namespace yuragi::daemon::web
