#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>
#include <toml++/toml.h>

#include "daemon/pictures/picture_file.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/settings/config_edit.hpp"
#include "daemon/settings/page_file.hpp"
#include "engine/output/output_tables.hpp"
#include "engine/tables/parse_toml.hpp"
#include "engine/tables/toml_values.hpp"

namespace yuragi::daemon::settings {
namespace {

constexpr std::string_view kNameKey = "name";
constexpr std::string_view kGroundKind = "ground";

template <class Description>
const Description& description_named(std::span<const Description* const> table, std::string_view name) {
  for (const Description* description : table) {
    if (description->name == name) return *description;
  }
  throw std::logic_error("no " + std::string(name) + " in its table");
}

/// The sensors that senders find by searching the network.
std::vector<feeds::NetworkService> services_of(std::span<const SensorConfig> sensors) {
  std::vector<feeds::NetworkService> all;
  for (const SensorConfig& sensor : sensors) {
    if (sensor.driver->service_type.empty()) continue;
    for (const drivers::sensor::Endpoint& endpoint : sensor.driver->endpoints(sensor.values))
      all.push_back({.type = std::string(sensor.driver->service_type), .address = endpoint.name});
  }
  return all;
}

/// The sensor of a file without any.
SensorConfig synthetic_sensor() {
  const drivers::sensor::DriverDescription& synthetic = description_named(drivers::sensor::driver_table(), "synthetic");
  return default_sensor(std::string(synthetic.name), synthetic,
                        ParameterValues::resolve(synthetic.parameters, {}).value());
}

/// The scenes of a file without any.
std::vector<SceneConfig> default_scenes() {
  std::vector<SceneConfig> scenes;
  for (const std::string_view kind : {"grass", "ground"}) {
    const scenes::Description& scene = description_named(scenes::scene_table(), kind);
    scenes.push_back(
        scene_config_of(std::string(scene.name), scene, ParameterValues::resolve(scene_parameters(scene), {}).value()));
  }
  return scenes;
}

/// All keys of a [[sensor]] or a [[scene]] of this kind.
std::span<const Parameter> parameters_of(const drivers::sensor::DriverDescription& driver) {
  return driver.parameters;
}
std::vector<Parameter> parameters_of(const scenes::Description& scene) {
  return scene_parameters(scene);
}

/// Its retired keys.
std::span<const scenes::RetiredParameter> retired_of(const drivers::sensor::DriverDescription&) {
  return {};
}
std::span<const scenes::RetiredParameter> retired_of(const scenes::Description& scene) {
  return scene.retired;
}

/// The keys of a [[sensor]] of any kind, besides its driver's keys.
std::set<std::string_view> keys_beside(const drivers::sensor::DriverDescription&) {
  std::set<std::string_view> keys = {kNameKey, "driver"};
  for (const SensorTable& table : sensor_tables()) keys.insert(table.name);
  return keys;
}
std::set<std::string_view> keys_beside(const scenes::Description&) {
  return {kNameKey, "kind"};
}

bool is_list(const toml::node& node) {
  return node.is_array_of_tables() || (node.is_array() && node.as_array()->empty());
}

/// All names allowed at the top of a file, for a person.
std::string top_level_names() {
  std::string names;
  for (const Parameter& parameter : config_table("").parameters) names += std::string(parameter.name) + ", ";
  for (const ConfigTable& table : config_tables()) {
    if (!table.name.empty()) names += fmt::format("[{}], ", table.name);
  }
  for (const std::string_view list : config_lists()) names += fmt::format("[[{}]], ", list);
  names.erase(names.size() - 2);
  return names;
}

/// Reads a parsed file and collects every mistake with its place.
class ConfigReader {
 public:
  ConfigReader(const std::string& source_name, const std::optional<std::filesystem::path>& folder)
      : mistakes_(source_name), folder_(folder) {}

