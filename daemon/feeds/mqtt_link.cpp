#include "daemon/feeds/mqtt_link.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <random>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "engine/base/address.hpp"
#include "engine/base/contain.hpp"
#include "engine/platform/backoff.hpp"
#include "engine/platform/secret_file.hpp"

namespace yuragi::daemon::feeds {
namespace {

using drivers::bus::MqttClient;
using drivers::bus::MqttMessage;
using drivers::bus::MqttSending;
using drivers::bus::MqttStatus;

/// A post() ends the wait.
constexpr Nanoseconds kWait = std::chrono::seconds(1);
constexpr auto kLongestFarewell = std::chrono::milliseconds(250);
constexpr std::size_t kMaxReceived = 32;

std::vector<std::uint8_t> bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

MqttMessage message_of(const MqttPost& post) {
  return {.topic = post.topic, .payload = bytes_of(post.payload), .is_retained = post.is_retained};
}

}  // namespace

struct MqttLink::Shared {
  mutable std::mutex mutex;
  std::condition_variable changed;
  MqttOutbox outbox;
  std::vector<MqttMessage> received;
  State state;
  MonoTime now{};
  std::shared_ptr<MqttClient> client;  ///< null: not yet made
  bool is_ending = false, is_over = false;
};

/// Runs on the thread; what it shares with the owner is Shared alone, so that it can outlive it.
class MqttLink::Worker {
 public:
  Worker(std::shared_ptr<Shared> shared, const settings::feeds::Mqtt& config, std::vector<std::string> topics,
         const Times& times)
      : shared_(std::move(shared)),
        config_(config),
        target_(to_string(Address{config.host, config.used_port()})),
        status_{.topic = config.topic + "/status", .payload = "online", .is_retained = true},
        times_(times),
        backoff_(times.first_retry, times.longest_retry, std::random_device{}()) {
    subscription_ = {.host = config.host,
                     .port = config.used_port(),
                     .user = config.user,
                     .password = config.password,
                     .uses_tls = config.uses_tls,
                     .ca_file = config.ca_file,
                     .topics = std::move(topics),
                     .will = offline(),
                     .keep_alive = times.keep_alive,
                     .connect_timeout = times.connect};
  }

  void run() {
    while (!is_ending()) {
      Result<void, Failure> result = Failure{""};
      contain("the connection to the MQTT broker", [&] { result = connect_and_work(); });
      if (client_) client_->disconnect();
      if (is_ending()) return;
      note_trouble(result ? std::string() : result.error().message);
      wait_before_retry();
    }
  }

 private:
  MqttMessage offline() const { return {.topic = status_.topic, .payload = bytes_of("offline"), .is_retained = true}; }

  bool is_ending() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->is_ending;
  }

  Result<void, Failure> connect_and_work() {
    if (auto made = make_client(); !made) return made;
    if (auto connected = client_->connect(); !connected) return connected;
    connected_ = std::chrono::steady_clock::now();
    is_steady_ = false;
    {
      const std::lock_guard lock(shared_->mutex);
      shared_->state.is_connected = true;
      shared_->state.trouble.clear();
      shared_->outbox.post(status_);
      shared_->outbox.post_states_again();
    }
    while (true) {
      send_waiting();
      MqttMessage message;
      const MqttStatus status = client_->receive(message, kWait);
      if (is_ending()) return say_goodbye();
      if (status == MqttStatus::kLost) return Failure{client_->trouble()};
      if (status == MqttStatus::kMessage) take(std::move(message));
      note_steadiness();
    }
  }

  /// A password that was changed in its file is used from the next connection on.
  Result<void, Failure> make_client() {
    if (!config_.password_file.empty()) {
      const auto password = platform::secret_in_file(config_.password_file);
      if (!password) return Failure{"[mqtt] password_file: " + password.error().message};
      if (*password != subscription_.password) client_.reset();
      subscription_.password = *password;
    }
    if (client_) return {};
    client_ = drivers::bus::make_mqtt_client(subscription_);
    const std::lock_guard lock(shared_->mutex);
    shared_->client = client_;
    if (shared_->is_ending) client_->interrupt();
    return {};
  }

