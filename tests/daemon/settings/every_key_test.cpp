// Each key of a configuration, at every place where a person meets it. A key that is declared, in a table, a driver or
// a scene, is met here without a further line.
#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "daemon/settings/config.hpp"
#include "daemon/settings/config_edit.hpp"
#include "daemon/settings/each_value.hpp"
#include "daemon/settings/parameter_edit.hpp"
#include "daemon/settings/reload_plan.hpp"
#include "daemon/settings/withhold_secrets.hpp"

namespace yuragi::daemon::settings {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* kHidden = "nobody reads this";

/// A table as it is written: what stands above its keys, and what it calls itself where a value changes.
struct Written {
  std::string name;     ///< "stream", "sensor.blend", "sensor mqtt", "scene grass"
  std::string heading;  ///< up to its first key
  std::string change;   ///< before a key in the plan of a reload
  std::vector<Parameter> parameters;
  KeyChange otherwise;
};

std::vector<Written> all_tables() {
  std::vector<Written> all;
  const auto add = [&all](std::string name, std::string heading, std::string change,
                          std::span<const Parameter> parameters, KeyChange otherwise) {
    all.push_back(
        {std::move(name), std::move(heading), std::move(change), {parameters.begin(), parameters.end()}, otherwise});
  };
  for (const ConfigTable& table : config_tables()) {
    const std::string bracketed = table.name.empty() ? std::string() : fmt::format("[{}]", table.name);
    add(std::string(table.name), bracketed + "\n", bracketed.empty() ? "" : bracketed + " ", table.parameters,
        table.change);
  }
  for (const SensorTable& table : sensor_tables()) {
    add(fmt::format("sensor.{}", table.name),
        fmt::format("[[sensor]]\ndriver = \"synthetic\"\n[sensor.{}]\n", table.name),
        fmt::format("sensor synthetic: [sensor.{}] ", table.name), table.parameters, table.change);
  }
  for (const auto* driver : drivers::sensor::driver_table()) {
    add(fmt::format("sensor {}", driver->name),
        fmt::format("[[sensor]]\nname = \"a\"\ndriver = \"{}\"\n", driver->name), "sensor a: ", driver->parameters,
        KeyChange::kTakesRestart);
  }
  for (const auto* kind : scenes::scene_table()) {
    add(fmt::format("scene {}", kind->name), fmt::format("[[scene]]\nname = \"a\"\nkind = \"{}\"\n", kind->name),
        "scene a: ", scene_parameters(*kind), kSceneKeyChange);
  }
  add("camera", "[[camera]]\nname = \"a\"\n", "camera a: ", look::camera_parameters(), KeyChange::kAtOnce);
  // An alert has a command or a webhook: each stands beside the other.
  std::vector<Parameter> but_webhook(alert_parameters().begin(), alert_parameters().end());
  std::vector<Parameter> webhook;
  std::erase_if(but_webhook, [&webhook](const Parameter& parameter) {
    if (parameter.name == "webhook") webhook.push_back(parameter);
    return parameter.name == "webhook";
  });
  add("alert", "[[sensor]]\ndriver = \"synthetic\"\n[[alert]]\nname = \"a\"\nwebhook = \"http://a\"\n",
      "alert a: ", but_webhook, KeyChange::kAtOnce);
  add("alert", "[[sensor]]\ndriver = \"synthetic\"\n[[alert]]\nname = \"a\"\ncommand = \"true\"\n",
      "alert a: ", webhook, KeyChange::kAtOnce);
  add("output", "[[output]]\nname = \"a\"\n", "", output::output_parameters(), KeyChange::kTakesRestart);
  add("output.window", "[[output]]\nname = \"a\"\n[[output.window]]\n", "", output::window_parameters(),
      KeyChange::kTakesRestart);
  for (const feeds::ListTable& list : feeds::list_tables()) {
    const std::string heading = fmt::format("[[sensor]]\ndriver = \"synthetic\"\n[[{}]]\nname = \"a\"\n", list.name);
    add(std::string(list.name), heading, fmt::format("{} a: ", list.name), list.parameters, KeyChange::kAtOnce);
    for (const feeds::ListTable& below : list.below) {
      add(fmt::format("{}.{}", list.name, below.name), fmt::format("{}[[{}.{}]]\n", heading, list.name, below.name),
          fmt::format("{} a: {} 1: ", list.name, below.name), below.parameters, KeyChange::kAtOnce);
    }
  }
  return all;
}

/// A value that is allowed and not the default.
ParameterValue another_value(const Parameter& parameter) {
  const ParameterValue& present = parameter.default_value;
  if (const auto* flag = std::get_if<bool>(&present)) return !*flag;
  if (const auto* whole = std::get_if<std::int64_t>(&present)) {
    return static_cast<double>(*whole + 1) <= parameter.max ? *whole + 1 : *whole - 1;
  }
  if (const auto* number = std::get_if<double>(&present)) {
    return *number < parameter.max ? std::min(parameter.max, *number + 0.125) : *number - 0.125;
  }
  if (std::holds_alternative<Secret>(present)) return Secret(kHidden);
  for (const std::string_view choice : parameter.choices) {
    if (choice != std::get<std::string>(present)) return std::string(choice);
  }
  return std::get<std::string>(present) + "1";
}

constexpr std::string_view kScreen =
    "screen_lower_left = '0 0 0'\nscreen_lower_right = '1 0 0'\nscreen_upper_left = '0 1 0'\neye = '0 0 1'";

/// Values of keys that allow few texts, or need another key beside them: the lines, that of the key last.
const std::map<std::string, std::string>& lines_of_choosy_keys() {
  static const std::map<std::string, std::string> kLines = {
      {"stream.listen", "listen = '127.0.0.1:1'"},
      {"http.listen", "listen = '127.0.0.1:1'"},
      {"http.proxies", "proxies = '127.0.0.1'"},
      {"http.origins", "origins = 'http://a'"},
      {"http.readers", "token_file = 'a'\nreaders = 'token'"},
      {"http.key", "certificate = 'a'\nkey = 'b'"},
      {"wind.site_octaves", "site_octaves = '1 2'"},
      {"wind.lead", "lead = 'nats://a:1'"},
      {"wind.follow", "follow = 'tls://a:1, nats://b:2'"},
      {"shaping.site_strong", "site_median = 3.0\nsite_strong = 4.0"},
      {"shaping.hours", "hours = '10:00-18:00'"},
      {"shaping.zone", "zone = 'Asia/Tokyo'"},
      {"look.time", "time = '06:30'"},
      {"sensor.calibration.curve", "curve = '0:0 5:5.5'"},
      {"sensor.blend.lead", "x = 1.0\nlead = 2.0"},
      {"scene.color", "color = '#112233'"},
      {"scene.color_2", "color_2 = '#112233'"},
      {"camera.scene", "scene = 'grass'"},
      {"camera.from", "from = '06:30'"},
      {"alert.sensor", "sensor = 'synthetic'"},
      {"alert.webhook", "webhook = 'http://nobody reads this'"},
      {"osc.to", "to = '127.0.0.1:9001'"},
      {"osc_query.listen", "listen = '127.0.0.1:1'"},
      {"osc.send", "send = 'wind'"},
      {"osc.prefix", "prefix = '/a'"},
      {"osc.map.value", "value = 'norm'"},
      {"osc.map.address", "address = '/a'"},
      {"osc.map.from", "from = '0 2'"},
      {"osc.map.to", "to = '0 2'"},
      {"osc.cue.sensor", "when = 'sensor_silent'\nsensor = 'synthetic'"},
      {"osc.cue.address", "address = '/a'"},
      {"dmx.protocol", "to = '127.0.0.1'\nprotocol = 'artnet'"},
      {"dmx.to", "to = '127.0.0.1'"},
      {"dmx.interface", "interface = '127.0.0.1'"},
      {"dmx.channel.bits", "bits = 16"},
      {"dmx.channel.value", "value = 'norm'"},
      {"dmx.channel.from", "from = '0 2'"},
      {"dmx.channel.to", "to = '0 2'"},
      {"dmx.grid.value", "value = 'norm'"},
      {"dmx.grid.from", "from = '0 2'"},
      {"dmx.grid.to", "to = '#000000 #00ff00'"},
      {"dmx.grid.rest", "rest = '#000001'"},
      {"nmea.to", "to = '127.0.0.1:10111'"},
      {"nmea.listen", "listen = '127.0.0.1:10111'"},
      {"output.size", "size = '640x480'"},
      {"output.screen_lower_left", std::string(kScreen)},
      {"output.screen_lower_right", std::string(kScreen)},
      {"output.screen_upper_left", std::string(kScreen)},
      {"output.eye", std::string(kScreen)},
      {"output.window.crop", "crop = '0 0 0.5 1'"},
      {"output.window.rotation", "rotation = 90"},
      {"output.window.corners", "corners = '0 0 0.5 0 1 1 0 1'"},
  };
  return kLines;
}

/// The lines by which a file gives a key a value, the key's own last.
std::string lines_for(const Written& table, const Parameter& parameter) {
  const auto found =
      lines_of_choosy_keys().find(table.name.substr(0, table.name.find(' ')) + "." + std::string(parameter.name));
  if (found != lines_of_choosy_keys().end()) return found->second;
  ParameterValue value = another_value(parameter);
  if (const auto* secret = std::get_if<Secret>(&value)) value = secret->reveal();
  return fmt::format("{} = {}", parameter.name, toml_value(value));
}

/// Calls use(table, parameter, configuration without it, configuration with it, its line).
template <class Use>
void for_each_key(const Use& use) {
  for (const Written& table : all_tables()) {
    for (const Parameter& parameter : table.parameters) {
      SCOPED_TRACE(table.name + "." + std::string(parameter.name));
      const std::string lines = lines_for(table, parameter);
      const std::size_t last = lines.rfind('\n') + 1;  // 0 where there is one line
      // A screen takes all of its keys.
      const std::string others = lines == kScreen ? std::string() : lines.substr(0, last);
      use(table, parameter, table.heading + others, table.heading + lines + "\n");
    }
  }
}

bool is_secret(const Parameter& parameter) {
  return std::holds_alternative<Secret>(parameter.default_value);
}

TEST(EveryKey, IsReadAndWrittenAndNoSecretIsSeen) {
  for_each_key([](const Written& table, const Parameter& parameter, const std::string&, const std::string& with) {
    const Config config = parse_config(with, "wall.toml");
    std::vector<std::string> others;
    for_each_value(config, [&](const std::string&, const Parameter& one, const ParameterValue& value) {
      if (one.name == parameter.name && value != one.default_value) others.push_back(value_text(value));
    });
    EXPECT_FALSE(others.empty());
    const std::string written = to_toml(config);
    EXPECT_THAT(written, HasSubstr(fmt::format("{} = ", parameter.name))) << table.name;
    EXPECT_EQ(to_toml(parse_config(written, "again.toml")), written);
    if (!is_secret(parameter)) return;
    EXPECT_THAT(written, Not(HasSubstr(kHidden)));
    EXPECT_THAT(withhold_in_configuration(with)->text, Not(HasSubstr(kHidden)));
  });
}

TEST(EveryKey, IsComparedOnReloadAndAppliedByItsRule) {
  for_each_key(
      [](const Written& table, const Parameter& parameter, const std::string& without, const std::string& with) {
        const ReloadPlan plan = plan_reload(parse_config(without, "wall.toml"), parse_config(with, "wall.toml"), true);
        const bool takes_restart = parameter.change.value_or(table.otherwise) == KeyChange::kTakesRestart;
        const std::vector<std::string>& noted = takes_restart ? plan.takes_restart : plan.applied;
        EXPECT_EQ(plan.applied.size() + plan.takes_restart.size(), 1U);
        if (table.change.empty() && !table.name.empty()) return;  // an output is compared as a whole
        EXPECT_THAT(noted, Contains(StartsWith(fmt::format("{}{}: ", table.change, parameter.name))));
      });
}

TEST(EveryKey, OfLookAndScenesCanBeSetOrSaysWhatItTakes) {
  for_each_key(
      [](const Written& table, const Parameter& parameter, const std::string& without, const std::string& with) {
        const bool is_scene = table.name.starts_with("scene ");
        if (!is_scene && table.name != "look") return;
        const Config running = parse_config(without, "wall.toml");
        const Config wanted = parse_config(with, "wall.toml");
        const ParameterValues& values = is_scene ? wanted.scenes[0].values : wanted.by_name.at("look");
        const std::string key(parameter.name);
        const ParameterEdit edit{.scene = is_scene ? "a" : "", .key = key, .value = value_text(values.all().at(key))};
        const auto done = edited(running, running, {&edit, 1});
        if (parameter.change == KeyChange::kTakesReload) {
          EXPECT_THAT(done.error().message, HasSubstr("yuragi reload"));
          return;
        }
        ASSERT_TRUE(done) << done.error().message;
        EXPECT_EQ(to_toml(*done), to_toml(wanted));
      });
}

}  // namespace
}  // namespace yuragi::daemon::settings
