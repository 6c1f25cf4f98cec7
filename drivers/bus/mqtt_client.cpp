// libmosquitto 2.0.11, driven by this thread: its own loops can neither be woken nor given a time-out for a connection
// (mosquitto issues 949 and 3051: minutes, where a firewall drops what is sent). Nor can its look-up of a name be
// ended, so the name is looked up before. It takes each packet whole, and nothing limits that for MQTT 3.1.1: one of
// 256 MiB, the longest of the protocol, takes twice as much for the moment until on_message() has dropped it.
#include "drivers/bus/mqtt_client.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <deque>
#include <span>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <malloc.h>
#include <mosquitto.h>

#include "drivers/bus/callback_exception.hpp"
#include "drivers/bus/host_lookup.hpp"
#include "drivers/bus/interruption.hpp"
#include "engine/base/close_on_exec.hpp"

namespace yuragi::drivers::bus {
namespace {

using MqttClock = std::chrono::steady_clock;

constexpr int kMaxPayload = 65'536;
constexpr int kAtMostOnce = 0;
/// The library must check the clock at least this often, to keep the connection alive.
constexpr Nanoseconds kHousekeeping = std::chrono::milliseconds(500);
constexpr const char* kTrustedBySystem = "/etc/ssl/certs";

/// By itself the C library keeps the room of long messages for later: the longest block that it gives back at once
/// grows with each one that is freed, up to 32 MiB (mallopt(3), M_MMAP_THRESHOLD), and of messages of 12 MiB it kept
/// 24 to 36 MiB. Where the length is set it does not grow. This holds for the whole process.
void give_back_long_blocks_at_once() {
  constexpr int kLongBlock = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, kLongBlock);  // NOLINT(concurrency-mt-unsafe): others see the length of before or of now
}

/// The library is set up once, by the first that needs it, and never taken down: other threads may be using it.
void set_up_library() {
  static const int result = [] {
    give_back_long_blocks_at_once();
    return mosquitto_lib_init();
  }();
  if (result != MOSQ_ERR_SUCCESS) throw std::runtime_error("libmosquitto cannot start");
}

struct FreeMosquitto {
  void operator()(mosquitto* client) const noexcept { mosquitto_destroy(client); }
};

std::string describe(const MqttSubscription& subscription) {
  return fmt::format("MQTT broker {}:{}", subscription.host, subscription.port);
}

class MosquittoClient final : public MqttClient {
 public:
  explicit MosquittoClient(const MqttSubscription& subscription)
      : wanted_(subscription), lookup_(subscription.host, subscription.port) {
    set_up_library();
  }
  ~MosquittoClient() override { MosquittoClient::disconnect(); }
  MosquittoClient(const MosquittoClient&) = delete;
  MosquittoClient& operator=(const MosquittoClient&) = delete;

  Result<void, Failure> connect() override {
    disconnect();
    const auto endpoints = lookup_.find(wanted_.connect_timeout);
    if (!endpoints) return Failure{describe(wanted_) + ": " + endpoints.error().message};

    // The addresses of a name are tried in turn, until one replies. With TLS the name itself must be given,
    // because the broker's certificate is for that.
    const std::string address = (*endpoints)[turn_ % endpoints->size()].address().to_string();
    auto connected = connect_to(wanted_.uses_tls ? wanted_.host : address);
    if (!connected) {
      disconnect();
      ++turn_;
    }
    return connected;
  }

  void disconnect() noexcept override {
    client_.reset();
    messages_.clear();
    is_accepted_ = false;
    agreed_topics_ = 0;
    refusal_.clear();
  }

  MqttStatus receive(MqttMessage& message, Nanoseconds timeout) override {
    if (!client_) return MqttStatus::kLost;
    const auto deadline = MqttClock::now() + timeout;
    while (messages_.empty()) {
      const Nanoseconds remaining = deadline - MqttClock::now();
      if (remaining <= Nanoseconds::zero()) return MqttStatus::kSilence;
      if (const int error = turn(std::min(remaining, kHousekeeping)); error != MOSQ_ERR_SUCCESS) {
        trouble_ = explain(error);
        return MqttStatus::kLost;
      }
      if (is_interrupted_) return MqttStatus::kInterrupted;
      if (std::exchange(was_woken_, false)) return MqttStatus::kSilence;
    }
    message = std::move(messages_.front());
    messages_.pop_front();
    return MqttStatus::kMessage;
  }