  void send_waiting() {
    while (true) {
      std::optional<MqttPost> post;
      {
        const std::lock_guard lock(shared_->mutex);
        post = shared_->outbox.take();
      }
      if (!post) return;
      const MqttSending sending = client_->publish(message_of(*post));
      const std::lock_guard lock(shared_->mutex);
      if (sending == MqttSending::kBusy) return shared_->outbox.put_back(*post);
      if (sending == MqttSending::kRefused) return;
      ++shared_->state.messages;
      shared_->state.bytes += post->topic.size() + post->payload.size();
      shared_->state.last_sent = shared_->now;
    }
  }

  void take(MqttMessage message) {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->received.size() < kMaxReceived) {
      shared_->received.push_back(std::move(message));
    } else {
      ++shared_->state.refused;
    }
  }

  Result<void, Failure> say_goodbye() {
    // If an earlier message is not yet written, the broker sends the will.
    if (client_->publish(offline()) == MqttSending::kSent) client_->leave();
    return {};
  }

  void note_steadiness() {
    if (is_steady_ || std::chrono::steady_clock::now() - connected_ < times_.steady) return;
    is_steady_ = true;
    backoff_.reset();
    if (std::exchange(is_trouble_logged_, false)) spdlog::info("feed mqtt: publishes to {} again", target_);
  }

  void note_trouble(const std::string& trouble) {
    const std::string why = trouble.empty() ? "an error in this program" : trouble;
    if (!std::exchange(is_trouble_logged_, true)) spdlog::warn("feed mqtt: {}; it is tried again", why);
    const std::lock_guard lock(shared_->mutex);
    shared_->state.is_connected = false;
    shared_->state.trouble = why;
  }

  void wait_before_retry() {
    std::unique_lock lock(shared_->mutex);
    shared_->changed.wait_for(lock, backoff_.next(), [this] { return shared_->is_ending; });
  }

  std::shared_ptr<Shared> shared_;
  settings::feeds::Mqtt config_;
  drivers::bus::MqttSubscription subscription_;
  std::string target_;
  MqttPost status_;
  Times times_;
  platform::Backoff backoff_;
  std::shared_ptr<MqttClient> client_;
  std::chrono::steady_clock::time_point connected_;
  bool is_steady_ = false, is_trouble_logged_ = false;
};

MqttLink::MqttLink(const settings::feeds::Mqtt& config, std::vector<std::string> topics, const Times& times)
    : shared_(std::make_shared<Shared>()) {
  // A look-up of the C library's can hang for minutes: the thread is left to itself then.
  std::thread([shared = shared_, config, topics = std::move(topics), times]() mutable {
    contain("the feed to the MQTT broker", [&] { Worker(shared, config, std::move(topics), times).run(); });
    const std::lock_guard lock(shared->mutex);
    shared->client.reset();
    shared->is_over = true;
    shared->changed.notify_all();
  }).detach();
}

MqttLink::~MqttLink() {
  finish();
}

void MqttLink::post(std::vector<MqttPost> posts, MonoTime now) {
  if (posts.empty()) return;
  const std::lock_guard lock(shared_->mutex);
  shared_->now = now;
  for (MqttPost& post : posts) shared_->outbox.post(std::move(post));
  if (shared_->client) shared_->client->wake();
}

void MqttLink::post_states_again() {
  const std::lock_guard lock(shared_->mutex);
  shared_->outbox.post_states_again();
  if (shared_->client) shared_->client->wake();
}

std::vector<MqttMessage> MqttLink::received() {
  const std::lock_guard lock(shared_->mutex);
  return std::exchange(shared_->received, {});
}

MqttLink::State MqttLink::state() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->state;
}

void MqttLink::finish() {
  std::unique_lock lock(shared_->mutex);
  if (std::exchange(shared_->is_ending, true)) return;
  if (shared_->client) {
    if (shared_->state.is_connected) {
      shared_->client->wake();
    } else {
      shared_->client->interrupt();
    }
  }
  shared_->changed.notify_all();
  shared_->changed.wait_for(lock, kLongestFarewell, [this] { return shared_->is_over; });
}

}  // namespace yuragi::daemon::feeds
