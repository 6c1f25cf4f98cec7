#include "daemon/settings/page_file.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "daemon/settings/config_edit.hpp"
#include "daemon/settings/config_file.hpp"
#include "daemon/settings/own_token.hpp"
#include "daemon/settings/same_device.hpp"
#include "engine/base/printable_text.hpp"
#include "engine/platform/whole_file.hpp"
#include "engine/tables/parse_toml.hpp"
#include "engine/tables/toml_values.hpp"

namespace yuragi::daemon::settings {
namespace {

constexpr const char* kFileName = "page.toml";
constexpr const char* kServicePage = "/var/lib/yuragi/page.toml";
constexpr const char* kHead =
    "# The sensors, calibrations and values that were set on the page. Written by yuragi; `yuragi check-config` shows "
    "the result.\n";
constexpr std::string_view kDevices = "/dev/";
constexpr std::string_view kBareKey = "abcdefghijklmnopqrstuvwxyz0123456789_";

/// Texts that name nothing of this machine's disk: addresses, places in what a device sends, passwords.
constexpr auto kPlainTexts = std::to_array<std::string_view>({"davis.host",
                                                              "ecowitt-push.from",
                                                              "ecowitt-push.host",
                                                              "ecowitt-push.host_name",
                                                              "ecowitt-push.path",
                                                              "ecowitt-push.station_key",
                                                              "ecowitt.host",
                                                              "hid.serial",
                                                              "json.direction",
                                                              "json.gust",
                                                              "json.speed",
                                                              "json.time",
                                                              "json.url",
                                                              "line.direction_key",
                                                              "line.gust_key",
                                                              "line.host",
                                                              "line.invalid",
                                                              "line.sender",
                                                              "line.speed_key",
                                                              "microphone.curve",
                                                              "microphone.device",
                                                              "microphone.faces",
                                                              "microphone.host_api",
                                                              "modbus.host",
                                                              "mqtt.channel",
                                                              "mqtt.direction_path",
                                                              "mqtt.direction_topic",
                                                              "mqtt.gust_path",
                                                              "mqtt.gust_topic",
                                                              "mqtt.host",
                                                              "mqtt.id",
                                                              "mqtt.model",
                                                              "mqtt.password",
                                                              "mqtt.speed_path",
                                                              "mqtt.topic",
                                                              "mqtt.user",
                                                              "nmea.address",
                                                              "nmea.host",
                                                              "nmea.sender",
                                                              "nmea.sentences",
                                                              "nmea.talker",
                                                              "nmea2000.host",
                                                              "nmea2000.interface",
                                                              "nmea2000.sender",
                                                              "osc.address",
                                                              "osc.direction_address",
                                                              "osc.from",
                                                              "osc.gust_address",
                                                              "osc.host",
                                                              "signalk.context",
                                                              "signalk.host",
                                                              "signalk.path",
                                                              "signalk.sender",
                                                              "signalk.source",
                                                              "signalk.token",
                                                              "tempest.from",
                                                              "tempest.host",
                                                              "tempest.serial_number",
                                                              "umb.host",
                                                              "usb.port",
                                                              "usb.serial",
                                                              "weatherlink.host"});

/// Texts that name a device: only one of /dev.
constexpr auto kDeviceTexts =
    std::to_array<std::string_view>({"davis.device", "umb.device", "modbus.device", "modbus.direction_device",
                                     "nmea.device", "nmea2000.device", "signalk.device", "line.device", "hid.path"});

/// Texts that are a name of ours or the path of a file: only the name.
constexpr auto kNameTexts = std::to_array<std::string_view>({"modbus.profile"});

enum class Kind : std::uint8_t { kPlain, kDevice, kName, kRefused };

template <class List>
bool has(const List& list, const std::string& key) {
  return std::ranges::find(list, key) != list.end();
}

bool is_text(const Parameter& key) {
  return std::holds_alternative<std::string>(key.default_value) || std::holds_alternative<Secret>(key.default_value);
}

Kind kind_of(const drivers::sensor::DriverDescription& driver, const Parameter& key) {
  if (driver.plays_recordings) return Kind::kRefused;
  if (!is_text(key) || !key.choices.empty()) return Kind::kPlain;
  const std::string full = fmt::format("{}.{}", driver.name, key.name);
  if (has(kDeviceTexts, full)) return Kind::kDevice;
  if (has(kNameTexts, full)) return Kind::kName;
  return has(kPlainTexts, full) ? Kind::kPlain : Kind::kRefused;
}

Failure not_toml() {
  return {"page.toml is not TOML", FailureKind::kBadData};
}

std::string name_of(const toml::table& entry) {
  return entry["name"].value<std::string>().value_or(entry["driver"].value_or(std::string()));
}

/// How a microphone's own calibration is called beside [sensor.calibration], which has keys of the same names.
struct LevelKey {
  std::string_view of_driver, of_page;
};
constexpr std::array kLevelKeys = {LevelKey{"gain", "level_gain"}, LevelKey{"exponent", "level_exponent"},
                                   LevelKey{"curve", "level_curve"}};

// The lists of the file.
constexpr const char* kSensors = "sensor";
constexpr const char* kCalibrations = "calibration";
// Of a calibration:
constexpr const char* kCalibrated = "sensor";
constexpr const char* kReplaced = "replaces";

std::string calibrated_by(const toml::table& entry) {
  return entry[kCalibrated].value_or(std::string());
}

std::string written(const toml::table& root) {
  std::ostringstream out;
  out << kHead << '\n' << root << '\n';
  return out.str();
}

/// What `use` makes of the page's text as a table; fails if it is not TOML.
template <class Use>
auto of_page(std::string_view page_text, const Use& use)
    -> Result<decltype(use(std::declval<toml::table&>())), Failure> {
  try {
    toml::table root = tables::parse_toml(page_text);
    return {boost::system::in_place_value, use(root)};
  } catch (const toml::parse_error&) {
    return not_toml();
  }
}

/// The names of a list's entries, in order; `name_in`: that of one.
Result<std::vector<std::string>, Failure> names_in(std::string_view page_text, const char* list,
                                                   std::string (*name_in)(const toml::table&)) {
  return of_page(page_text, [&](toml::table& root) {
    std::vector<std::string> names;
    const toml::array* const entries = root[list].as_array();
    for (std::size_t i = 0; entries != nullptr && i < entries->size(); ++i) {
      if (const toml::table* const entry = entries->get(i)->as_table()) names.push_back(name_in(*entry));
    }
    return names;
  });
}

/// The page's text without the first entry of a list that has this name; fails with `missing` if there is none.
Result<std::string, Failure> without_entry(std::string_view page_text, const char* list,
                                           std::string (*name_in)(const toml::table&), std::string_view name,
                                           const Failure& missing) {
  const auto text = of_page(page_text, [&](toml::table& root) -> std::optional<std::string> {
    toml::array* const entries = root[list].as_array();
    for (std::size_t i = 0; entries != nullptr && i < entries->size(); ++i) {
      const toml::table* const entry = entries->get(i)->as_table();
      if (entry == nullptr || name_in(*entry) != name) continue;
      entries->erase(entries->begin() + static_cast<std::ptrdiff_t>(i));
      if (entries->empty()) root.erase(list);
      return written(root);
    }
    return std::nullopt;
  });
  if (!text) return text.error();
  if (!*text) return missing;
  return {boost::system::in_place_value, **text};
}

/// The first table of a list for which `is_it` holds; null: there is none.
template <class IsIt>
toml::table* table_in(toml::table& root, const char* list, const IsIt& is_it) {
  toml::array* const tables = root[list].as_array();
  for (std::size_t i = 0; tables != nullptr && i < tables->size(); ++i) {
    toml::table* const table = tables->get(i)->as_table();
    if (table != nullptr && is_it(*table)) return table;
  }
  return nullptr;
}

void put(toml::table& table, std::string_view key, const ParameterValue& value) {
  if (const auto* number = std::get_if<double>(&value)) table.insert_or_assign(key, *number);
  if (const auto* text = std::get_if<std::string>(&value)) table.insert_or_assign(key, *text);
}

/// The table for the calibration of a sensor of the configuration: the one that is there if it still counts, otherwise
/// a new one.
toml::table& calibration_of_configured(toml::table& root, const SensorConfig& sensor) {
  toml::table replaced;
  for (const auto& [key, value] : replaced_by_page(sensor)) put(replaced, key, value);
  toml::table* table =
      table_in(root, kCalibrations, [&](const toml::table& one) { return calibrated_by(one) == sensor.name; });
  if (table != nullptr) {
    const toml::table* const before = (*table)[kReplaced].as_table();
    if (before != nullptr && *before == replaced) return *table;
    table->clear();
  } else {
    root.insert(kCalibrations, toml::array());
    toml::array& list = *root[kCalibrations].as_array();
    list.push_back(toml::table());
    table = list.get(list.size() - 1)->as_table();
  }
  table->insert(kCalibrated, sensor.name);
  table->insert(kReplaced, std::move(replaced));
  return *table;
}

/// A value of [look] or of a scene, and its place in the file.
struct KeptValue {
  ParameterEdit edit;
  std::string place = {};
};

/// Collects the values of a page's text. What is no value is put into `passed_over`.
class KeptReader {
 public:
  KeptReader(const std::string& source_name, std::vector<std::string>& passed_over)
      : places_(source_name), passed_over_(passed_over) {}

