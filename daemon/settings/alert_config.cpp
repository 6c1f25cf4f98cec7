#include "daemon/settings/alert_config.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace yuragi::daemon::settings {
namespace {

constexpr double kDay_s = 86'400.0;
constexpr double kDefaultAfter_s = 60.0;
constexpr double kBytesPerMegabyte = 1e6;

const std::array kAlertParameters = {
    Parameter{.name = "when",
              .unit = "",
              .default_value = std::string(kAlertConditionNames[0]),
              .help = "what it is about: a sensor's readings are not used, the measured wind is above speed, the disk "
                      "of the recording has less than free, the animation has made no frame, or readings cannot be "
                      "recorded",
              .choices = kAlertConditionNames},
    Parameter{.name = "sensor",
              .unit = "",
              .default_value = std::string(),
              .help = "for sensor_silent: the name of the sensor; empty: each one, told by itself"},
    Parameter{.name = "speed",
              .unit = "m/s",
              .default_value = 15.0,
              .min = 0.1,
              .max = 100.0,
              .help = "for wind_above: of the wind as it is measured, gusts and all"},
    Parameter{.name = "free",
              .unit = "MB",
              .default_value = 1000.0,
              .min = 1.0,
              .max = 1e9,
              .help = "for disk_below: free space"},
    Parameter{.name = "after",
              .unit = "s",
              .default_value = kDefaultAfter_s,
              .min = 0.0,
              .max = kDay_s,
              .help = "it begins when it has been so for this long",
              .left_out = "60 s; for wind_above 0, so that one gust is enough"},
    Parameter{.name = "end_after",
              .unit = "s",
              .default_value = 60.0,
              .min = 0.0,
              .max = kDay_s,
              .help = "it ends when it has no longer been so for this long"},
    Parameter{.name = "command",
              .unit = "",
              .default_value = Secret(),  // it may hold a password
              .help = "run by /bin/sh at its beginning and at its end, for at most a minute, with YURAGI_ALERT (its "
                      "name), YURAGI_ALERT_STATE (began or ended) and YURAGI_ALERT_MESSAGE (a sentence) in its "
                      "environment; empty: none",
              .takes_control_characters = true},
    Parameter{.name = "webhook",
              .unit = "",
              .default_value = Secret(),
              .help = "an URL, http:// or https://, to which the same is posted as JSON: alert, state, message, host, "
                      "time, and text for chat services; tried again for a day where it does not answer; empty: none"},
};

AlertCondition condition_of(std::string_view name) {
  return static_cast<AlertCondition>(std::ranges::find(kAlertConditionNames, name) - kAlertConditionNames.begin());
}

}  // namespace

std::span<const Parameter> alert_parameters() {
  return kAlertParameters;
}

Result<AlertConfig, ParameterError> alert_config_of(std::string name, const ParameterValues& values) {
  AlertConfig alert{.name = std::move(name), .values = values};
  alert.when = condition_of(values.text("when"));
  alert.sensor = values.text("sensor");
  alert.speed_m_s = values.number("speed");
  alert.free_bytes = kBytesPerMegabyte * values.number("free");
  const bool is_wind = alert.when == AlertCondition::kWindAbove;
  alert.after_s = values.has("after") ? values.number("after") : is_wind ? 0.0 : kDefaultAfter_s;
  alert.end_after_s = values.number("end_after");
  // What was recorded or printed has only a word in its place, and can tell nobody.
  const Secret& command = std::get<Secret>(values.all().find("command")->second);
  if (!command.is_withheld()) alert.command = command.reveal();
  const Secret& webhook = std::get<Secret>(values.all().find("webhook")->second);
  if (!webhook.is_withheld()) alert.webhook = webhook;

  if (!alert.sensor.empty() && alert.when != AlertCondition::kSensorSilent)
    return ParameterError{"sensor", "is for when = \"sensor_silent\" only"};
  const std::string& url = alert.webhook.reveal();
  if (!url.empty() && !url.starts_with("http://") && !url.starts_with("https://"))
    return ParameterError{"webhook", "takes an URL that begins with http:// or https://"};
  if (command.is_empty() && webhook.is_empty())
    return ParameterError{"command", "tells nobody; give it a command or a webhook"};
  return alert;
}

}  // namespace yuragi::daemon::settings
