#pragma once

#include <nlohmann/json_fwd.hpp>

#include "engine/wire/wire.hpp"

namespace yuragi::daemon::state {

// The stream's messages as JSON. Keys have their unit at the end, numbers are numbers, and what is not known is null.

/// All that sensor_table() shows, and what else the message holds.
nlohmann::ordered_json sensors_json(const wire::Sensors& sensors);

/// One message to or from a device; its bytes as hexadecimal digits.
nlohmann::ordered_json raw_trace_json(const wire::RawTrace& trace);

/// What people have set by hand.
nlohmann::ordered_json by_hand_json(const wire::ByHand& by_hand);

nlohmann::ordered_json scenes_json(const std::vector<wire::SceneState>& scenes);
nlohmann::ordered_json players_json(const std::vector<wire::PlayerState>& players);

}  // namespace yuragi::daemon::state
