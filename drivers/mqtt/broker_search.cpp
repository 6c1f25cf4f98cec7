#include "drivers/mqtt/broker_search.hpp"

#include <algorithm>
#include <chrono>

#include "drivers/mqtt/home_assistant.hpp"

namespace yuragi::drivers::mqtt {

Result<std::vector<sensor::FoundDevice>, Failure> find_announced(const BrokerSearch& search) {
  constexpr std::size_t kMaxBytes = 64U << 20U;
  constexpr Nanoseconds kLongest = std::chrono::seconds(30);
  bus::MqttSubscription subscription = search.broker;
  subscription.topics = {search.prefix + "/+/+/config", search.prefix + "/+/+/+/config"};
  const auto client = bus::make_mqtt_client(subscription);
  if (const auto connected = client->connect(); !connected)
    return Failure{connected.error().message, FailureKind::kUnavailable};

  std::vector<AnnouncedValue> values;
  std::size_t bytes = 0;
  const auto end = std::chrono::steady_clock::now() + kLongest;
  bus::MqttMessage message;
  while (bytes < kMaxBytes && std::chrono::steady_clock::now() < end) {
    const bus::MqttStatus status = client->receive(message, search.pause);
    if (status == bus::MqttStatus::kLost) return Failure{client->trouble(), FailureKind::kUnavailable};
    if (status != bus::MqttStatus::kMessage) break;
    bytes += message.topic.size() + message.payload.size();
    const std::string_view payload(reinterpret_cast<const char*>(message.payload.data()), message.payload.size());
    for (AnnouncedValue& value : announced_in(message.topic, payload)) {
      // A publisher that starts just now announces everything again.
      if (std::ranges::find(values, value) == values.end()) values.push_back(std::move(value));
    }
  }
  return announced_anemometers(values, search.settings);
}

}  // namespace yuragi::drivers::mqtt
