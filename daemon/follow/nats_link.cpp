// libnats 3.4.1. The link's thread is its "event loop": it reads and writes the socket without waiting, and libnats
// starts no thread that touches our data. A name look-up and a TLS handshake of libnats have no time limit. So each
// attempt to connect has a thread of its own, which is left behind if it hangs.
#include "daemon/follow/nats_link.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <iterator>
#include <memory>
#include <mutex>
#include <random>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <nats/nats.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <openssl/crypto.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include "daemon/follow/nkey.hpp"
#include "daemon/settings/secret_exposure.hpp"
#include "engine/base/close_on_exec.hpp"
#include "engine/base/contain.hpp"
#include "engine/base/printable_text.hpp"
#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"
#include "engine/base/time.hpp"
#include "engine/platform/backoff.hpp"
#include "engine/platform/descriptor.hpp"
#include "engine/platform/secret_file.hpp"

namespace yuragi::daemon::follow {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kConnectTimeout = std::chrono::milliseconds(1000);
constexpr auto kMaxAttempt = std::chrono::seconds(5);  ///< then its thread is left behind
constexpr int kMaxHangingAttempts = 8;                 ///< threads that may be left behind at a time
constexpr auto kMinRetry = std::chrono::milliseconds(250);
constexpr auto kMaxRetry = std::chrono::seconds(5);
constexpr auto kSteady = std::chrono::seconds(5);  ///< a connection that lasts so long is a good one
constexpr auto kFarewell = std::chrono::milliseconds(250);
constexpr int kHousekeeping_ms = 1000;
constexpr int kMaxBuffered = 256 * 1024;                                 ///< bytes in libnats; more waits in the queue
constexpr std::size_t kMaxWaitingBytes = std::size_t{64} * 1024 * 1024;  ///< of one queue

std::string random_inbox() {
  std::random_device random;
  std::string inbox = "_INBOX.";
  for (int i = 0; i < 4; ++i) inbox += fmt::format("{:08x}", random());
  return inbox;
}

/// Returns the server without user and password, which no log shows.
std::string shown(const std::string& server) {
  const std::size_t scheme = server.find("://");
  const std::size_t begin = scheme == std::string::npos ? 0 : scheme + 3;
  const std::size_t at = server.rfind('@');
  if (at == std::string::npos || at < begin) return server;
  return server.substr(0, begin) + server.substr(at + 1);
}

std::string host_of(const std::string& server) {
  std::string host = shown(server);
  if (const std::size_t scheme = host.find("://"); scheme != std::string::npos) host.erase(0, scheme + 3);
  if (host.starts_with('[')) return host.substr(1, host.find(']') - 1);
  return host.substr(0, host.find(':'));
}

/// Returns true if a subject can be sent: a space or a control character could begin a command to the server.
bool is_subject(std::string_view subject) {
  return !subject.empty() &&
         std::ranges::all_of(subject, [](char character) { return character > ' ' && character != 0x7f; });
}

/// Returns libnats's text of the last error of this thread, without the place in its sources.
std::string last_error() {
  natsStatus status = NATS_OK;
  const char* const text = nats_GetLastError(&status);
  std::string error = text == nullptr ? "" : text;
  if (const std::size_t place = error.find("): "); error.starts_with('(') && place != std::string::npos) {
    error.erase(0, place + 3);
  }
  make_printable(error);
  return error;
}

/// Returns what is wrong with a connection, and what to do.
std::string explain(const std::string& server, natsStatus status, const std::string& text) {
  switch (status) {
    case NATS_CONNECTION_AUTH_FAILED:
      return fmt::format("{} does not accept this user: check the file of credentials and the server's users", server);
    case NATS_NO_SERVER:
    case NATS_TIMEOUT:
      return fmt::format("cannot reach {}: check its address, the network, and that it is running", server);
    case NATS_SECURE_CONNECTION_WANTED:
      return fmt::format("{} offers no TLS: write nats:// for a connection without, or enable TLS on the server",
                         server);
    case NATS_SSL_ERROR:
      return fmt::format("the TLS connection to {} failed ({}): check the authorities and the server's certificate",
                         server, text);
    default:
      return fmt::format("lost the connection to {} ({}): check the network, and that it is running", server, text);
  }
}

/// Releases what libnats and OpenSSL keep for this thread. They then do nothing more when the thread ends, which may be
/// at the same time as the end of the program.
void release_thread_memory() {
  nats_ReleaseThreadMemory();
  OPENSSL_thread_stop();
}

void check(natsStatus status, const std::string& what) {
  if (status == NATS_OK) return;
  const std::string text = last_error();
  throw FailureError(Failure{fmt::format("{}: {}", what, text.empty() ? natsStatus_GetText(status) : text)});
}

struct FreeOptions {
  void operator()(natsOptions* options) const noexcept { natsOptions_Destroy(options); }
};
struct FreeSubscription {
  void operator()(natsSubscription* subscription) const noexcept { natsSubscription_Destroy(subscription); }
};

/// A queue of messages with a limit. Thread-safe: no.
class MessageQueue {
 public:
  explicit MessageQueue(std::size_t max_messages) : max_messages_(max_messages) {}

