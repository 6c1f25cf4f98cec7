#pragma once

#include <optional>

#include <nlohmann/json.hpp>

namespace yuragi::daemon::state {

/// A value as JSON, null if there is none.
template <class Value>
nlohmann::ordered_json json_or_null(const std::optional<Value>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace yuragi::daemon::state
