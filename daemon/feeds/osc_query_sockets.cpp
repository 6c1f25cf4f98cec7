#include "daemon/feeds/osc_query_sockets.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <nlohmann/json.hpp>

#include "daemon/feeds/interval.hpp"
#include "daemon/http/upgrade.hpp"
#include "engine/base/contain.hpp"
#include "engine/base/json_text.hpp"

namespace yuragi::daemon::feeds {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;

/// A message and its address's place in the list.
using Message = std::shared_ptr<const std::vector<std::uint8_t>>;
using Addresses = std::shared_ptr<const std::vector<OscAddress>>;

constexpr std::size_t kMaxMessageBytes = 4096;
/// Of one client between two ticks; a client that listens to everything sends a command for each address.
constexpr int kMaxCommands = 64;
constexpr int kSendBufferBytes = 32 << 10;  ///< what waits in it is old
constexpr auto kStuckAfter = std::chrono::seconds(5);
constexpr auto kSilentAfter = std::chrono::seconds(30);

struct Command {
  bool listens = false;  ///< false: it ignores
  std::string path;
};

/// nullopt: it is a command that this server does not have. Throws nlohmann::json::exception if it is none.
std::optional<Command> command_in(const std::string& text) {
  const auto json = nlohmann::json::parse(text);
  const auto& name = json.at("COMMAND").get_ref<const std::string&>();
  if (name != "LISTEN" && name != "IGNORE") return std::nullopt;
  return Command{.listens = name == "LISTEN", .path = json.at("DATA").get<std::string>()};
}

}  // namespace

/// What all clients share.
struct OscQuerySockets::Shared {
  Addresses addresses = std::make_shared<const std::vector<OscAddress>>();
  std::vector<std::shared_ptr<Client>> clients;
  Interval tenths{kOscTenth_s};
  std::uint64_t messages = 0, bytes = 0;
  std::optional<MonoTime> last_sent;
  MonoTime now{};  ///< of the last tick
};

