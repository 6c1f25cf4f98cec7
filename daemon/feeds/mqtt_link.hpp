#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/feeds/mqtt_outbox.hpp"
#include "daemon/settings/feeds/mqtt.hpp"
#include "drivers/bus/mqtt_client.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::feeds {

/// The connection to a broker, on a thread of its own, which connects again for ever. Nothing here waits for the
/// broker, except finish(). The topic TOPIC/status is "online" while it is connected, otherwise "offline": it is the
/// will, too. What goes wrong is logged once, and once that it is over. Thread-safe: no.
class MqttLink {
 public:
  struct Times {
    Nanoseconds connect = std::chrono::seconds(5);
    Nanoseconds keep_alive = std::chrono::seconds(15);  ///< a broker that hangs is given up after twice this time
    Nanoseconds first_retry = std::chrono::seconds(1), longest_retry = std::chrono::minutes(1);
    Nanoseconds steady = std::chrono::seconds(5);  ///< a connection that lasts so long is a good one
  };

  /// What has become of the messages.
  struct State {
    std::uint64_t messages = 0, bytes = 0;  ///< handed to the broker
    std::optional<MonoTime> last_sent;      ///< by the time of the newest post()
    bool is_connected = false;
    std::string trouble;        ///< why it is not connected, and what to do
    std::uint64_t refused = 0;  ///< received messages that were too many
  };

  /// `topics`: what is subscribed to.
  MqttLink(const settings::feeds::Mqtt& config, std::vector<std::string> topics, const Times& times);
  ~MqttLink();
  MqttLink(const MqttLink&) = delete;
  MqttLink& operator=(const MqttLink&) = delete;

  void post(std::vector<MqttPost> posts, MonoTime now);
  void post_states_again();

  /// What has come in since the last call: a bounded number of messages.
  std::vector<drivers::bus::MqttMessage> received();

  State state() const;

  /// Publishes "offline" and ends the connection; waits for a broker that replies, for a moment at most.
  void finish();

 private:
  struct Shared;
  class Worker;
  std::shared_ptr<Shared> shared_;
};

}  // namespace yuragi::daemon::feeds
