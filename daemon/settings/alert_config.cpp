#include "daemon/settings/alert_config.hpp"

#include <array>
#include <cstdint>
#include <utility>

#include "engine/base/fields.hpp"

namespace yuragi::daemon::settings {
namespace {

constexpr double kDay_s = 86'400.0;
constexpr double kDefaultAfter_s = 60.0;

/// An [[alert]] as it is written.
struct AlertTable {
  AlertConfig alert;
  std::optional<double> after_s;
  Secret command;
};

auto of_alert(auto member) {
  return member_of(&AlertTable::alert, member);
}

double bytes_of(double megabytes) {
  constexpr double kBytesPerMegabyte = 1e6;
  return kBytesPerMegabyte * megabytes;
}

const Fields<AlertTable>& alert_fields() {
  static const Fields<AlertTable> kFields{
      {{.name = "when",
        .default_value = std::string(kAlertConditionNames[0]),
        .help = "what it is about: a sensor's readings are not used, the measured wind is above speed, the disk "
                "of the recording has less than free, the animation has made no frame, or readings cannot be "
                "recorded",
        .choices = kAlertConditionNames},
       of_alert(&AlertConfig::when)},
      {{.name = "sensor",
        .default_value = std::string(),
        .help = "for sensor_silent: the name of the sensor; empty: every sensor, each with its own alert"},
       of_alert(&AlertConfig::sensor)},
      {{.name = "speed",
        .unit = "m/s",
        .default_value = 15.0,
        .min = 0.1,
        .max = 100.0,
        .help = "for wind_above: limit of the measured wind, including gusts"},
       of_alert(&AlertConfig::speed_m_s)},
      {{.name = "free",
        .unit = "MB",
        .default_value = 1000.0,
        .min = 1.0,
        .max = 1e9,
        .help = "for disk_below: free space"},
       of_alert(&AlertConfig::free_bytes),
       bytes_of},
      {{.name = "after",
        .unit = "s",
        .default_value = kDefaultAfter_s,
        .min = 0.0,
        .max = kDay_s,
        .help = "the alert begins when the condition has held for this long",
        .left_out = "60 s; for wind_above 0, so that one gust is enough"},
       &AlertTable::after_s},
      {{.name = "end_after",
        .unit = "s",
        .default_value = 60.0,
        .min = 0.0,
        .max = kDay_s,
        .help = "the alert ends when the condition has not held for this long"},
       of_alert(&AlertConfig::end_after_s)},
      {{.name = "command",
        .default_value = Secret(),  // it may hold a password
        .help = "run by /bin/sh at its beginning and at its end, for at most a minute, with YURAGI_ALERT (its "
                "name), YURAGI_ALERT_STATE (began or ended) and YURAGI_ALERT_MESSAGE (a sentence) in its "
                "environment; empty: none",
        .takes_control_characters = true},
       &AlertTable::command},
      {{.name = "webhook",
        .default_value = Secret(),
        .help = "an URL, http:// or https://, to which the same is posted as JSON: alert, state, message, host, "
                "time, and text for chat services; if it does not reply, it is tried again for a day; empty: none"},
       of_alert(&AlertConfig::webhook)},
  };
  return kFields;
}

}  // namespace

std::span<const Parameter> alert_parameters() {
  return alert_fields().parameters();
}

Result<AlertConfig, ParameterError> alert_config_of(std::string name, const ParameterValues& values) {
  AlertTable table = alert_fields().of(values);
  AlertConfig& alert = table.alert;
  alert.name = std::move(name);
  alert.values = values;
  alert.after_s = table.after_s.value_or(alert.when == AlertCondition::kWindAbove ? 0.0 : kDefaultAfter_s);
  if (!alert.sensor.empty() && alert.when != AlertCondition::kSensorSilent)
    return ParameterError{"sensor", "applies only if when = \"sensor_silent\"; remove it"};
  if (table.command.is_empty() && alert.webhook.is_empty())
    return ParameterError{"command", "is missing, and webhook too, so nobody would be notified; set one of them"};
  // A configuration that was recorded or printed has only a placeholder here, and cannot notify anybody.
  if (!table.command.is_withheld()) alert.command = table.command.reveal();
  if (alert.webhook.is_withheld()) alert.webhook = Secret();
  const std::string& url = alert.webhook.reveal();
  if (!url.empty() && !url.starts_with("http://") && !url.starts_with("https://"))
    return ParameterError{"webhook", "must be a URL that begins with http:// or https://"};
  return std::move(table.alert);
}

}  // namespace yuragi::daemon::settings
