#include "daemon/alerts/alert_record.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <span>

#include <nlohmann/json.hpp>

#include "engine/base/json_text.hpp"

namespace yuragi::daemon::alerts {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 2> kWayNames = {"command", "webhook"};
constexpr std::array<std::string_view, 2> kStateNames = {"began", "ended"};
/// The latest time that is accepted (the year 2096): ages and RFC 3339 can be computed from it.
constexpr std::int64_t kMaxTime_ns = 4'000'000'000'000'000'000;

// These throw json::exception if a value is missing, of another type, unknown or out of range.

std::size_t choice_of(const json& object, const char* key, std::span<const std::string_view> names) {
  const auto found = std::ranges::find(names, object.at(key).get_ref<const std::string&>());
  if (found == names.end()) throw json::other_error::create(0, "unknown name", nullptr);
  return static_cast<std::size_t>(found - names.begin());
}

UtcTime time_of(const json& object) {
  const json& value = object.at("time_ns");
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMaxTime_ns)
    throw json::other_error::create(0, "out of range", nullptr);
  return UtcTime(Nanoseconds(value.get<std::int64_t>()));
}

json number_of(UtcTime time) {
  return std::clamp<std::int64_t>(time.time_since_epoch().count(), 0, kMaxTime_ns);
}

}  // namespace

std::string text_of(const Record& record) {
  json on = json::array();
  for (const Active& one : record.on) {
    on.push_back({{"alert", one.alert},
                  {"when", settings::kAlertConditionNames.at(static_cast<std::size_t>(one.when))},
                  {"subject", one.subject},
                  {"time_ns", number_of(one.begun)}});
  }
  json undelivered = json::array();
  for (const auto& [way, news] : record.undelivered) {
    undelivered.push_back({{"alert", news.alert},
                           {"way", kWayNames.at(static_cast<std::size_t>(way))},
                           {"state", kStateNames.at(news.has_begun ? 0 : 1)},
                           {"message", news.message},
                           {"time_ns", number_of(news.time)}});
  }
  return json_text(json{{"on", on}, {"undelivered", undelivered}}, 1) + '\n';
}

Result<Record, Failure> parse_alert_record(std::string_view text) {
  Record record;
  try {
    const json all = json::parse(text);
    for (const json& one : all.at("on").get_ref<const json::array_t&>()) {
      record.on.push_back(
          {.alert = one.at("alert").get<std::string>(),
           .when = static_cast<settings::AlertCondition>(choice_of(one, "when", settings::kAlertConditionNames)),
           .subject = one.at("subject").get<std::string>(),
           .begun = time_of(one)});
    }
    for (const json& one : all.at("undelivered").get_ref<const json::array_t&>()) {
      record.undelivered.push_back({.way = static_cast<Channel>(choice_of(one, "way", kWayNames)),
                                    .news = {.alert = one.at("alert").get<std::string>(),
                                             .has_begun = choice_of(one, "state", kStateNames) == 0,
                                             .message = one.at("message").get<std::string>(),
                                             .time = time_of(one)}});
    }
  } catch (const json::exception&) {
    return Failure{"is damaged"};
  }
  return record;
}

}  // namespace yuragi::daemon::alerts