  /// Returns false, and drops the message, if the queue is full.
  bool push(NatsMessage message) {
    if (messages_.size() >= max_messages_ || bytes_ + message.bytes.size() > kMaxWaitingBytes) return false;
    bytes_ += message.bytes.size();
    messages_.push_back(std::move(message));
    return true;
  }
  std::optional<NatsMessage> pop() {
    if (messages_.empty()) return std::nullopt;
    NatsMessage message = std::move(messages_.front());
    messages_.pop_front();
    bytes_ -= message.bytes.size();
    return message;
  }
  std::vector<NatsMessage> take_all() {
    std::vector<NatsMessage> all(std::make_move_iterator(messages_.begin()), std::make_move_iterator(messages_.end()));
    clear();
    return all;
  }
  void clear() {
    messages_.clear();
    bytes_ = 0;
  }
  std::size_t size() const { return messages_.size(); }

 private:
  std::size_t max_messages_;
  std::size_t bytes_ = 0;
  std::deque<NatsMessage> messages_;
};

/// A connection to one server. connect() runs on a thread of its own; then one thread uses it. Only shut_down() may be
/// called by others, at any time.
class Connection {
 public:
  Connection(const NatsSettings& settings, std::string server, std::vector<std::string> subjects)
      : server_(std::move(server)), subjects_(std::move(subjects)), options_(make_options()) {
    natsOptions* const options = options_.get();
    check(natsOptions_SetURL(options, server_.c_str()), "the address " + shown(server_));
    check(natsOptions_SetName(options, settings.name.c_str()), "the name");
    natsOptions_SetTimeout(options, kConnectTimeout.count());
    natsOptions_SetAllowReconnect(options, false);
    natsOptions_SetPingInterval(options, 0);  // its timer's thread would end the connection beside ours
    natsOptions_SetSendAsap(options, true);
    natsOptions_DisableNoResponders(options, true);
    natsOptions_SetErrorHandler(options, &ignore_error, nullptr);  // without one it writes to standard error
    natsOptions_SetEventLoop(options, this, &attach, &want_to_read, &want_to_write, &detach);
    set_tls(settings.authorities);
    if (!settings.credentials.empty()) set_credentials(settings.credentials);
  }