/// One client. Kept alive by what it waits for.
class OscQuerySockets::Client : public std::enable_shared_from_this<Client> {
 public:
  Client(http::Upgrade& upgrade, std::shared_ptr<Shared> shared)
      : stream_(std::move(upgrade.bytes)),
        request_(std::move(upgrade.request)),
        peer_(std::move(upgrade.client)),
        shared_(std::move(shared)) {
    error_code ignored;
    stream_.next_layer().socket().set_option(asio::ip::tcp::no_delay(true), ignored);
    stream_.next_layer().socket().set_option(asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
    stream_.set_option(websocket::stream_base::timeout{
        .handshake_timeout = kStuckAfter, .idle_timeout = kSilentAfter, .keep_alive_pings = true});
    stream_.read_message_max(kMaxMessageBytes);
  }

  const stream::Peer& peer() const { return peer_; }
  bool has_ended() const { return has_ended_; }

  void accept() {
    stream_.async_accept(request_, [self = shared_from_this()](const error_code& error) {
      self->go_on(error, [&] {
        self->is_open_ = true;
        self->read();
      });
    });
  }

  /// Of the addresses that it listens to, those that are still there.
  void change(const Addresses& before, const Addresses& after) {
    std::map<std::string, Message> kept;
    for (const auto& [index, message] : listened_) kept.emplace((*before)[index].path, message);
    listened_.clear();
    for (std::size_t i = 0; i < after->size(); ++i) {
      if (const auto found = kept.find((*after)[i].path); found != kept.end()) listened_.emplace(i, found->second);
    }
    is_changed_ = true;
  }

  bool listens_to(std::size_t index) const { return listened_.contains(index); }

  /// Sends what differs from what it was sent last. `newest`: of each address; null: not now.
  void send(const std::vector<Message>& newest) {
    if (!is_open_ || has_ended_) return;
    if (!is_reading_) read();
    commands_ = 0;
    if (!queue_.empty()) {
      if (shared_->now - begun_ >= kStuckAfter) end();
      return;
    }
    if (std::exchange(is_changed_, false)) queue_.push_back({text_of_change(), false});
    for (auto& [index, sent] : listened_) {
      const Message& message = newest[index];
      if (!message || (sent && *sent == *message)) continue;
      sent = message;
      queue_.push_back({message, true});
    }
    write();
  }

  void end() {
    has_ended_ = true;
    error_code ignored;
    stream_.next_layer().socket().close(ignored);
  }

 private:
  struct Waiting {
    Message message;
    bool is_binary = true;
  };

  /// Does what an event is about. An exception ends this connection, and no other.
  template <class Work>
  void go_on(const error_code& error, Work&& work) {
    if (has_ended_) return;
    if (error || !contain("an OSCQuery client", std::forward<Work>(work))) end();
  }

  static Message text_of_change() {
    const std::string text = json_text(nlohmann::json{{"COMMAND", "PATH_CHANGED"}, {"DATA", "/"}});
    return std::make_shared<const std::vector<std::uint8_t>>(text.begin(), text.end());
  }

  void read() {
    is_reading_ = true;
    stream_.async_read(message_, [self = shared_from_this()](const error_code& error, std::size_t) {
      self->is_reading_ = false;
      self->go_on(error, [&] {
        self->take();
        self->message_.consume(self->message_.size());
        if (++self->commands_ < kMaxCommands && !self->has_ended_) self->read();  // otherwise at the next tick
      });
    });
  }

  void take() {
    if (stream_.got_binary()) return;
    try {
      const auto command = command_in(beast::buffers_to_string(message_.data()));
      if (!command) return;
      const auto found = std::ranges::find(*shared_->addresses, command->path, &OscAddress::path);
      if (found == shared_->addresses->end()) return;
      const auto index = static_cast<std::size_t>(found - shared_->addresses->begin());
      command->listens ? void(listened_.try_emplace(index)) : void(listened_.erase(index));
    } catch (const nlohmann::json::exception&) {
      end();
    }
  }

  void write() {
    if (queue_.empty() || has_ended_) return;
    begun_ = shared_->now;
    stream_.binary(queue_.front().is_binary);
    stream_.async_write(asio::buffer(*queue_.front().message),
                        [self = shared_from_this()](const error_code& error, std::size_t size) {
                          self->go_on(error, [&] {
                            ++self->shared_->messages;
                            self->shared_->bytes += size;
                            self->shared_->last_sent = self->shared_->now;
                            self->queue_.pop_front();
                            self->write();
                          });
                        });
  }

  websocket::stream<http::ByteStream, false> stream_;
  beast::http::request<beast::http::string_body> request_;
  stream::Peer peer_;
  std::shared_ptr<Shared> shared_;
  beast::flat_buffer message_;
  std::map<std::size_t, Message> listened_;  // by the address's place in the list, with what was sent last
  std::deque<Waiting> queue_;                // the first one is being written
  MonoTime begun_{};                         // when its write began
  int commands_ = 0;                         // since the last tick
  bool is_open_ = false, is_reading_ = false, is_changed_ = false, has_ended_ = false;
};

OscQuerySockets::OscQuerySockets() : shared_(std::make_shared<Shared>()) {}
OscQuerySockets::~OscQuerySockets() {
  for (const auto& client : std::exchange(shared_->clients, {})) client->end();
}

std::optional<std::string> OscQuerySockets::refusal(const stream::Peer& client) const {
  std::vector<stream::Peer> present;
  for (const auto& other : shared_->clients) {
    if (!other->has_ended()) present.push_back(other->peer());
  }
  return stream::admission_refusal({}, present, client);
}

void OscQuerySockets::open(http::Upgrade& upgrade) {
  shared_->clients.push_back(std::make_shared<Client>(upgrade, shared_));
  shared_->clients.back()->accept();
}

void OscQuerySockets::set_addresses(std::shared_ptr<const std::vector<OscAddress>> addresses) {
  const Addresses before = std::exchange(shared_->addresses, std::move(addresses));
  for (const auto& client : shared_->clients) client->change(before, shared_->addresses);
}

void OscQuerySockets::send(const values::Moment& moment, values::Wind wind) {
  shared_->now = moment.mono;
  std::erase_if(shared_->clients, [](const auto& client) { return client->has_ended(); });
  const bool with_tenths = shared_->tenths.is_due(moment.time_s);
  std::vector<Message> newest(shared_->addresses->size());
  for (std::size_t i = 0; i < newest.size(); ++i) {
    const OscAddress& address = (*shared_->addresses)[i];
    const auto is_listened_to = [i](const auto& client) { return client->listens_to(i); };
    if (address.pace == OscPace::kTenTimesASecond && !with_tenths) continue;
    if (std::ranges::none_of(shared_->clients, is_listened_to)) continue;
    if (auto message = address.message(moment, wind))
      newest[i] = std::make_shared<const std::vector<std::uint8_t>>(std::move(*message));
  }
  for (const auto& client : shared_->clients) {
    if (!contain("an OSCQuery client", [&] { client->send(newest); })) client->end();
  }
}

std::size_t OscQuerySockets::clients() const noexcept {
  return shared_->clients.size();
}
std::uint64_t OscQuerySockets::messages() const noexcept {
  return shared_->messages;
}
std::uint64_t OscQuerySockets::bytes() const noexcept {
  return shared_->bytes;
}
std::optional<MonoTime> OscQuerySockets::last_sent() const noexcept {
  return shared_->last_sent;
}

}  // namespace yuragi::daemon::feeds
