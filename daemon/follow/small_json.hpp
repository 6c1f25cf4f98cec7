#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/base/json_text.hpp"

namespace yuragi::daemon::follow {

/// The largest JSON text of a message, and how deep it may be.
inline constexpr std::size_t kMaxJson_bytes = 128 * 1024;
inline constexpr int kDeepestJson = 4;

/// The JSON of a message from another machine; null if it is none, too long or too deep.
inline nlohmann::json small_json(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > kMaxJson_bytes) return {};
  const auto is_shallow = [](int depth, nlohmann::json::parse_event_t /*event*/, nlohmann::json& /*parsed*/) {
    return depth <= kDeepestJson;
  };
  nlohmann::json json = nlohmann::json::parse(bytes.begin(), bytes.end(), is_shallow, false);
  return json.is_discarded() ? nlohmann::json() : json;
}

inline std::vector<std::uint8_t> bytes_of(const nlohmann::json& json) {
  const std::string text = json_text(json);
  return {text.begin(), text.end()};
}

}  // namespace yuragi::daemon::follow
