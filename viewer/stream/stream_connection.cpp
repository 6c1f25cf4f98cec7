#include "viewer/stream/stream_connection.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "engine/base/close_on_exec.hpp"
#include "engine/base/contain.hpp"
#include "engine/platform/backoff.hpp"
#include "engine/wire/message_reader.hpp"

namespace yuragi::viewer::stream {
namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

/// Connection attempts run one after the other on one thread; a handler of an abandoned attempt finds `attempt_`
/// changed and does nothing.
class Connection::Session {
 public:
  explicit Session(Options options)
      : options_(std::move(options)),
        backoff_(options_.min_backoff, options_.max_backoff, static_cast<std::uint32_t>(getpid())) {
    subscription_ = wire::encode(wire::Subscribe{
        .poses = true, .sensors = true, .client = "yuragi-viewer", .takes_new_scenes = true, .token = options_.token});
    connect();
    thread_ = std::thread([this] { serve(); });
  }

  ~Session() {
    context_.stop();
    thread_.join();
  }

  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  Inbox take() {
    const std::lock_guard lock(mutex_);
    has_news_ = false;
    return std::exchange(inbox_, {});
  }

  Status status() const {
    const std::lock_guard lock(mutex_);
    return status_;
  }

  void send(const wire::Control& control) {
    asio::post(context_, [this, bytes = wire::encode(control)]() mutable { send_now(std::move(bytes)); });
  }
  void send(const wire::Display& display) {
    asio::post(context_, [this, bytes = wire::encode(display)]() mutable {
      if (takes_display_) send_now(std::move(bytes));
    });
  }

  void wait_for_news(Nanoseconds limit) {
    std::unique_lock lock(mutex_);
    news_.wait_for(lock, limit, [this] { return has_news_; });
    has_news_ = false;
  }

 private:
  /// An exception is an error of this program, or a lack of memory for a message: the connection is closed, as for any
  /// other error.
  void serve() {
    const auto lose_connection = [this](const char* what) {
      give_up(fmt::format("lost the connection to {} by an error of this program ({})", address(), what));
    };
    while (!contain(
        "the connection to the daemon", [this] { context_.run(); }, lose_connection)) {
    }
  }

  std::string address() const { return fmt::format("{}:{}", options_.host, options_.port); }

  void set_status(State state, std::string text) {
    const std::lock_guard lock(mutex_);
    status_ = {state, std::move(text), state == State::kConnected && is_same_machine()};
    announce_change();
  }

  /// A client that connects to an address of its own machine has the same address.
  bool is_same_machine() const {
    error_code no_local;
    error_code no_remote;
    const auto local = socket_.local_endpoint(no_local);
    const auto remote = socket_.remote_endpoint(no_remote);
    return !no_local && !no_remote && local.address() == remote.address();
  }

  void begin_inbox() {
    const std::lock_guard lock(mutex_);
    inbox_.is_of_new_connection = true;
    inbox_.replies.clear();
  }

  /// With mutex_ held.
  void announce_change() {
    has_news_ = true;
    news_.notify_all();
  }

  // --- an attempt: resolve, connect, subscribe, read ---

  void connect() {
    const std::uint64_t attempt = ++attempt_;
    reader_ = wire::MessageReader(wire::kMaxServerMessageBytes);
    set_status(State::kConnecting, "connecting to " + address());
    watch_silence(attempt);
    resolver_.async_resolve(options_.host, std::to_string(options_.port),
                            [this, attempt](error_code error, const tcp::resolver::results_type& found) {
                              if (attempt != attempt_) return;
                              if (error) return give_up("cannot find " + options_.host + ": " + error.message());
                              open(attempt, found);
                            });
  }

  void open(std::uint64_t attempt, const tcp::resolver::results_type& found) {
    asio::async_connect(socket_, found, [this, attempt](error_code error, const tcp::endpoint&) {
      if (attempt != attempt_) return;
      if (error) return give_up(fmt::format("no daemon replies at {}: {}", address(), error.message()));
      subscribe(attempt);
    });
  }

  void subscribe(std::uint64_t attempt) {
    close_on_exec(socket_.native_handle());
    error_code ignored;
    socket_.set_option(tcp::no_delay(true), ignored);
    asio::async_write(socket_, asio::buffer(subscription_), [this, attempt](error_code error, std::size_t) {
      if (attempt != attempt_) return;
      if (error) return give_up("the connection to " + address() + " was lost: " + error.message());
      is_subscribed_ = true;
    });
    begin_inbox();
    set_status(State::kConnected, "connected to " + address());
    read(attempt);
  }

  void send_now(wire::Bytes bytes) {
    if (!is_subscribed_) return;
    unsent_.push_back(std::move(bytes));
    if (!is_writing_) write(attempt_);
  }

