#pragma once

#include <memory>

#include "daemon/feeds/feed.hpp"
#include "daemon/feeds/mqtt_link.hpp"
#include "daemon/feeds/surroundings.hpp"
#include "daemon/settings/feeds/mqtt.hpp"

namespace yuragi::daemon::feeds {

/// Publishes the wind on a broker ([mqtt]). Names in topics: what is not A-Z a-z 0-9 _ - is _.
///
///   TOPIC/status        online, offline; retained, and the will
///   TOPIC/wind          JSON each `every` seconds (mqtt_wind_json)
///   TOPIC/fast          JSON at `fast` Hz (mqtt_fast_json)
///   TOPIC/sensor/NAME   JSON each `every` seconds, and when its state changes
///   TOPIC/alert/NAME    ON, OFF; retained
///   TOPIC/problem       ON, OFF: something needs attention; retained
///   TOPIC/scene/NAME    ON, OFF: shown, hidden; when it changes
///   TOPIC/scene/NAME/set  with `commands`: takes show, hide, ON, OFF
///   PREFIX/device/ID/config  Home Assistant's discovery; retained
///
/// States are sent again after each connection, and when Home Assistant has started.
std::unique_ptr<Feed> make_mqtt_feed(const settings::feeds::Mqtt& config, const Surroundings& around,
                                     const MqttLink::Times& times = {});

}  // namespace yuragi::daemon::feeds