  MqttSending publish(const MqttMessage& message) override {
    if (!client_) return MqttSending::kRefused;
    if (mosquitto_want_write(client_.get())) return MqttSending::kBusy;
    const int error =
        mosquitto_publish(client_.get(), nullptr, message.topic.c_str(), static_cast<int>(message.payload.size()),
                          message.payload.data(), kAtMostOnce, message.is_retained);
    return error == MOSQ_ERR_SUCCESS ? MqttSending::kSent : MqttSending::kRefused;
  }

  void leave() noexcept override {
    if (client_) mosquitto_disconnect(client_.get());
    disconnect();
  }

  std::string trouble() const override { return trouble_; }
  void wake() noexcept override { wakes_.set(); }
  void interrupt() noexcept override {
    is_interrupted_ = true;
    wakes_.set();
    lookup_.interrupt();
  }

 private:
  /// Connects, and waits until the broker has accepted the connection and each topic.
  Result<void, Failure> connect_to(const std::string& host) {
    if (const int error = begin_to_connect(host); error != MOSQ_ERR_SUCCESS) return Failure{explain(error)};
    const auto deadline = MqttClock::now() + wanted_.connect_timeout;
    while (!is_accepted_ || agreed_topics_ < wanted_.topics.size()) {
      const Nanoseconds remaining = deadline - MqttClock::now();
      if (remaining <= Nanoseconds::zero()) {
        return Failure{describe(wanted_) + " does not reply: check its address, the network, and that it is running"};
      }
      const int error = turn(std::min(remaining, kHousekeeping));
      if (is_interrupted_) return Failure{"interrupted"};
      if (!refusal_.empty()) return Failure{refusal_};
      if (error != MOSQ_ERR_SUCCESS) return Failure{explain(error)};
    }
    return {};
  }

  int begin_to_connect(const std::string& host) {
    client_.reset(mosquitto_new(nullptr, true, this));  // a random client id: this program can run twice
    if (!client_) return errno == ENOMEM ? MOSQ_ERR_NOMEM : MOSQ_ERR_INVAL;
    mosquitto_connect_callback_set(client_.get(), &on_connect);
    mosquitto_subscribe_callback_set(client_.get(), &on_subscribe);
    mosquitto_message_callback_set(client_.get(), &on_message);
    if (!wanted_.user.empty()) {
      mosquitto_username_pw_set(client_.get(), wanted_.user.c_str(),
                                wanted_.password.is_empty() ? nullptr : wanted_.password.reveal().c_str());
    }
    mosquitto_int_option(client_.get(), MOSQ_OPT_TCP_NODELAY, 1);
    if (wanted_.will) {
      const MqttMessage& will = *wanted_.will;
      const int error = mosquitto_will_set(client_.get(), will.topic.c_str(), static_cast<int>(will.payload.size()),
                                           will.payload.data(), kAtMostOnce, will.is_retained);
      if (error != MOSQ_ERR_SUCCESS) return error;
    }
    if (wanted_.uses_tls) {
      const char* const file = wanted_.ca_file.empty() ? nullptr : wanted_.ca_file.c_str();
      const int error = mosquitto_tls_set(client_.get(), file, file == nullptr ? kTrustedBySystem : nullptr, nullptr,
                                          nullptr, nullptr);
      if (error != MOSQ_ERR_SUCCESS) return error;
    }
    const auto keep_alive = std::chrono::duration_cast<std::chrono::seconds>(wanted_.keep_alive);
    const int error =
        mosquitto_connect_async(client_.get(), host.c_str(), wanted_.port, static_cast<int>(keep_alive.count()));
    close_on_exec(mosquitto_socket(client_.get()));
    return error;
  }

  /// Waits for the socket for at most `timeout`, and lets the library read and write.
  int turn(Nanoseconds timeout) {
    const int socket = mosquitto_socket(client_.get());
    if (socket < 0) return MOSQ_ERR_NO_CONN;
    if (is_interrupted_) return MOSQ_ERR_SUCCESS;
    const bool wants_to_write = mosquitto_want_write(client_.get());
    const WaitFor what = wants_to_write ? WaitFor::kWritable : WaitFor::kReadable;
    WaitEnd end = wakes_.wait(socket, what, timeout);
    if (end == WaitEnd::kInterrupted) {
      if (is_interrupted_) return MOSQ_ERR_SUCCESS;
      // Somebody who wakes it often delays neither what comes in nor the library's watch over a broker that hangs.
      wakes_.clear();
      was_woken_ = true;
      end = wakes_.wait(socket, what, Nanoseconds::zero());
    }
    int error = MOSQ_ERR_SUCCESS;
    if (end == WaitEnd::kReady && wants_to_write) error = mosquitto_loop_write(client_.get(), 1);
    if (end == WaitEnd::kReady && error == MOSQ_ERR_SUCCESS) error = mosquitto_loop_read(client_.get(), 1);
    if (error == MOSQ_ERR_SUCCESS) error = mosquitto_loop_misc(client_.get());
    thrown_.rethrow();
    return error;
  }