  /// Never waits for the server.
  ~Connection() {
    if (connection_ != nullptr) {
      // If something is not yet sent, libnats would wait 0.5 s for the server. A failed write prevents this.
      if (natsConnection_Buffered(connection_) > 0) {
        shut_down();
        natsConnection_ProcessWriteEvent(connection_);
      }
      subscriptions_.clear();
      natsConnection_Destroy(connection_);
    }
    platform::close_if_open(socket_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Connects and subscribes. Waits.
  Result<void, Failure> connect() {
    const natsStatus status = natsConnection_Connect(&connection_, options_.get());
    if (status != NATS_OK) return Failure{explain(shown(server_), status, last_error())};
    for (const std::string& subject : subjects_) {
      natsSubscription* subscription = nullptr;
      check(natsConnection_SubscribeSync(&subscription, connection_, subject.c_str()), "the subject " + subject);
      subscriptions_.emplace_back(subscription);
    }
    return {};
  }

  /// Returns false if the message cannot be sent, for example because it is too long for the server.
  bool publish(const NatsMessage& message) {
    const auto* const bytes = message.bytes.data();
    const auto size = static_cast<int>(message.bytes.size());
    return (message.reply_to.empty() ? natsConnection_Publish(connection_, message.subject.c_str(), bytes, size)
                                     : natsConnection_PublishRequest(connection_, message.subject.c_str(),
                                                                     message.reply_to.c_str(), bytes, size)) == NATS_OK;
  }
  bool is_full() const { return natsConnection_Buffered(connection_) >= kMaxBuffered; }

  /// Waits until something comes, something can be sent, or `event` is readable; sends and reads.
  void turn(int event, int timeout_ms) {
    const auto wanted = static_cast<short>(wants_to_write_ ? POLLIN | POLLOUT : POLLIN);
    std::array<pollfd, 2> waits = {{{socket_, wanted, 0}, {event, POLLIN, 0}}};
    if (poll(waits.data(), waits.size(), timeout_ms) <= 0) return;
    if ((waits[0].revents & POLLOUT) != 0) natsConnection_ProcessWriteEvent(connection_);
    if ((waits[0].revents & ~POLLOUT) != 0) natsConnection_ProcessReadEvent(connection_);
  }

  /// Calls `take` with each message (natsMsg) that turn() has read.
  template <class Take>
  void take_messages(const Take& take) {
    for (const auto& subscription : subscriptions_) {
      natsMsg* message = nullptr;
      while (natsSubscription_NextMsg(&message, subscription.get(), 0) == NATS_OK) {
        const std::unique_ptr<natsMsg, decltype(&natsMsg_Destroy)> owner(message, &natsMsg_Destroy);
        take(message);
      }
    }
  }

  bool is_closed() const { return natsConnection_IsClosed(connection_); }

  /// Returns what the server did not permit, or why the connection is closed; otherwise an empty text.
  std::string trouble() const {
    const char* text = nullptr;
    const natsStatus status = natsConnection_GetLastError(connection_, &text);
    if (status == NATS_OK) return is_closed() ? explain(shown(server_), NATS_CONNECTION_CLOSED, "closed") : "";
    // The text can be that of an earlier error, if the server reported nothing when the connection was lost.
    std::string error = status == NATS_ERR || status == NATS_NOT_PERMITTED ? text : natsStatus_GetText(status);
    make_printable(error);
    if (status != NATS_NOT_PERMITTED) return explain(shown(server_), status, error);
    return fmt::format("{} does not permit this user something ({}): change the permissions in its configuration",
                       shown(server_), error);
  }

  /// Ends every wait for the server: the connection is lost then. Thread-safe.
  void shut_down() noexcept {
    if (const int socket = socket_; socket >= 0) ::shutdown(socket, SHUT_RDWR);
  }

  /// Lets sent messages reach the server after the connection is destroyed. Without, they are discarded then.
  void linger() const noexcept {
    const struct linger none {};
    setsockopt(socket_, SOL_SOCKET, SO_LINGER, &none, sizeof none);
  }

 private:
  static std::unique_ptr<natsOptions, FreeOptions> make_options() {
    natsOptions* options = nullptr;
    check(natsOptions_Create(&options), "libnats");
    return std::unique_ptr<natsOptions, FreeOptions>(options);
  }

  /// By nats:// there is TLS if the server requires it.
  void set_tls(const std::filesystem::path& authorities) {
    natsOptions* const options = options_.get();
    if (server_.starts_with("tls://")) check(natsOptions_SetSecure(options, true), "TLS");
    check(natsOptions_SetExpectedHostname(options, host_of(server_).c_str()), "TLS");
    if (authorities.empty()) return;  // OpenSSL's own
    const std::string file = authorities.string();
    check(natsOptions_LoadCATrustedCertificates(options, file.c_str()), "the authorities in " + file);
  }

  void set_credentials(const std::filesystem::path& file) {
    if (settings::is_read_by_everybody(file)) {
      throw FailureError(Failure{fmt::format("everybody on this machine can read {0}: chmod 640 {0}", file.string())});
    }
    seed_ = platform::secret_in_file(file).value();
    const std::string& text = seed_.reveal();
    if (const std::size_t colon = text.find(':'); colon != std::string::npos) {
      check(natsOptions_SetUserInfo(options_.get(), text.substr(0, colon).c_str(), text.substr(colon + 1).c_str()),
            "the user");
      return;
    }
    const auto key = public_nkey(seed_);
    if (!key) {
      throw FailureError(
          Failure{fmt::format("\"{}\" has neither user:password nor the seed of an nkey (SU...)", file.string())});
    }
    check(natsOptions_SetNKey(options_.get(), key->c_str(), &sign, this), "the nkey");
  }

  static natsStatus sign(char** /*error*/, unsigned char** signature, int* size, const char* nonce, void* self) {
    return nats_Sign(static_cast<Connection*>(self)->seed_.reveal().c_str(), nonce, signature, size);
  }

  static void ignore_error(natsConnection*, natsSubscription*, natsStatus, void*) noexcept {}

  static natsStatus attach(void** user, void* self, natsConnection*, natsSock socket) noexcept {
    auto* const connection = static_cast<Connection*>(self);
    *user = self;
    close_on_exec(socket);
    // A descriptor of our own: shut_down() on another thread never meets one that libnats has closed.
    connection->socket_ = fcntl(socket, F_DUPFD_CLOEXEC, 0);
    if (connection->socket_ < 0) return NATS_SYS_ERROR;
    // The system notices a machine that vanished.
    const int yes = 1, idle_s = 5, interval_s = 1, count = 5;
    const unsigned unacknowledged_ms = 10'000;
    setsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &yes, sizeof yes);
    setsockopt(socket, IPPROTO_TCP, TCP_KEEPIDLE, &idle_s, sizeof idle_s);
    setsockopt(socket, IPPROTO_TCP, TCP_KEEPINTVL, &interval_s, sizeof interval_s);
    setsockopt(socket, IPPROTO_TCP, TCP_KEEPCNT, &count, sizeof count);
    setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &unacknowledged_ms, sizeof unacknowledged_ms);
    return NATS_OK;
  }
  static natsStatus want_to_read(void*, bool) noexcept { return NATS_OK; }
  static natsStatus want_to_write(void* self, bool wants) noexcept {
    static_cast<Connection*>(self)->wants_to_write_ = wants;
    return NATS_OK;
  }
  static natsStatus detach(void*) noexcept { return NATS_OK; }