  std::vector<KeptValue> read(const toml::table& root) {
    if (const toml::node* const look = root.get("look")) add_table(*look, "");
    const toml::node* const scenes = root.get("scene");
    if (scenes == nullptr) return std::move(values_);
    const toml::array* const list = scenes->as_array();
    if (list == nullptr) pass_over(*scenes, "scene: is no list; write its heading as [[scene]]");
    for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
      const toml::node& entry = *list->get(i);
      const auto name = entry.is_table() ? (*entry.as_table())["name"].value<std::string>() : std::nullopt;
      if (name && !name->empty()) {
        add_table(entry, *name);
      } else {
        pass_over(entry, "scene.name: is missing");
      }
    }
    return std::move(values_);
  }

 private:
  void add_table(const toml::node& node, const std::string& scene) {
    const toml::table* const table = node.as_table();
    if (table == nullptr) return pass_over(node, "look: is a value; write it as a table, [look]");
    for (const auto& [key, each] : *table) {
      if (!scene.empty() && key.str() == "name") continue;
      if (const auto value = tables::parameter_value_of(each)) {
        values_.push_back({{scene, std::string(key.str()), value_text(*value)}, places_.place(each.source())});
      } else {
        pass_over(each, std::string(key.str()) + ": takes one value: true, a number or a text");
      }
    }
  }
  void pass_over(const toml::node& where, const std::string& why) {
    passed_over_.push_back(fmt::format("{}: {}", places_.place(where.source()), why));
  }

