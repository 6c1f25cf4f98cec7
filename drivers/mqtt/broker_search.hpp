#pragma once

#include <string>
#include <vector>

#include "drivers/bus/mqtt_client.hpp"
#include "drivers/sensor/found_device.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::mqtt {

/// A broker that is searched, and the lines of a sensor's table to reach it.
struct BrokerSearch {
  bus::MqttSubscription broker;                 ///< without the topics
  std::string settings;                         ///< the same as lines of TOML
  std::string prefix = "homeassistant";         ///< of the announcements' topics
  Nanoseconds pause = std::chrono::seconds(1);  ///< the search ends after this silence of the broker
};

/// The anemometers that publishers announce on the broker by Home Assistant's discovery (home_assistant.hpp).
/// Announcements are retained: the broker sends all that it has at once. At most 64 MiB of them, or 30 s, are read. The
/// failure's text is why the broker cannot be asked, and what to do.
Result<std::vector<sensor::FoundDevice>, Failure> find_announced(const BrokerSearch& search);

}  // namespace yuragi::drivers::mqtt