  Config read(const toml::table& root) {
    Config config;
    check_top_level(root);
    read_tables<Config>(root, "", config_tables(), config);
    if (config.wind.fallback) config.wind.fallback->origin = place(root["wind"]["fallback_recording"].node()->source());
    read_sensors(root, config, [](const SensorConfig&, const toml::table&) {});
    for_each_entry(root, "scene", "kind", kMaxScenes, scenes::scene_table(),
                   [&](SceneConfig scene, const toml::table& entry) {
                     scene.cloth = read_cloth(entry, scene.values);
                     config.scenes.push_back(std::move(scene));
                   });
    if (config.scenes.empty()) config.scenes = default_scenes();
    read_ground_image(root, config);
    for_each_named(root, "camera", look::kMaxCameras,
                   [&](std::string name, const toml::table& entry) { read_camera(std::move(name), entry, config); });
    set_clock(config);
    for_each_named(root, "alert", kMaxAlerts,
                   [&](std::string name, const toml::table& entry) { read_alert(std::move(name), entry, config); });
    if (const toml::node* node = root.get(output::kOutputList); node != nullptr && is_list(*node))
      config.outputs = output::read_outputs(root, mistakes_);
    for (const feeds::ListTable& list : feeds::list_tables()) read_list(root, list, config);
    config.feeds.osc_query.sensors = services_of(config.sensors);
    if (!mistakes_.empty()) throw ConfigError(mistakes_.text());
    return config;
  }

  /// The file of the page: adds its sensors, and sets its calibrations of others.
  void add_page(const toml::table& root, Config& config) {
    for (const auto& [key, node] : root) {
      const bool is_list_of_tables = key.str() == "sensor" || key.str() == kCalibrationTable;
      if (is_list_of_tables && !is_list(node))
        mistake(key.source(), std::string(key.str()),
                fmt::format("is no list; write its heading as [[{}]]", key.str()));
      if (!is_list_of_tables && key.str() != "look" && key.str() != "scene")
        mistake(key.source(), std::string(key.str()),
                "is not for the page; allowed: [[sensor]], [[calibration]], [look], [[scene]]");
    }
    for_each_table(root, kCalibrationTable, kMaxSensors,
                   [&](const toml::table& entry) { read_page_calibration(entry, config); });
    if (std::ranges::all_of(config.sensors, [](const SensorConfig& sensor) { return sensor.origin.empty(); }) &&
        has_sensors(root))
      config.sensors.clear();  // the synthetic one, of a file without any
    std::set<std::string> names;
    for (const SensorConfig& sensor : config.sensors) names.insert(sensor.name);
    read_sensors(root, config, [&](const SensorConfig& sensor, const toml::table& entry) {
      if (!names.insert(sensor.name).second)
        mistake_in(
            entry, "sensor.",
            {std::string(kNameKey), fmt::format("\"{}\" is in use; give this sensor another name", sensor.name)});
      refuse_what_the_page_may_not(sensor, entry);
    });
    if (config.sensors.size() > kMaxSensors)
      mistake(root.source(), "sensor",
              fmt::format("too many with those of the configuration (maximum {})", kMaxSensors));
    config.feeds.osc_query.sensors = services_of(config.sensors);
    if (!mistakes_.empty()) throw ConfigError(mistakes_.text());
  }

 private:
  static bool has_sensors(const toml::table& root) {
    const toml::node* const node = root.get("sensor");
    return node != nullptr && node->is_array_of_tables() && !node->as_array()->empty();
  }

  /// Every [[sensor]]; `check` gets each, with its entry.
  template <class Check>
  void read_sensors(const toml::table& root, Config& config, const Check& check) {
    for_each_entry(root, "sensor", "driver", kMaxSensors, drivers::sensor::driver_table(),
                   [&](SensorConfig sensor, const toml::table& entry) {
                     sensor.origin = place(entry.source());
                     read_tables<SensorConfig>(entry, "sensor.", sensor_tables(), sensor);
                     if (!config.wind.default_length_m) set_gust_length(sensor);
                     check(sensor, entry);
                     config.sensors.push_back(std::move(sensor));
                   });
  }