  std::string server_;
  std::vector<std::string> subjects_;
  Secret seed_;
  std::unique_ptr<natsOptions, FreeOptions> options_;
  natsConnection* connection_ = nullptr;
  std::vector<std::unique_ptr<natsSubscription, FreeSubscription>> subscriptions_;
  int socket_ = -1;
  bool wants_to_write_ = false;
};

/// An attempt to connect, shared by the thread that makes it and the one that waits for it.
struct Attempt {
  std::mutex mutex;
  std::condition_variable changed;
  bool is_over = false;
  Result<void, Failure> result = Failure{"an error in this program"};
};

}  // namespace

struct NatsLink::Shared {
  Shared(NatsSettings with, std::vector<std::string> of, std::function<void()> call)
      : settings(std::move(with)), subjects(std::move(of)), on_arrival(std::move(call)) {
    subjects.push_back(inbox);
    if (event.get() < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  }

  void wake() const noexcept { eventfd_write(event.get(), 1); }

  const NatsSettings settings;
  const std::string inbox = random_inbox();
  std::vector<std::string> subjects;  ///< constant after the constructor
  const platform::Descriptor event{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  std::atomic<int> hanging_attempts = 0;

  const std::function<void()> on_arrival;
  std::mutex arrival_mutex;  ///< held while on_arrival runs
  bool is_arrival_over = false;

  mutable std::mutex mutex;  ///< of all that follows
  std::condition_variable changed;
  MessageQueue outgoing{settings.max_waiting}, incoming{settings.max_waiting};
  std::shared_ptr<Connection> connection;  ///< null: not connected
  State state;
  bool is_leaving = false, is_ending = false, is_over = false;
};

/// Runs on the thread; what it shares with the owner is Shared alone, so that it can outlive it.
class NatsLink::Worker {
 public:
  explicit Worker(std::shared_ptr<Shared> shared)
      : shared_(std::move(shared)), backoff_(kMinRetry, kMaxRetry, std::random_device{}()) {}

  void run() {
    for (std::size_t turn = 0; !is_ending(); ++turn) {
      Result<void, Failure> result = Failure{"an error in this program"};
      contain("the connection to NATS", [&] {
        try {
          result = connect_and_work(turn);
        } catch (const FailureError& error) {
          result = Failure{error.what()};
        }
      });
      end_connection();
      if (is_ending()) return;
      if (was_left()) continue;
      note_trouble(result ? std::string() : result.error().message, false);
      if (std::exchange(is_steady_, false)) continue;
      if (++failures_ % std::max<std::size_t>(settings().servers.size(), 1) == 0) wait_before_retry();
    }
  }

 private:
  const NatsSettings& settings() const { return shared_->settings; }

  bool is_ending() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->is_ending;
  }

  Result<void, Failure> connect_and_work(std::size_t turn) {
    if (settings().servers.empty()) return Failure{"no NATS server is configured"};
    const std::string& server = settings().servers[turn % settings().servers.size()];
    {
      const std::lock_guard lock(shared_->mutex);
      shared_->state.server = shown(server);
    }
    connection_ = std::make_shared<Connection>(settings(), server, shared_->subjects);
    if (auto connected = connect_in_time(server); !connected) return connected;
    connected_ = Clock::now();
    is_steady_ = false;
    not_permitted_.clear();
    {
      const std::lock_guard lock(shared_->mutex);
      shared_->connection = connection_;
      shared_->is_leaving = false;
      shared_->state.is_connected = true;
      shared_->state.trouble.clear();
      ++shared_->state.connections;
    }
    return work();
  }

  /// Connects on a thread that can be left behind, with the connection.
  Result<void, Failure> connect_in_time(const std::string& server) {
    if (shared_->hanging_attempts >= kMaxHangingAttempts) {
      return Failure{
          fmt::format("{} attempts to connect hang in name look-ups or TLS handshakes: check the network, or "
                      "restart this program",
                      kMaxHangingAttempts)};
    }
    const auto attempt = std::make_shared<Attempt>();
    std::thread([attempt, shared = shared_, connection = connection_]() mutable {
      Result<void, Failure> result = Failure{"an error in this program"};
      contain("an attempt to connect to NATS", [&] {
        try {
          result = connection->connect();
        } catch (const FailureError& error) {
          result = Failure{error.what()};
        }
      });
      connection.reset();
      release_thread_memory();
      --shared->hanging_attempts;
      const std::lock_guard lock(attempt->mutex);
      attempt->result = std::move(result);
      attempt->is_over = true;
      attempt->changed.notify_all();
    }).detach();
    ++shared_->hanging_attempts;
    std::unique_lock lock(attempt->mutex);
    if (attempt->changed.wait_for(lock, kMaxAttempt, [&] { return attempt->is_over; })) return attempt->result;
    connection_.reset();
    return Failure{
        fmt::format("{} does not reply to a name look-up or a TLS handshake: check its address, the network, and that "
                    "it is running",
                    shown(server))};
  }

  Result<void, Failure> work() {
    while (true) {
      send_waiting();
      connection_->turn(shared_->event.get(), kHousekeeping_ms);
      eventfd_t ignored = 0;
      eventfd_read(shared_->event.get(), &ignored);
      take_messages();
      if (is_ending()) {
        say_goodbye();
        return {};
      }
      const std::string trouble = connection_->trouble();
      if (connection_->is_closed()) return Failure{trouble};
      if (!trouble.empty() && std::exchange(not_permitted_, trouble) != trouble) note_trouble(trouble, true);
      if (is_left()) return {};
      note_steadiness();
    }
  }

  void send_waiting() {
    while (!connection_->is_full()) {
      std::optional<NatsMessage> message;
      {
        const std::lock_guard lock(shared_->mutex);
        message = shared_->outgoing.pop();
      }
      if (!message) return;
      const bool is_sent = connection_->publish(*message);
      const std::lock_guard lock(shared_->mutex);
      if (is_sent) {
        ++shared_->state.sent;
        shared_->state.sent_bytes += message->bytes.size();
      } else {
        ++shared_->state.lost;
      }
    }
  }

  void say_goodbye() {
    connection_->linger();
    send_waiting();
    connection_->turn(shared_->event.get(), 0);
  }

  void take_messages() {
    bool has_come = false;
    connection_->take_messages([&](const natsMsg* message) {
      const auto size = static_cast<std::size_t>(std::max(natsMsg_GetDataLength(message), 0));
      NatsMessage taken;
      if (size <= settings().max_message_bytes) {
        taken.subject = natsMsg_GetSubject(message);
        if (const char* const reply = natsMsg_GetReply(message)) taken.reply_to = reply;
        taken.bytes.resize(size);
        if (size > 0) std::memcpy(taken.bytes.data(), natsMsg_GetData(message), size);
      }
      const std::lock_guard lock(shared_->mutex);
      if (size > settings().max_message_bytes || !shared_->incoming.push(std::move(taken))) {
        ++shared_->state.lost;
        return;
      }
      ++shared_->state.received;
      shared_->state.received_bytes += size;
      has_come = true;
    });
    if (!has_come) return;
    const std::lock_guard lock(shared_->arrival_mutex);
    if (shared_->on_arrival && !shared_->is_arrival_over) contain("a message of NATS", shared_->on_arrival);
  }

  bool is_left() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->is_leaving;
  }

