#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace yuragi::daemon::feeds {

/// A message to an MQTT broker.
struct MqttPost {
  std::string topic = {}, payload = {};
  bool is_retained = false;
  /// It is sent again after each connection. If it is empty, the earlier one is forgotten.
  bool is_state = false;
  friend bool operator==(const MqttPost&, const MqttPost&) = default;
};

/// What waits for the broker: of each topic the newest message, so it is bounded by the number of topics. A message
/// that replaces another takes its place in the order. Thread-safe: no.
class MqttOutbox {
 public:
  void post(MqttPost post);

  /// All states wait once more, in the order in which they first came.
  void post_states_again();

  /// The next message, which waits no longer; nullopt: none waits.
  std::optional<MqttPost> take();
  /// A message that could not be sent waits again, before all others, unless there is a newer one.
  void put_back(const MqttPost& post);

  bool is_empty() const noexcept { return order_.empty(); }
  std::size_t size() const noexcept { return order_.size(); }

 private:
  std::deque<std::string> order_;            ///< topics
  std::map<std::string, MqttPost> waiting_;  ///< by topic
  std::vector<MqttPost> states_;
};

}  // namespace yuragi::daemon::feeds