  /// A calibration of a sensor of the configuration, which counts as long as that has the values that it replaces.
  void read_page_calibration(const toml::table& entry, Config& config) {
    const std::string prefix = std::string(kCalibrationTable) + ".";
    const auto name = entry["sensor"].value<std::string>();
    const toml::table* const replaced = entry["replaces"].as_table();
    if (!name) mistake_in(entry, prefix, {"sensor", "is missing or not a text"});
    if (replaced == nullptr) mistake_in(entry, prefix, {"replaces", "is missing or not a table"});
    if (!name || replaced == nullptr) return;
    const std::string driver_name = (*replaced)["driver"].value_or(std::string());
    const auto* const driver = drivers::sensor::find_driver(driver_name);
    if (driver == nullptr) {
      config.page_calibrations.push_back({.sensor = *name,
                                          .values = "driver = " + toml_value(driver_name),
                                          .why_not = "it is of a driver that this version does not have"});
      return;
    }
    const std::vector<Parameter> keys = page_calibration_keys(*driver);
    const ParameterValues given = read_values(entry, prefix, keys, {"sensor", "replaces"});
    PageCalibration calibration{.sensor = *name, .values = {}, .why_not = {}};
    std::vector<ConfigChange> values;
    for (const Parameter& key : keys) {
      if (!entry.contains(key.name)) continue;
      values.push_back(place_of_page_key(key.name));
      values.back().value = given.all().at(std::string(key.name));
      calibration.values +=
          fmt::format("{}{} = {}", calibration.values.empty() ? "" : ", ", key.name, toml_value(values.back().value));
    }
    const auto sensor = std::ranges::find(config.sensors, *name, &SensorConfig::name);
    if (sensor == config.sensors.end() || sensor->origin.empty()) {
      calibration.why_not = "the configuration has no such sensor";
    } else if (!is_replaced(*sensor, *replaced)) {
      calibration.why_not = "the configuration of this sensor was changed since, and counts";
    } else {
      calibrate(*sensor, values, entry, prefix);
    }
    config.page_calibrations.push_back(std::move(calibration));
  }

  static bool is_replaced(const SensorConfig& sensor, const toml::table& replaced) {
    return std::ranges::all_of(replaced_by_page(sensor), [&](const auto& one) {
      const toml::node* const node = replaced.get(one.first);
      return node != nullptr && tables::parameter_value_of(*node) == one.second;
    });
  }

  void calibrate(SensorConfig& sensor, std::span<const ConfigChange> values, const toml::table& entry,
                 const std::string& prefix) {
    ParameterValues& all = sensor.by_name.at(kCalibrationTable);
    for (const ConfigChange& one : values) (one.table.empty() ? sensor.values : all).set(one.key, one.value);
    const auto table = std::ranges::find(sensor_tables(), kCalibrationTable, &SensorTable::name);
    for (const ParameterError& error : table->fill(sensor, all)) mistake_in(entry, prefix, error);
  }

  void refuse_what_the_page_may_not(const SensorConfig& sensor, const toml::table& entry) {
    if (sensor.driver->plays_recordings)
      mistake_in(entry, "sensor.",
                 {"driver",
                  "\"" + std::string(sensor.driver->name) + "\" is not for the page: write it into the configuration"});
    for (const Parameter& key : sensor.driver->parameters) {
      if (!entry.contains(key.name) || !sensor.values.has(key.name)) continue;
      if (auto refusal = page_refusal(*sensor.driver, key, sensor.values.all().at(std::string(key.name))))
        mistake_in(entry, "sensor.", {std::string(key.name), std::move(*refusal)});
    }
  }

  void mistake(const toml::source_region& where, const std::string& key, const std::string& what) {
    mistakes_.add(where, key, what);
  }

  std::string place(const toml::source_region& where) const { return mistakes_.place(where); }

  /// At a key of a table, or at the table if the key is not given.
  void mistake_in(const toml::table& table, const std::string& prefix, const ParameterError& error) {
    const toml::node* node = table.get(error.name);
    mistake(node != nullptr ? node->source() : table.source(), prefix + error.name, error.message);
  }

  void check_top_level(const toml::table& root) {
    const std::span<const Parameter> values = config_table("").parameters;
    for (const auto& [key, node] : root) {
      const std::string name(key.str());
      if (std::ranges::find(config_lists(), key.str()) != config_lists().end()) {
        if (!is_list(node))
          mistake(key.source(), name, fmt::format("is a single table; write its heading as [[{}]]", name));
      } else if (std::ranges::find(values, key.str(), &Parameter::name) != values.end()) {
        continue;
      } else if (std::ranges::find(config_tables(), key.str(), &ConfigTable::name) == config_tables().end()) {
        mistake(key.source(), name, "is not known here; allowed: " + top_level_names());
      } else if (!node.is_table()) {
        mistake(key.source(), name, fmt::format("is a value; write it as a table, [{}]", name));
      }
    }
  }

