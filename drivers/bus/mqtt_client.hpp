#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::bus {

struct MqttMessage {
  std::string topic;
  std::vector<std::uint8_t> payload;
  bool is_retained = false;  ///< received: kept by the broker for later subscribers, its age is unknown; sent: keep it
  bool is_too_long = false;  ///< longer than any message about the wind; `payload` is empty
};

/// A broker, the credentials for it, and the topics to subscribe to.
struct MqttSubscription {
  std::string host;  ///< a name, an IPv4 or an IPv6 address
  std::uint16_t port = 1883;
  std::string user;  ///< empty: none
  Secret password;
  bool uses_tls = false;
  std::string ca_file;              ///< certificates that the broker is checked with; empty: the system's
  std::vector<std::string> topics;  ///< + matches one level, # all that follow
  std::optional<MqttMessage> will;  ///< the broker sends it if this client vanishes
  Nanoseconds keep_alive = std::chrono::seconds(15);      ///< a broker that is silent for this time is pinged; >= 5 s
  Nanoseconds connect_timeout = std::chrono::seconds(5);  ///< until all subscriptions are accepted
};

enum class MqttStatus : std::uint8_t {
  kMessage,
  kSilence,      ///< none until the time-out, or wake() was called
  kInterrupted,  ///< interrupt() was called
  kLost,         ///< the connection is lost; trouble() is the reason
};

enum class MqttSending : std::uint8_t {
  kSent,     ///< it is on its way, at most once (quality of service 0)
  kBusy,     ///< an earlier one is not yet written: offer it again after receive()
  kRefused,  ///< it can never be sent, or the connection is lost, which receive() reports
};

/// A connection to an MQTT broker, which can be closed and opened again for as long as this lives. A test may put
/// another in its place.
///
/// Memory: no payload above 64 KiB is kept. But the library takes each message whole, and twice for a moment: a broker
/// can make it use up to 512 MiB (twice the longest message of the protocol), which it gives back at once.
///
/// Thread-safe: interrupt() and wake(); everything else belongs to one thread.
class MqttClient {
 public:
  virtual ~MqttClient() = default;

  /// Connects and subscribes. The failure's text: why, and what to do. Blocks for the connect time-out at most, or
  /// twice that if a host name must be looked up.
  virtual Result<void, Failure> connect() = 0;
  virtual void disconnect() noexcept = 0;

  /// The next message, waiting for at most `timeout`.
  virtual MqttStatus receive(MqttMessage& message, Nanoseconds timeout) = 0;

  /// Publishes a message. Does not wait: while the broker takes nothing, at most one message is kept.
  virtual MqttSending publish(const MqttMessage& message) = 0;

  /// Ends the connection so that the broker does not send the will, if it still replies.
  virtual void leave() noexcept = 0;

  /// Why the connection was lost, and what to do.
  virtual std::string trouble() const = 0;

  /// Ends a receive() that waits, or the next one.
  virtual void wake() noexcept = 0;

  /// Ends a connect() or receive() that waits and makes all later ones end at once.
  virtual void interrupt() noexcept = 0;
};

/// The real one, by libmosquitto. Throws std::runtime_error if there is no memory or descriptor left for it.
std::unique_ptr<MqttClient> make_mqtt_client(const MqttSubscription& subscription);

/// Returns true for a valid topic filter.
bool is_mqtt_filter(const std::string& topic);

/// Does `topic` match `filter`?
bool mqtt_topic_matches(const std::string& topic, const std::string& filter);

}  // namespace yuragi::drivers::bus