  /// Returns true once if leave_server() ended the connection.
  bool was_left() {
    const std::lock_guard lock(shared_->mutex);
    if (!std::exchange(shared_->is_leaving, false)) return false;
    shared_->state.trouble = "gave up " + shared_->state.server + ", because nothing came from it in time";
    failures_ = 0;
    is_steady_ = false;
    return true;
  }

  void end_connection() {
    {
      const std::lock_guard lock(shared_->mutex);
      shared_->connection.reset();
      shared_->state.is_connected = false;
      shared_->state.lost += shared_->outgoing.size();
      shared_->outgoing.clear();
    }
    connection_.reset();
  }

  void note_steadiness() {
    if (is_steady_ || Clock::now() - connected_ < kSteady) return;
    is_steady_ = true;
    failures_ = 0;
    backoff_.reset();
    if (not_permitted_.empty() && std::exchange(is_trouble_logged_, false)) spdlog::info("NATS: connected again");
  }

  void note_trouble(const std::string& trouble, bool is_connected) {
    if (!std::exchange(is_trouble_logged_, true)) {
      spdlog::warn("NATS: {}{}", trouble, is_connected ? "" : "; it is tried again");
    }
    const std::lock_guard lock(shared_->mutex);
    shared_->state.trouble = trouble;
  }

