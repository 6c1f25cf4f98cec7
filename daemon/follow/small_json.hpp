#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/base/json_text.hpp"
#include "engine/base/printable_text.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::follow {

/// The largest JSON text of a message, and how deep it may be.
inline constexpr std::size_t kMaxJson_bytes = 128UL * 1024;
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

inline Failure bad_data(const char* clause) {
  return {.message = clause, .kind = FailureKind::kBadData};
}

// What a key of an object holds; nullopt if it is missing or holds something else.

inline std::optional<std::uint64_t> count_at(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_unsigned()) return std::nullopt;
  return found->get<std::uint64_t>();
}

/// From -most to most.
inline std::optional<double> number_at(const nlohmann::json& object, const char* key, double most) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  const auto number = found->get<double>();
  if (!(std::abs(number) <= most)) return std::nullopt;
  return number;
}

/// A text of at most so many bytes, made printable; nullopt if it is none.
inline std::optional<std::string> short_text(const nlohmann::json& json, std::size_t most_bytes) {
  if (!json.is_string() || json.get_ref<const std::string&>().size() > most_bytes) return std::nullopt;
  auto text = json.get<std::string>();
  make_printable(text);
  return text;
}
inline std::optional<std::string> text_at(const nlohmann::json& object, const char* key, std::size_t most_bytes) {
  const auto found = object.find(key);
  return found == object.end() ? std::nullopt : short_text(*found, most_bytes);
}

inline std::vector<std::uint8_t> bytes_of(const nlohmann::ordered_json& json) {
  const std::string text = json_text(json);
  return {text.begin(), text.end()};
}

}  // namespace yuragi::daemon::follow
