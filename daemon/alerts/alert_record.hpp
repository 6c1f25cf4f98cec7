#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/alerts/alert_news.hpp"
#include "daemon/settings/alert_config.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::alerts {

/// An alert that has begun and has not ended.
struct Active {
  std::string alert = {};  ///< its name
  settings::AlertCondition when = settings::AlertCondition::kSensorSilent;
  std::string subject = {};  ///< the sensor's name; empty for the other conditions
  UtcTime begun{};

  bool operator==(const Active&) const = default;
};

/// How news is delivered.
enum class Channel : std::uint8_t { kCommand, kWebhook };

/// News that one way has not delivered. Its command and webhook are empty: they come from the configuration.
struct UndeliveredNews {
  Channel way = Channel::kCommand;
  News news = {};
};

/// The state of alerts that outlives the daemon.
struct Record {
  std::vector<Active> on = {};
  std::vector<UndeliveredNews> undelivered = {};  ///< oldest first
};

/// Many times the size of a valid record: a larger one is rejected.
inline constexpr std::size_t kMaxAlertRecord_bytes = 16U << 20U;

/// Returns the record as JSON. Pure.
std::string text_of(const Record& record);

/// Reads what text_of() returned; the text is not trusted. Fails if anything in it is invalid. Pure.
Result<Record, Failure> parse_alert_record(std::string_view text);

}  // namespace yuragi::daemon::alerts