  static MosquittoClient& self_of(void* self) { return *static_cast<MosquittoClient*>(self); }

  static void on_connect(mosquitto* /*client*/, void* self, int reply) noexcept {
    self_of(self).thrown_.keep_from([&] { self_of(self).take_connection(reply); });
  }
  static void on_subscribe(mosquitto* /*client*/, void* self, int /*id*/, int count, const int* granted) noexcept {
    self_of(self).thrown_.keep_from(
        [&] { self_of(self).take_subscription(std::span(granted, static_cast<std::size_t>(std::max(count, 0)))); });
  }
  static void on_message(mosquitto* /*client*/, void* self, const mosquitto_message* message) noexcept {
    self_of(self).thrown_.keep_from([&] { self_of(self).take_message(*message); });
  }

  void take_connection(int reply) {
    if (reply != 0) {
      refusal_ = fmt::format("{} refuses the connection ({}): check `user` and `password`", describe(wanted_),
                             mosquitto_connack_string(reply));
      return;
    }
    is_accepted_ = true;
    for (const std::string& topic : wanted_.topics) {
      mosquitto_subscribe(client_.get(), nullptr, topic.c_str(), kAtMostOnce);
    }
  }

  void take_subscription(std::span<const int> granted) {
    constexpr int kRefused = 0x80;
    if (std::ranges::any_of(granted, [](int quality) { return quality >= kRefused; })) {
      refusal_ = fmt::format("{} does not allow this user to read the topic: allow it in the broker's access list",
                             describe(wanted_));
    }
    ++agreed_topics_;
  }

  void take_message(const mosquitto_message& message) {
    MqttMessage taken{.topic = message.topic, .payload = {}, .is_retained = message.retain};
    taken.is_too_long = message.payloadlen > kMaxPayload;
    const auto* const bytes = static_cast<const std::uint8_t*>(message.payload);
    if (!taken.is_too_long && message.payloadlen > 0) taken.payload.assign(bytes, bytes + message.payloadlen);
    messages_.push_back(std::move(taken));
  }

  std::string explain(int error) const {
    const std::string broker = describe(wanted_);
    switch (error) {
      case MOSQ_ERR_ERRNO:
        return fmt::format("cannot reach {} ({}): check its address, the network, and that it is running", broker,
                           std::generic_category().message(errno));
      case MOSQ_ERR_CONN_LOST:
        return fmt::format("{} has closed the connection: check that it is running, and that the port is right",
                           broker);
      case MOSQ_ERR_EAI:
        return fmt::format("cannot find {}: check its name, and this machine's name server", broker);
      case MOSQ_ERR_TLS:
        return fmt::format(
            "the TLS connection to {} failed: check `ca_file` ({}), the broker's certificate, and that this port uses "
            "TLS",
            broker, wanted_.ca_file.empty() ? kTrustedBySystem : wanted_.ca_file);
      case MOSQ_ERR_INVAL:
        return fmt::format("cannot use the settings for {}: check that `ca_file` exists and is readable", broker);
      default:
        return fmt::format("lost the connection to {} ({}): check the network, and that it is running", broker,
                           mosquitto_strerror(error));
    }
  }

  MqttSubscription wanted_;
  HostLookup lookup_;
  std::size_t turn_ = 0;    ///< which of the broker's addresses is tried
  Interruption wakes_;      ///< ends a wait once
  bool was_woken_ = false;  ///< and receive() has not returned since
  std::atomic<bool> is_interrupted_ = false;
  std::unique_ptr<mosquitto, FreeMosquitto> client_;
  std::deque<MqttMessage> messages_;
  CallbackException thrown_;
  bool is_accepted_ = false;
  std::size_t agreed_topics_ = 0;
  std::string refusal_;  ///< by the broker
  std::string trouble_;
};

}  // namespace

std::unique_ptr<MqttClient> make_mqtt_client(const MqttSubscription& subscription) {
  return std::make_unique<MosquittoClient>(subscription);
}

bool is_mqtt_filter(const std::string& topic) {
  return mosquitto_sub_topic_check(topic.c_str()) == MOSQ_ERR_SUCCESS;
}

bool mqtt_topic_matches(const std::string& topic, const std::string& filter) {
  bool matches = false;
  return mosquitto_topic_matches_sub(filter.c_str(), topic.c_str(), &matches) == MOSQ_ERR_SUCCESS && matches;
}

}  // namespace yuragi::drivers::bus