  /// The tables of the file or of a [[sensor]], and what they make of it. `prefix` stands before their names.
  template <class Owner>
  void read_tables(const toml::table& around, const std::string& prefix, std::span<const TableOf<Owner>> tables,
                   Owner& owner) {
    for (const TableOf<Owner>& description : tables) {
      if (description.name.empty()) {
        owner.by_name[description.name] = read_top_level(around, description.parameters);
        description.fill(owner, owner.by_name[description.name]);
        continue;
      }
      static const toml::table kNothing;
      const std::string path = prefix + std::string(description.name);
      const toml::node* node = around.get(description.name);
      // By pointer: a copy of a TOML table loses its lines and columns.
      const toml::table* table = node != nullptr ? node->as_table() : nullptr;
      if (node != nullptr && table == nullptr && !prefix.empty())  // otherwise check_top_level() has reported it
        mistake(node->source(), path, "is a value; write it as a table, [" + path + "]");
      const ParameterValues& values = owner.by_name[description.name] =
          read_values(table != nullptr ? *table : kNothing, path + ".", description.parameters, {});
      for (const ParameterError& error : description.fill(owner, values)) {
        const bool is_given = table != nullptr && table->contains(error.name);
        const toml::node& where = is_given ? *table->get(error.name) : node != nullptr ? *node : around;
        mistake(where.source(), path + "." + error.name, error.message);
      }
    }
  }

  /// The values at the file's top; check_top_level() has reported keys that are neither values nor tables.
  ParameterValues read_top_level(const toml::table& root, std::span<const Parameter> parameters) {
    std::set<std::string_view> aside;
    for (const auto& [key, node] : root) aside.insert(key.str());
    for (const Parameter& parameter : parameters) aside.erase(parameter.name);
    return read_values(root, "", parameters, aside);
  }

  /// The values of one table, except the keys in `aside`.
  ParameterValues read_values(const toml::table& table, const std::string& prefix,
                              std::span<const Parameter> parameters, const std::set<std::string_view>& aside,
                              std::span<const scenes::RetiredParameter> retired = {}) {
    std::set<std::string_view> others = aside;
    for (const scenes::RetiredParameter& gone : retired) {
      if (const toml::node* node = table.get(gone.name))
        mistake(node->source(), prefix + std::string(gone.name), std::string(gone.now));
      others.insert(gone.name);
    }
    return tables::read_values(table, prefix, parameters, others, mistakes_);
  }

  /// Every table of a list, of which `most` are allowed.
  template <class Use>
  void for_each_table(const toml::table& root, std::string_view list, std::size_t most, const Use& use) {
    const toml::node* node = root.get(list);
    if (node == nullptr || !is_list(*node)) return;  // check_top_level() has reported it if it is not a list
    for (const toml::table* entry : tables::entries_of(root, list, std::string(list), most, mistakes_)) use(*entry);
  }

  /// Every [[sensor]] or [[scene]]: finds its description by `kind_key`, its name, and its values.
  template <class Description, class Use>
  void for_each_entry(const toml::table& root, std::string_view list, std::string_view kind_key, std::size_t most,
                      std::span<const Description* const> descriptions, const Use& use) {
    const std::string prefix = std::string(list) + ".";
    std::set<std::string> names;
    for_each_table(root, list, most, [&](const toml::table& entry) {
      const Description* description = find_kind(entry, list, kind_key, descriptions);
      if (description == nullptr) return;
      std::string name = tables::read_name(entry, prefix, std::string(description->name), mistakes_);
      if (!names.insert(name).second)
        mistake(entry.source(), prefix + "name",
                fmt::format("\"{}\" is used twice; give each {} a different name", name, list));
      ParameterValues values =
          read_values(entry, prefix, parameters_of(*description), keys_beside(*description), retired_of(*description));
      use(entry_of(std::move(name), *description, std::move(values)), entry);
    });
  }

  static SensorConfig entry_of(std::string name, const drivers::sensor::DriverDescription& driver,
                               ParameterValues values) {
    return {.name = std::move(name), .driver = &driver, .values = std::move(values)};
  }
  static SceneConfig entry_of(std::string name, const scenes::Description& kind, ParameterValues values) {
    return scene_config_of(std::move(name), kind, std::move(values));
  }

