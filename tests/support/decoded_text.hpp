#pragma once

#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/text_fields.hpp"
#include "engine/wind/wind_reading.hpp"
#include "tests/support/places.hpp"

namespace yuragi {

/// A test of a decoder that expects a refusal fails if nothing is wrong, or something else.
inline testing::AssertionResult is_refused(
    const Result<drivers::decode::DecodedWind, drivers::decode::Refusal>& decoded, drivers::decode::Refusal why) {
  if (!decoded && decoded.error() == why) return testing::AssertionSuccess();
  return testing::AssertionFailure() << (decoded ? "accepted" : name_of(decoded.error())) << ", not " << name_of(why);
}

/// Speed and direction as expected, to within what is printed; an empty expectation must be empty.
inline testing::AssertionResult reads(const Result<drivers::decode::DecodedWind, drivers::decode::Refusal>& decoded,
                                      std::optional<double> speed_m_s, std::optional<double> direction_deg,
                                      double tolerance = 0.006) {
  if (!decoded) return testing::AssertionFailure() << "refused: " << name_of(decoded.error());
  const auto agrees = [&](std::optional<double> value, std::optional<double> expected) {
    return value.has_value() == expected.has_value() && (!value || std::abs(*value - *expected) <= tolerance);
  };
  if (agrees(decoded->speed_m_s, speed_m_s) && agrees(decoded->direction_deg, direction_deg)) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "speed " << testing::PrintToString(decoded->speed_m_s) << ", direction "
                                     << testing::PrintToString(decoded->direction_deg);
}

/// Does every value that is there lie in its physical range, and is at least one there?
inline bool is_physical(const drivers::decode::DecodedWind& wind) {
  const auto is_speed = [](std::optional<double> speed) {
    return !speed || (*speed >= 0.0 && *speed <= wind::kMaxPlausibleSpeed_m_s);
  };
  return is_speed(wind.speed_m_s) && is_speed(wind.gust_m_s) &&
         (!wind.direction_deg || (*wind.direction_deg >= 0.0 && *wind.direction_deg < 360.0)) &&
         (wind.speed_m_s || wind.direction_deg || wind.gust_m_s);
}

/// "$" body "*" and the right checksum.
inline std::string sentence(std::string_view body) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  const unsigned sum = drivers::decode::xor_checksum(body);
  return "$" + std::string(body) + "*" + kDigits[sum / 16] + kDigits[sum % 16];
}

/// A file of ../shared/data; null where that folder is missing.
inline nlohmann::json shared_json(const std::string& name) {
  std::ifstream in(test::source_path("../shared/data/" + name));
  return in ? nlohmann::json::parse(in) : nlohmann::json();
}

}  // namespace yuragi