  void wait_before_retry() {
    std::unique_lock lock(shared_->mutex);
    shared_->changed.wait_for(lock, backoff_.next(), [this] { return shared_->is_ending; });
  }

  std::shared_ptr<Shared> shared_;
  platform::Backoff backoff_;
  std::shared_ptr<Connection> connection_;
  Clock::time_point connected_;
  std::string not_permitted_;  ///< by this connection
  std::size_t failures_ = 0;   ///< in a row
  bool is_steady_ = false, is_trouble_logged_ = false;
};

NatsLink::NatsLink(NatsSettings settings, std::vector<std::string> subjects, std::function<void()> on_arrival)
    : shared_(std::make_shared<Shared>(std::move(settings), std::move(subjects), std::move(on_arrival))) {
  std::thread([shared = shared_] {
    contain("the link to NATS", [&] { Worker(shared).run(); });
    release_thread_memory();
    const std::lock_guard lock(shared->mutex);
    shared->is_over = true;
    shared->changed.notify_all();
  }).detach();
}

NatsLink::~NatsLink() {
  {
    const std::lock_guard lock(shared_->arrival_mutex);
    shared_->is_arrival_over = true;
  }
  std::unique_lock lock(shared_->mutex);
  shared_->is_ending = true;
  shared_->changed.notify_all();
  shared_->wake();
  if (shared_->changed.wait_for(lock, kFarewell, [this] { return shared_->is_over; })) return;
  if (shared_->connection) shared_->connection->shut_down();
}

std::optional<std::string> NatsLink::refusal() {
  return std::nullopt;
}

void NatsLink::publish(std::string_view subject, std::span<const std::uint8_t> bytes, const std::string& reply_to) {
  const bool is_valid = bytes.size() <= shared_->settings.max_message_bytes && is_subject(subject) &&
                        (reply_to.empty() || is_subject(reply_to));
  const std::lock_guard lock(shared_->mutex);
  if (!is_valid || !shared_->state.is_connected ||
      !shared_->outgoing.push({std::string(subject), reply_to, {bytes.begin(), bytes.end()}})) {
    ++shared_->state.lost;
    return;
  }
  shared_->wake();
}

const std::string& NatsLink::inbox() const {
  return shared_->inbox;
}

std::vector<NatsMessage> NatsLink::received() {
  const std::lock_guard lock(shared_->mutex);
  return shared_->incoming.take_all();
}

void NatsLink::leave_server() {
  const std::lock_guard lock(shared_->mutex);
  if (!shared_->state.is_connected) return;
  shared_->is_leaving = true;
  shared_->connection->shut_down();
  shared_->wake();
}

NatsLink::State NatsLink::state() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->state;
}

}  // namespace yuragi::daemon::follow