  /// Every [[camera]] or [[alert]], which must have a name of its own.
  template <class Use>
  void for_each_named(const toml::table& root, std::string_view list, std::size_t most, const Use& use) {
    const std::string prefix = std::string(list) + ".";
    std::set<std::string> names;
    for_each_table(root, list, most, [&](const toml::table& entry) {
      std::string name = tables::read_name(entry, prefix, {}, mistakes_);
      if (!entry.contains(kNameKey)) {
        mistake_in(entry, prefix, {std::string(kNameKey), fmt::format("is missing; give each {} a name", list)});
      } else if (!name.empty() && !names.insert(name).second) {
        mistake_in(
            entry, prefix,
            {std::string(kNameKey), fmt::format("\"{}\" is used twice; give each {} a different name", name, list)});
      }
      use(std::move(name), entry);
    });
  }

  /// A list of feeds::list_tables(), with the lists below each entry.
  void read_list(const toml::table& root, const feeds::ListTable& list, Config& config) {
    const auto read_entry = [&](std::string name, const toml::table& entry) {
      std::set<std::string_view> aside = {kNameKey};
      for (const feeds::ListTable& below : list.below) aside.insert(below.name);
      feeds::Entry& read = config.lists[list.name].emplace_back();
      read.name = std::move(name);
      read.values = add_entry(list, std::string(list.name), read.name, entry, aside, config);
      for (const feeds::ListTable& below : list.below) {
        const std::string path = fmt::format("{}.{}", list.name, below.name);
        for (const toml::table* table : tables::entries_of(entry, below.name, path, below.max_entries, mistakes_))
          read.below[below.name].push_back(add_entry(below, path, {}, *table, {}, config));
      }
    };
    if (list.needs_name) return for_each_named(root, list.name, list.max_entries, read_entry);
    std::set<std::string> names;
    for_each_table(root, list.name, list.max_entries, [&](const toml::table& entry) {
      const std::string prefix = std::string(list.name) + ".";
      const std::string usual =
          names.empty() ? std::string(list.name) : fmt::format("{} {}", list.name, names.size() + 1);
      std::string name = tables::read_name(entry, prefix, usual, mistakes_);
      if (!names.insert(name).second)
        mistake_in(entry, prefix,
                   {std::string(kNameKey),
                    fmt::format("\"{}\" is used twice; give each {} a different name", name, list.name)});
      read_entry(std::move(name), entry);
    });
  }

  /// Reads one entry and adds what it makes to the configuration.
  ParameterValues add_entry(const feeds::ListTable& list, const std::string& path, const std::string& name,
                            const toml::table& entry, const std::set<std::string_view>& aside, Config& config) {
    ParameterValues values = read_values(entry, path + ".", list.parameters, aside);
    for (const ParameterError& error : list.add(config.feeds, name, values, names_of(config)))
      mistake_in(entry, path + ".", error);
    return values;
  }

  template <class Description>
  const Description* find_kind(const toml::table& entry, std::string_view list, std::string_view kind_key,
                               std::span<const Description* const> descriptions) {
    std::string known;
    const std::optional<std::string> kind = entry[kind_key].value<std::string>();
    for (const Description* description : descriptions) {
      if (kind == description->name) return description;
      known.append(known.empty() ? "\"" : ", \"").append(description->name).append("\"");
    }
    const toml::node* node = entry.get(kind_key);
    mistake(node != nullptr ? node->source() : entry.source(), std::string(list) + "." + std::string(kind_key),
            (kind ? "is \"" + *kind + "\"" : std::string("is missing or not a text")) + "; allowed: one of " + known);
    return nullptr;
  }

  /// The look of a cloth; default values for other scenes.
  look::ClothLook read_cloth(const toml::table& entry, const ParameterValues& values) {
    auto cloth = cloth_look_of(values, folder_);
    if (cloth) return std::move(*cloth);
    for (const ParameterError& error : cloth.error()) mistake_in(entry, "scene.", error);
    return {};
  }