  /// Writes the messages of send(), one after the other.
  void write(std::uint64_t attempt) {
    is_writing_ = !unsent_.empty();
    if (!is_writing_) return;
    const auto bytes = std::make_shared<const wire::Bytes>(std::move(unsent_.front()));
    unsent_.pop_front();
    asio::async_write(socket_, asio::buffer(*bytes), [this, attempt, bytes](error_code error, std::size_t) {
      if (attempt != attempt_) return;
      if (error) return give_up("the connection to " + address() + " was lost: " + error.message());
      write(attempt);
    });
  }

  void read(std::uint64_t attempt) {
    socket_.async_read_some(asio::buffer(received_), [this, attempt](error_code error, std::size_t count) {
      if (attempt != attempt_) return;
      if (error) return give_up("the stream from " + address() + " ended: " + error.message());
      watch_silence(attempt);
      reader_.feed(std::span(received_).first(count));
      if (digest()) read(attempt);
    });
  }

  /// Passes on each whole message. Returns false if the connection was abandoned.
  bool digest() {
    while (auto message = reader_.next()) {
      if (!*message) {
        if (message->error() == wire::Error::kUnknown) continue;  // of a newer server
        give_up(fmt::format("{} is not a Yuragi daemon: {}", address(), wire::name_of(message->error())));
        return false;
      }
      if (const auto* hello = std::get_if<wire::Hello>(&**message)) {
        if (hello->refused) {
          give_up(fmt::format("the daemon at {} refuses the connection: {}", address(), *hello->refused));
          return false;
        }
        if (const auto mismatch = wire::protocol_mismatch(*hello)) {
          give_up(fmt::format("the daemon at {} ({}) {}", address(), hello->software, *mismatch));
          return false;
        }
        takes_display_ = hello->takes_display;
      }
      deliver(std::move(**message));
    }
    return true;
  }

  void deliver(wire::Message message) {
    const MonoTime arrival = std::chrono::steady_clock::now();
    backoff_.reset();
    const std::lock_guard lock(mutex_);
    if (auto* frame = std::get_if<wire::Frame>(&message)) {
      if (inbox_.frames.size() == kMaxWaitingFrames) inbox_.frames.erase(inbox_.frames.begin());
      inbox_.frames.push_back({std::move(*frame), arrival});
    } else if (auto* scenes = std::get_if<wire::Scenes>(&message)) {
      inbox_.scenes = std::move(*scenes);
      inbox_.frames.clear();  // of the previous scenes
    } else if (auto* sensors = std::get_if<wire::Sensors>(&message)) {
      inbox_.sensors = std::move(*sensors);
    } else if (auto* reply = std::get_if<wire::ControlReply>(&message)) {
      if (inbox_.replies.size() == kMaxWaitingReplies) inbox_.replies.erase(inbox_.replies.begin());
      inbox_.replies.push_back(std::move(*reply));
    } else if (const auto* hello = std::get_if<wire::Hello>(&message)) {
      inbox_.wind_from_deg = hello->wind_from_deg;
      status_.text = fmt::format("connected to {} ({})", address(), hello->software);
    }
    announce_change();
  }

  // --- its end ---

  void watch_silence(std::uint64_t attempt) {
    silence_.expires_after(options_.silence_limit);
    silence_.async_wait([this, attempt](error_code error) {
      if (error || attempt != attempt_) return;
      give_up(address() + " has sent nothing for too long");
    });
  }

  void give_up(const std::string& why) {
    ++attempt_;
    is_subscribed_ = is_writing_ = false;
    unsent_.clear();
    error_code ignored;
    resolver_.cancel();
    silence_.cancel();
    socket_.close(ignored);
    set_status(State::kWaiting, why);
    retry_.expires_after(backoff_.next());
    retry_.async_wait([this](error_code error) {
      if (!error) connect();
    });
  }

  const Options options_;
  wire::Bytes subscription_;

  // Used by the connection's thread only.
  bool is_subscribed_ = false;
  bool is_writing_ = false;
  bool takes_display_ = false;      // the daemon of the newest Hello
  std::deque<wire::Bytes> unsent_;  // Controls and Displays
  asio::io_context context_{1};
  tcp::resolver resolver_{context_};
  tcp::socket socket_{context_};
  asio::steady_timer silence_{context_};
  asio::steady_timer retry_{context_};
  platform::Backoff backoff_;
  std::uint64_t attempt_ = 0;
  wire::MessageReader reader_;
  std::array<std::uint8_t, 1u << 16> received_{};

  // Shared with the reader.
  mutable std::mutex mutex_;
  std::condition_variable news_;
  bool has_news_ = false;
  Inbox inbox_;
  Status status_;

  std::thread thread_;
};

Connection::Connection(Options options) : session_(std::make_unique<Session>(std::move(options))) {}
Connection::~Connection() = default;

Inbox Connection::take() {
  return session_->take();
}
Status Connection::status() const {
  return session_->status();
}
void Connection::send(const wire::Control& control) {
  session_->send(control);
}
void Connection::send(const wire::Display& display) {
  session_->send(display);
}
void Connection::wait_for_news(Nanoseconds limit) {
  session_->wait_for_news(limit);
}

}  // namespace yuragi::viewer::stream