  tables::TomlMistakes places_;
  std::vector<std::string>& passed_over_;
  std::vector<KeptValue> values_;
};

/// As ReloadPlan names it.
std::string name_of(const ParameterEdit& edit) {
  return edit.scene.empty() ? "[look] " + edit.key : fmt::format("scene {}: {}", edit.scene, edit.key);
}

/// The page's text as a table; empty if it is not TOML.
toml::table table_or_none(std::string_view page_text) {
  try {
    return tables::parse_toml(page_text);
  } catch (const toml::parse_error&) {
    return {};
  }
}

/// The table of a scene in `root`, which is added if it is missing; with an empty name that of [look].
toml::table& table_for(toml::table& root, const std::string& scene) {
  if (scene.empty()) {
    if (!root["look"].is_table()) root.insert_or_assign("look", toml::table{});
    return *root["look"].as_table();
  }
  const auto is_it = [&](const toml::table& one) { return one["name"].value<std::string>() == scene; };
  if (toml::table* const entry = table_in(root, "scene", is_it)) return *entry;
  if (!root["scene"].is_array()) root.insert_or_assign("scene", toml::array{});
  toml::array& list = *root["scene"].as_array();
  list.push_back(toml::table{{"name", scene}});
  return *list.back().as_table();
}

/// Its value as it was checked; null: it has none.
const ParameterValue* value_in(const Config& config, const ParameterEdit& edit) {
  const auto scene = std::ranges::find(config.scenes, edit.scene, &SceneConfig::name);
  if (!edit.scene.empty() && scene == config.scenes.end()) return nullptr;
  const ParameterValues::Map& values = edit.scene.empty() ? config.by_name.at("look").all() : scene->values.all();
  const auto found = values.find(edit.key);
  return found == values.end() ? nullptr : &found->second;
}

bool can_be_used(const Config& config) {
  try {
    open_sensors(config.sensors);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

std::filesystem::path page_file(const std::filesystem::path& config_file) {
  const std::filesystem::path file = state_file(config_file, kFileName);
  // A command of a terminal has no STATE_DIRECTORY.
  const bool is_of_service = !config_file.empty() && absolute_path(config_file) == kServiceConfig;
  return is_of_service && file.filename() != kFileName ? std::filesystem::path(kServicePage) : file;
}

std::optional<std::string> page_refusal(const drivers::sensor::DriverDescription& driver, const Parameter& key) {
  if (driver.plays_recordings) return "is of a recording, which is not for the page: write it into the configuration";
  if (kind_of(driver, key) != Kind::kRefused) return std::nullopt;
  return "is not for the page, because it can name a file or a program: write this sensor into the configuration";
}

std::optional<std::string> page_refusal(const drivers::sensor::DriverDescription& driver, const Parameter& key,
                                        const ParameterValue& value) {
  if (auto refusal = page_refusal(driver, key)) return refusal;
  const auto* const text = std::get_if<std::string>(&value);
  if (text == nullptr || text->empty()) return std::nullopt;
  const Kind kind = kind_of(driver, key);
  if (kind == Kind::kDevice && (!text->starts_with(kDevices) || text->find("..") != std::string::npos))
    return "must be a device in /dev";
  if (kind == Kind::kName && (text->find('/') != std::string::npos || text->ends_with(".toml")))
    return "must be a name: a path is not for the page";
  return std::nullopt;
}

Config with_page_checked(const Config& config, std::string_view page_text, const std::string& source_name) {
  Config both = with_page(config, page_text, source_name);
  std::vector<std::unique_ptr<drivers::sensor::Sensor>> opened;  // together: they may need the same line
  for (const SensorConfig& sensor : both.sensors) {
    const auto known = std::ranges::find(config.sensors, sensor.name, &SensorConfig::name);
    if (known == config.sensors.end()) {
      opened.push_back(open_sensor(sensor));
    } else if (known->values.all() != sensor.values.all()) {
      check_sensor(sensor);  // a microphone's calibration is of its driver
    }
  }
  refuse_same_device(both.sensors);
  return both;
}

Config load_installation(const std::filesystem::path& file) {
  return with_page_file(load_config(file), file);
}

Config with_page_file(Config config, const std::filesystem::path& file) {
  const std::filesystem::path page = page_file(file);
  std::error_code error;
  if (page.empty() || (!std::filesystem::exists(page, error) && !error)) return config;
  const auto text = platform::read_whole(page, kMaxPage_bytes);
  if (!text) {
    config.page_trouble = page.string() + ":1:1: file: " + text.error().message;
    return config;
  }
  config.page_file = page.string();
  config = with_page_values(config, *text, page.string());
  try {
    Config both = with_page(config, *text, page.string());
    if (can_be_used(config)) open_sensors(both.sensors);  // otherwise it is the fault of the configuration
    return both;
  } catch (const std::exception& fault) {
    config.page_trouble = fault.what();
  }
  return config;
}

Config with_page_values(const Config& config, std::string_view page_text, const std::string& source_name) {
  std::vector<std::string> passed_over;
  std::vector<KeptValue> waiting = KeptReader(source_name, passed_over).read(table_or_none(page_text));
  Config with = config;
  // Values that contradict the configuration's can go together with others of the file.
  for (bool is_going_on = true; std::exchange(is_going_on, false);) {
    std::erase_if(waiting, [&](const KeptValue& value) {
      auto next = edited(with, config, std::span(&value.edit, 1));
      if (!next) return false;
      with = std::move(*next);
      with.kept.push_back(name_of(value.edit));
      is_going_on = true;
      return true;
    });
    is_going_on = is_going_on && !waiting.empty();
  }
  for (const KeptValue& value : waiting) {
    const auto refused = edited(with, config, std::span(&value.edit, 1));
    if (!refused)
      passed_over.push_back(fmt::format("{}: {}: {}", value.place, refused.error().name, refused.error().message));
  }
  for (std::string& line : passed_over) make_printable(line);
  with.passed_over = std::move(passed_over);
  return with;
}

std::vector<std::string> page_warnings(const Config& config) {
  std::vector<std::string> warnings;
  if (!config.page_trouble.empty()) warnings.push_back("what the page has set up is left out: " + config.page_trouble);
  for (const PageCalibration& calibration : config.page_calibrations) {
    if (!calibration.why_not.empty())
      warnings.push_back(fmt::format("the page's calibration of {} ({}) does not count: {}", calibration.sensor,
                                     calibration.values, calibration.why_not));
  }
  for (const std::string& value : config.passed_over)
    warnings.push_back("a value that the page keeps is passed over: " + value);
  return warnings;
}

std::string with_sensor(std::string_view page_text, const PageSensor& sensor) {
  std::string text(page_text.empty() ? std::string_view(kHead) : page_text);
  if (!text.ends_with('\n')) text += '\n';
  text += fmt::format("\n[[sensor]]\nname = {}\ndriver = {}\n", toml_value(sensor.name), toml_value(sensor.driver));
  const auto* const driver = drivers::sensor::find_driver(sensor.driver);
  for (const auto& [key, typed] : sensor.values) {
    ParameterValue value = typed;
    if (driver != nullptr) {
      const auto known = std::ranges::find(driver->parameters, key, &Parameter::name);
      if (known != driver->parameters.end() && !is_text(*known)) value = typed_value(*known, typed);
    }
    const bool is_bare = !key.empty() && key.find_first_not_of(kBareKey) == std::string::npos;
    text += fmt::format("{} = {}\n", is_bare ? key : toml_value(key), toml_value(value));
  }
  return text;
}

Result<std::string, Failure> without_sensor(std::string_view page_text, std::string_view name) {
  return without_entry(page_text, kSensors, name_of, name,
                       {fmt::format("the page has set up no sensor \"{}\"", name), FailureKind::kNoInput});
}

std::vector<Parameter> page_calibration_keys(const drivers::sensor::DriverDescription& driver) {
  std::vector<Parameter> keys;
  for (const Parameter& key : std::ranges::find(sensor_tables(), kCalibrationTable, &SensorTable::name)->parameters) {
    if (key.name == "gain" || key.name == "offset" || key.name == "curve" || key.name == "north_offset")
      keys.push_back(key);
  }
  if (driver.calibration != drivers::sensor::CalibrationMeans::kSoundLevel) return keys;
  for (Parameter key : driver.parameters) {
    const auto* const level = std::ranges::find(kLevelKeys, key.name, &LevelKey::of_driver);
    if (level == kLevelKeys.end()) continue;
    key.name = level->of_page;
    keys.push_back(key);
  }
  return keys;
}

ConfigChange place_of_page_key(std::string_view name) {
  const auto* const level = std::ranges::find(kLevelKeys, name, &LevelKey::of_page);
  if (level != kLevelKeys.end()) return {"", std::string(level->of_driver), {}};
  return {std::string(kCalibrationTable), std::string(name), {}};
}

std::string page_key_of(const ConfigChange& place) {
  const auto* const level = std::ranges::find(kLevelKeys, place.key, &LevelKey::of_driver);
  return place.table.empty() && level != kLevelKeys.end() ? std::string(level->of_page) : place.key;
}

const ParameterValue& value_at(const SensorConfig& sensor, const ConfigChange& place) {
  return (place.table.empty() ? sensor.values : sensor.by_name.at(kCalibrationTable)).all().at(place.key);
}

std::vector<std::pair<std::string_view, ParameterValue>> replaced_by_page(const SensorConfig& sensor) {
  std::vector<std::pair<std::string_view, ParameterValue>> replaced = {
      {"driver", std::string(sensor.driver->name)},  // another device may have its name now
      {"unit", sensor.by_name.at(kCalibrationTable).text("unit")}};
  for (const Parameter& key : page_calibration_keys(*sensor.driver))
    replaced.emplace_back(key.name, value_at(sensor, place_of_page_key(key.name)));
  return replaced;
}

Result<std::string, Failure> with_calibration(std::string_view page_text, const Config& config, std::string_view sensor,
                                              std::span<const ConfigChange> changes) {
  try {
    toml::table root = tables::parse_toml(page_text);
    if (toml::table* const entry =
            table_in(root, kSensors, [&](const toml::table& one) { return name_of(one) == sensor; })) {
      entry->insert(kCalibrationTable, toml::table());
      toml::table* const table = (*entry)[kCalibrationTable].as_table();
      if (table == nullptr) return Failure{"the page's file has a calibration that is no table", FailureKind::kBadData};
      for (const ConfigChange& change : changes) put(change.table.empty() ? *entry : *table, change.key, change.value);
    } else {
      const auto known = std::ranges::find(config.sensors, sensor, &SensorConfig::name);
      if (known == config.sensors.end() || known->origin.empty())
        return Failure{fmt::format("there is no sensor \"{}\" to calibrate", sensor), FailureKind::kNoInput};
      toml::table& table = calibration_of_configured(root, *known);
      for (const ConfigChange& change : changes) put(table, page_key_of(change), change.value);
    }
    return {boost::system::in_place_value, written(root)};
  } catch (const toml::parse_error&) {
    return not_toml();
  }
}

Result<std::string, Failure> without_calibration(std::string_view page_text, std::string_view sensor) {
  return without_entry(page_text, kCalibrations, calibrated_by, sensor,
                       {fmt::format("the page has no calibration of \"{}\"", sensor), FailureKind::kNoInput});
}

Result<std::vector<std::string>, Failure> calibrations_in(std::string_view page_text) {
  return names_in(page_text, kCalibrations, calibrated_by);
}

Result<std::vector<std::string>, Failure> sensors_in(std::string_view page_text) {
  return names_in(page_text, kSensors, name_of);
}

Result<std::string, Failure> with_values(std::string_view page_text, std::span<const ParameterEdit> values,
                                         const Config& edited) {
  return of_page(page_text, [&](toml::table& root) {
    for (const ParameterEdit& edit : values) {
      const ParameterValue* const value = value_in(edited, edit);
      if (value == nullptr) continue;
      toml::table& table = table_for(root, edit.scene);
      std::visit([&](const auto& plain) { table.insert_or_assign(edit.key, plain); }, printable(*value));
    }
    return written(root);
  });
}

Result<std::string, Failure> without_values(std::string_view page_text) {
  return of_page(page_text, [](toml::table& root) {
    root.erase("look");
    root.erase("scene");
    return written(root);
  });
}

Result<std::vector<std::string>, Failure> kept_in(std::string_view page_text) {
  return of_page(page_text, [](const toml::table& root) {
    std::vector<std::string> passed_over;
    std::vector<std::string> names;
    for (const KeptValue& value : KeptReader("", passed_over).read(root)) names.push_back(name_of(value.edit));
    return names;
  });
}

bool have_same_sensors(std::string_view page_text, std::string_view other) {
  try {
    const toml::table one = tables::parse_toml(page_text);
    const toml::table another = tables::parse_toml(other);
    return std::ranges::all_of(std::array{kSensors, kCalibrations}, [&](const char* list) {
      const toml::array* const tables = one[list].as_array();
      const toml::array* const others = another[list].as_array();
      return tables == nullptr || others == nullptr ? tables == others : *tables == *others;
    });
  } catch (const toml::parse_error&) {
    return false;
  }
}

}  // namespace yuragi::daemon::settings