  /// The picture that lies on the ground: that of every scene "ground".
  void read_ground_image(const toml::table& root, Config& config) {
    constexpr const char* kKey = "ground_image";
    const ParameterValues& look = config.by_name.at("look");
    if (!look.has(kKey)) return;
    const auto refuse = [&](const std::string& what) {
      mistake(root["look"][kKey].node()->source(), std::string("look.") + kKey, what);
    };
    const auto is_ground = [](const SceneConfig& scene) { return scene.kind->name == kGroundKind; };
    if (std::ranges::none_of(config.scenes, is_ground)) {
      return refuse("needs a scene that is missing; add [[scene]] with kind = \"ground\"");
    }
    if (!folder_) return;
    const std::string& file = look.text(kKey);
    constexpr look::Color kEarth{92, 78, 60};
    const auto picture = pictures::read_picture(*folder_ / file, kEarth);
    if (!picture) return refuse("\"" + file + "\" " + picture.error().message);
    for (SceneConfig& scene : config.scenes) {
      if (is_ground(scene)) scene.cloth.image = *picture;
    }
  }

  /// A camera, and whether it goes together with the scenes and the other cameras.
  void read_camera(std::string name, const toml::table& entry, Config& config) {
    const std::string prefix = "camera.";
    CameraConfig camera{.name = std::move(name),
                        .values = read_values(entry, prefix, look::camera_parameters(), {kNameKey})};
    auto made = look::camera_of(camera.name, camera.values);
    if (!made) return mistake_in(entry, prefix, made.error());
    camera.camera = std::move(*made);
    for (const CameraConfig& other : config.cameras) {
      if (camera.camera.from_h && other.camera.from_h == camera.camera.from_h)
        mistake_in(
            entry, prefix,
            {"from", "is also the start of the camera \"" + other.name + "\"; give each camera a different time"});
    }
    const std::string& scene = camera.camera.scene;
    if (!scene.empty() && std::ranges::find(config.scenes, scene, &SceneConfig::name) == config.scenes.end()) {
      std::string names;
      for (const SceneConfig& known : config.scenes) {
        names.append(names.empty() ? "\"" : ", \"").append(known.name).append("\"");
      }
      mistake_in(entry, prefix, {"scene", "is \"" + scene + "\"; allowed: the name of a scene: " + names});
    }
    config.cameras.push_back(std::move(camera));
  }

  static void set_clock(Config& config) {
    const auto has_time = [](const CameraConfig& camera) { return camera.camera.from_h.has_value(); };
    if (std::ranges::none_of(config.cameras, has_time)) return;
    // A zone that is not known has been reported with [shaping].
    if (auto clock = LocalClock::of_zone(config.by_name.at("shaping").text("zone"))) config.clock = *clock;
  }

  /// An alert, and whether its sensor is there.
  void read_alert(std::string name, const toml::table& entry, Config& config) {
    const std::string prefix = "alert.";
    auto alert = alert_config_of(std::move(name), read_values(entry, prefix, alert_parameters(), {kNameKey}));
    if (!alert) return mistake_in(entry, prefix, alert.error());
    const std::string& sensor = alert->sensor;
    if (!sensor.empty() && std::ranges::find(config.sensors, sensor, &SensorConfig::name) == config.sensors.end())
      mistake_in(entry, prefix, {"sensor", "is \"" + sensor + "\"; allowed: the name of a [[sensor]] of this file"});
    config.alerts.push_back(std::move(*alert));
  }

  tables::TomlMistakes mistakes_;
  std::optional<std::filesystem::path> folder_;
};

toml::table parsed(std::string_view toml_text, const std::string& source_name) {
  try {
    return tables::parse_toml(toml_text, source_name);
  } catch (const toml::parse_error& error) {
    std::ostringstream line;
    line << source_name << ':' << error.source().begin.line << ':' << error.source().begin.column
         << ": TOML: " << error.description();
    throw ConfigError(line.str());
  }
}

Config parse(std::string_view toml_text, const std::string& source_name,
             const std::optional<std::filesystem::path>& folder) {
  Config config = ConfigReader(source_name, folder).read(parsed(toml_text, source_name));
  if (config.sensors.empty()) config.sensors.push_back(synthetic_sensor());
  return config;
}

}  // namespace

Config default_config() {
  return parse_config("", "");
}

Config parse_config(std::string_view toml_text, const std::string& source_name) {
  return parse(toml_text, source_name, std::nullopt);
}

Config with_page(const Config& config, std::string_view toml_text, const std::string& source_name) {
  Config both = config;
  ConfigReader(source_name, std::nullopt).add_page(parsed(toml_text, source_name), both);
  return both;
}

Config load_config(const std::filesystem::path& file) {
  return parse(read_config_text(file), file.string(), file.parent_path());
}

}  // namespace yuragi::daemon::settings
