#include "daemon/settings/config.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <set>
#include <sstream>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <toml++/toml.h>
#include <unistd.h>

#include "daemon/pictures/picture_file.hpp"
#include "daemon/settings/same_device.hpp"
#include "daemon/settings/sensor_blend.hpp"
#include "daemon/settings/shaping_config.hpp"
#include "engine/output/output_tables.hpp"
#include "engine/tables/parse_toml.hpp"
#include "engine/tables/toml_values.hpp"

namespace yuragi::daemon::settings {
namespace {

constexpr std::string_view kNameKey = "name";
constexpr std::string_view kCalibrationKey = "calibration";
constexpr std::string_view kBlendKey = "blend";
constexpr std::string_view kJudgeKey = "judge";
constexpr std::string_view kCameraList = "camera";
constexpr std::string_view kAlertList = "alert";
constexpr std::string_view kGroundKind = "ground";

/// The scenes of a file without any.
std::vector<SceneConfig> default_scenes();

/// All keys of a [[sensor]] or a [[scene]] of this kind.
std::vector<Parameter> parameters_of(const drivers::sensor::DriverDescription& driver) {
  return {driver.parameters.begin(), driver.parameters.end()};
}

std::vector<Parameter> parameters_of(const scenes::SceneDescription& scene) {
  return scene_parameters(scene);
}

/// Its retired keys.
std::span<const scenes::RetiredParameter> retired_of(const drivers::sensor::DriverDescription&) {
  return {};
}
std::span<const scenes::RetiredParameter> retired_of(const scenes::SceneDescription& scene) {
  return scene.retired;
}

/// Reads a parsed file and collects every error with its place.
class ConfigReader {
 public:
  /// Pictures' paths begin at `folder`; without a folder none is read.
  explicit ConfigReader(std::string source_name, std::optional<std::filesystem::path> folder = std::nullopt)
      : mistakes_(std::move(source_name)), folder_(std::move(folder)) {}

  Config read(const toml::table& root) {
    Config config;
    check_top_level(root);
    const ParameterValues general = read_top_level(root);
    config.seed = static_cast<std::uint64_t>(general.integer("seed"));
    config.by_name.stream = read_table(root, "", "stream", stream_parameters());
    config.stream = typed(root, "", "stream", stream_config_of(config.by_name.stream));
    config.by_name.http = read_table(root, "", "http", http_parameters());
    config.http = typed(root, "", "http", http_config_of(config.by_name.http));
    config.by_name.recording = read_table(root, "", "recording", recording_parameters());
    config.recording = recording_config_of(config.by_name.recording);
    config.by_name.animation = read_table(root, "", "animation", animation_parameters());
    config.animation = animation_config_of(config.by_name.animation);
    config.by_name.wind = read_table(root, "", "wind", wind_parameters());
    config.wind = typed(root, "", "wind", wind_config_of(config.by_name.wind));
    if (config.wind.fallback) config.wind.fallback->origin = place(root["wind"]["fallback_recording"].node()->source());
    config.by_name.shaping = read_table(root, "", "shaping", shaping_parameters());
    config.shaping = typed(root, "", "shaping", shaping_config_of(config.by_name.shaping, config.wind));
    config.by_name.look = read_table(root, "", "look", look::look_parameters());
    config.look = typed(root, "", "look", look::look_of(config.by_name.look));
    config.by_name.log = read_table(root, "", "log", log_parameters());
    config.log = log_config_of(config.by_name.log);

    for_each_entry(root, "sensor", "driver", kMostSensors, drivers::sensor::driver_table(),
                   [&](const std::string& name, const drivers::sensor::DriverDescription& driver,
                       const ParameterValues& values, const toml::table& entry) {
                     config.sensors.push_back(read_sensor(entry, name, driver, values, config.wind));
                     config.sensors.back().origin = place(entry.source());
                   });
    for_each_entry(root, "scene", "kind", kMostScenes, scenes::scene_table(),
                   [&](const std::string& name, const scenes::SceneDescription& kind, const ParameterValues& values,
                       const toml::table& entry) {
                     config.scenes.push_back(scene_config_of(name, kind, values));
                     config.scenes.back().cloth = read_cloth(entry, values);
                   });
    if (config.scenes.empty()) config.scenes = default_scenes();
    read_ground_image(root, config);
    read_cameras(root, config);
    read_alerts(root, config);
    config.outputs = output::read_outputs(root, mistakes_);

    if (!mistakes_.empty()) throw ConfigError(mistakes_.text());
    return config;
  }

  /// The tables of every sensor.
  SensorConfig read_sensor(const toml::table& entry, std::string name, const drivers::sensor::DriverDescription& driver,
                           ParameterValues values, const WindConfig& wind) {
    SensorConfig sensor{.name = std::move(name), .driver = &driver, .values = std::move(values)};
    SensorTables& tables = sensor.by_name;
    tables.calibration = read_sensor_table(entry, kCalibrationKey, calibration_parameters());
    sensor.calibration = typed(entry, "sensor.", kCalibrationKey, calibration_of(tables.calibration));
    sensor.heights = sensor_heights_of(tables.calibration);
    tables.judge = read_sensor_table(entry, kJudgeKey, judge_parameters());
    sensor.judge = judge_settings_of(tables.judge);
    sensor.is_compared = is_compared(tables.judge);
    tables.blend = read_sensor_table(entry, kBlendKey, sensor_blend_parameters());
    sensor.blend = typed(entry, "sensor.", kBlendKey, blend_source_of(tables.blend, driver));
    set_value(sensor, driver.stated_value != nullptr ? driver.stated_value(sensor.values) : std::nullopt);
    if (driver.unchanged_for_s != nullptr) sensor.blend.unchanged_for_s = driver.unchanged_for_s(sensor.values);
    if (sensor.heights.sensor_m && !wind.default_length_m) {
      sensor.blend.length_m = gust_length_at_height_m(*sensor.heights.sensor_m, sensor.calibration);
    }
    return sensor;
  }

  /// The picture that lies on the ground: that of every scene "ground".
  void read_ground_image(const toml::table& root, Config& config) {
    constexpr const char* kKey = "ground_image";
    if (!config.by_name.look.has(kKey)) return;
    const auto refuse = [&](const std::string& what) {
      mistake(root["look"][kKey].node()->source(), std::string("look.") + kKey, what);
    };
    const auto is_ground = [](const SceneConfig& scene) { return scene.kind->name == kGroundKind; };
    if (std::ranges::none_of(config.scenes, is_ground)) {
      return refuse("is for a scene that is not there; add [[scene]] with kind = \"ground\"");
    }
    if (!folder_) return;
    const std::string& file = config.by_name.look.text(kKey);
    constexpr look::Color kEarth{92, 78, 60};
    const auto picture = pictures::read_picture(*folder_ / file, kEarth);
    if (!picture) return refuse("\"" + file + "\" " + picture.error().message);
    for (SceneConfig& scene : config.scenes) {
      if (is_ground(scene)) scene.cloth.image = *picture;
    }
  }

  /// What a cloth looks like; of other scenes nothing.
  look::ClothLook read_cloth(const toml::table& entry, const ParameterValues& values) {
    auto cloth = cloth_look_of(values, folder_);
    if (cloth) return std::move(*cloth);
    for (const ParameterError& error : cloth.error()) {
      const toml::node* node = entry.get(error.name);
      mistake(node != nullptr ? node->source() : entry.source(), "scene." + error.name, error.message);
    }
    return {};
  }

 private:
  void mistake(const toml::source_region& where, const std::string& key, const std::string& what) {
    mistakes_.add(where, key, what);
  }

  std::string place(const toml::source_region& where) const { return mistakes_.place(where); }

  void check_top_level(const toml::table& root) {
    for (const auto& [key, node] : root) {
      const bool is_array =
          key == "sensor" || key == "scene" || key == kCameraList || key == kAlertList || key == output::kOutputList;
      bool known = is_array || key == "seed";
      for (const ConfigTable& table : config_tables()) known = known || table.name == key.str();
      if (!known) {
        mistake(
            key.source(), std::string(key.str()),
            "is not known here; allowed: seed, [stream], [http], [recording], [animation], [wind], [shaping], [look], "
            "[log], [[sensor]], [[scene]], [[camera]], [[alert]], [[output]]");
      } else if (is_array && !(node.is_array_of_tables() || (node.is_array() && node.as_array()->empty()))) {
        mistake(key.source(), std::string(key.str()),
                "is one table; write [[" + std::string(key.str()) + "]] above it");
      } else if (!is_array && key != "seed" && !node.is_table()) {
        mistake(key.source(), std::string(key.str()),
                "is a value; write it as a table, [" + std::string(key.str()) + "]");
      }
    }
  }

  /// The values at the file's top level; check_top_level() has reported keys that are neither values nor tables.
  ParameterValues read_top_level(const toml::table& root) {
    std::set<std::string_view> aside;
    for (const auto& [key, node] : root) aside.insert(key.str());
    for (const Parameter& parameter : general_parameters()) aside.erase(parameter.name);
    return read_values(root, "", general_parameters(), aside);
  }

  /// An optional table that may occur once.
  ParameterValues read_table(const toml::table& around, const std::string& prefix, std::string_view name,
                             std::span<const Parameter> parameters) {
    static const toml::table kNothing;
    const toml::node* node = around.get(name);
    const toml::table* table = node != nullptr ? node->as_table() : nullptr;
    // By pointer: a copy of a TOML table loses its lines and columns.
    return read_values(table != nullptr ? *table : kNothing, prefix + std::string(name) + ".", parameters, {});
  }

  ParameterValues read_sensor_table(const toml::table& entry, std::string_view name,
                                    std::span<const Parameter> parameters) {
    if (const toml::node* node = entry.get(name); node != nullptr && !node->is_table()) {
      const std::string path = "sensor." + std::string(name);
      mistake(node->source(), path, "is a value; write it as a table, [" + path + "]");
    }
    return read_table(entry, "sensor.", name, parameters);
  }

  /// Converts the values of a table; reports each contradiction at its key.
  template <class Type, class Error>
  Type typed(const toml::table& around, const std::string& prefix, std::string_view name, Result<Type, Error> made) {
    if (made) return std::move(*made);
    add_error(around, prefix, name, made.error());
    return {};
  }

  void add_error(const toml::table& around, const std::string& prefix, std::string_view name,
                 const std::vector<ParameterError>& errors) {
    for (const ParameterError& error : errors) add_error(around, prefix, name, error);
  }

  /// An error at a key, or at the table where the key is left to its default.
  void add_error(const toml::table& around, const std::string& prefix, std::string_view name,
                 const ParameterError& error) {
    const toml::node* node = around.get(name);
    const toml::table* table = node != nullptr ? node->as_table() : nullptr;
    const toml::node* value = table != nullptr ? table->get(error.name) : nullptr;
    const toml::node& where = value != nullptr ? *value : node != nullptr ? *node : around;
    mistake(where.source(), prefix + std::string(name) + "." + error.name, error.message);
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

  /// Every [[sensor]] or [[scene]], of which `most` are allowed: finds its description by `kind_key`, its name, and its
  /// values.
  template <class Description, class Use>
  void for_each_entry(const toml::table& root, std::string_view list, std::string_view kind_key, std::size_t most,
                      std::span<const Description* const> descriptions, const Use& use) {
    const toml::node* node = root.get(list);
    const toml::array* entries = node != nullptr ? node->as_array() : nullptr;
    if (entries == nullptr) return;
    if (entries->size() > most) {
      mistake(entries->get(most)->source(), std::string(list),
              "is one of " + std::to_string(entries->size()) + "; allowed: at most " + std::to_string(most));
      return;
    }
    std::set<std::string> names;
    for (const toml::node& element : *entries) {
      const toml::table* entry = element.as_table();
      if (entry == nullptr) continue;  // reported by check_top_level()
      const Description* description = find_kind(*entry, list, kind_key, descriptions);
      if (description == nullptr) continue;

      const std::string prefix = std::string(list) + ".";
      std::string name = read_name(*entry, prefix, std::string(description->name));
      if (!names.insert(name).second) {
        mistake(entry->source(), prefix + "name",
                "\"" + name + "\" is used twice; give each " + std::string(list) + " a name");
      }
      std::set<std::string_view> aside = {kNameKey, kind_key};
      if (list == "sensor") aside.insert(kCalibrationKey);
      if (list == "sensor") aside.insert(kJudgeKey);
      if (list == "sensor") aside.insert(kBlendKey);
      const ParameterValues values =
          read_values(*entry, prefix, parameters_of(*description), aside, retired_of(*description));
      use(name, *description, values, *entry);
    }
  }

  /// Every [[camera]]: its name, its values, and whether they go together with the scenes and the other cameras.
  void read_cameras(const toml::table& root, Config& config) {
    const toml::node* node = root.get(kCameraList);
    const toml::array* entries = node != nullptr ? node->as_array() : nullptr;
    if (entries == nullptr) return;
    if (entries->size() > look::kMostCameras) {
      mistake(entries->get(look::kMostCameras)->source(), std::string(kCameraList),
              fmt::format("is one of {}; allowed: at most {}", entries->size(), look::kMostCameras));
      return;
    }
    for (const toml::node& element : *entries) {
      // By pointer: a copy of a TOML table loses its lines and columns.
      if (const toml::table* entry = element.as_table()) read_camera(*entry, config);
    }
    const auto has_time = [](const CameraConfig& camera) { return camera.camera.from_h.has_value(); };
    if (std::ranges::any_of(config.cameras, has_time)) {
      // A zone that is not known has been reported with [shaping].
      if (auto clock = LocalClock::of_zone(config.by_name.shaping.text("zone"))) config.clock = *clock;
    }
  }

  void read_camera(const toml::table& entry, Config& config) {
    const std::string prefix = std::string(kCameraList) + ".";
    CameraConfig camera{.name = read_name(entry, prefix, {})};
    if (!entry.contains(kNameKey)) mistake(entry.source(), prefix + "name", "is missing; give each camera a name");
    camera.values = read_values(entry, prefix, look::camera_parameters(), {kNameKey});
    const auto mistake_at = [&](std::string_view key, const std::string& what) {
      const toml::node* at = entry.get(key);
      mistake(at != nullptr ? at->source() : entry.source(), prefix + std::string(key), what);
    };
    auto made = look::camera_of(camera.name, camera.values);
    if (!made) return mistake_at(made.error().name, made.error().message);
    camera.camera = std::move(*made);

    for (const CameraConfig& other : config.cameras) {
      if (!camera.name.empty() && other.name == camera.name) {
        mistake_at(kNameKey, "\"" + camera.name + "\" is used twice; give each camera a name");
      }
      if (camera.camera.from_h && other.camera.from_h == camera.camera.from_h) {
        mistake_at("from", "is that of the camera \"" + other.name + "\", too; only one can be on");
      }
    }
    const std::string& scene = camera.camera.scene;
    if (!scene.empty() && std::ranges::find(config.scenes, scene, &SceneConfig::name) == config.scenes.end()) {
      std::string names;
      for (const SceneConfig& known : config.scenes) {
        names.append(names.empty() ? "\"" : ", \"").append(known.name).append("\"");
      }
      mistake_at("scene", "is \"" + scene + "\"; allowed: the name of a scene: " + names);
    }
    config.cameras.push_back(std::move(camera));
  }

  /// Every [[alert]]: its name, its values, and whether its sensor is there.
  void read_alerts(const toml::table& root, Config& config) {
    const toml::node* node = root.get(kAlertList);
    const toml::array* entries = node != nullptr ? node->as_array() : nullptr;
    if (entries == nullptr) return;
    if (entries->size() > kMostAlerts) {
      mistake(entries->get(kMostAlerts)->source(), std::string(kAlertList),
              fmt::format("is one of {}; allowed: at most {}", entries->size(), kMostAlerts));
      return;
    }
    for (const toml::node& element : *entries) {
      // By pointer: a copy of a TOML table loses its lines and columns.
      if (const toml::table* entry = element.as_table()) read_alert(*entry, config);
    }
  }

  void read_alert(const toml::table& entry, Config& config) {
    const std::string prefix = std::string(kAlertList) + ".";
    const auto mistake_at = [&](std::string_view key, const std::string& what) {
      const toml::node* at = entry.get(key);
      mistake(at != nullptr ? at->source() : entry.source(), prefix + std::string(key), what);
    };
    const std::string name = read_name(entry, prefix, {});
    if (!entry.contains(kNameKey)) mistake_at(kNameKey, "is missing; give each alert a name");
    auto alert = alert_config_of(name, read_values(entry, prefix, alert_parameters(), {kNameKey}));
    if (!alert) return mistake_at(alert.error().name, alert.error().message);
    if (!name.empty() && std::ranges::find(config.alerts, name, &AlertConfig::name) != config.alerts.end()) {
      mistake_at(kNameKey, "\"" + name + "\" is used twice; give each alert a name");
    }
    const std::string& sensor = alert->sensor;
    if (!sensor.empty() && std::ranges::find(config.sensors, sensor, &SensorConfig::name) == config.sensors.end()) {
      mistake_at("sensor", "is \"" + sensor + "\"; allowed: the name of a [[sensor]] of this file");
    }
    config.alerts.push_back(std::move(*alert));
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

  std::string read_name(const toml::table& entry, const std::string& prefix, std::string otherwise) {
    return tables::read_name(entry, prefix, std::move(otherwise), mistakes_);
  }

  tables::TomlMistakes mistakes_;
  std::optional<std::filesystem::path> folder_;
};

template <class Description>
const Description& description_named(std::span<const Description* const> table, std::string_view name) {
  for (const Description* description : table) {
    if (description->name == name) return *description;
  }
  throw std::logic_error("no " + std::string(name) + " in its table");
}

template <class Description>
ParameterValues defaults_of(const Description& description) {
  return ParameterValues::resolve(parameters_of(description), {}).value();
}

// The sensor and the scenes of a file without any.
SensorConfig synthetic_sensor() {
  const drivers::sensor::DriverDescription& synthetic = description_named(drivers::sensor::driver_table(), "synthetic");
  return default_sensor(std::string(synthetic.name), synthetic, defaults_of(synthetic));
}
SceneConfig default_scene(std::string_view kind) {
  const scenes::SceneDescription& scene = description_named(scenes::scene_table(), kind);
  return scene_config_of(std::string(scene.name), scene, defaults_of(scene));
}
std::vector<SceneConfig> default_scenes() {
  return {default_scene("grass"), default_scene("ground")};
}

toml::table to_table(const ParameterValues& values) {
  toml::table table;
  for (const auto& [name, value] : values.all()) {
    std::visit([&table, &key = name](const auto& held) { table.insert(key, held); }, printable(value));
  }
  return table;
}

}  // namespace

Config default_config() {
  return parse_config("", "");
}

SensorConfig default_sensor(std::string name, const drivers::sensor::DriverDescription& driver, ParameterValues values,
                            std::string origin) {
  SensorConfig sensor = ConfigReader("").read_sensor({}, std::move(name), driver, std::move(values), {});
  sensor.origin = std::move(origin);
  return sensor;
}

Config listening_at(Config config, const std::string& address) {
  config.stream.listen = address;
  config.by_name.stream.set("listen", address);
  return config;
}

namespace {

Config read_config(std::string_view toml_text, const std::string& source_name,
                   const std::optional<std::filesystem::path>& folder) {
  toml::table root;
  try {
    root = tables::parse_toml(toml_text, source_name);
  } catch (const toml::parse_error& error) {
    std::ostringstream line;
    line << source_name << ':' << error.source().begin.line << ':' << error.source().begin.column
         << ": TOML: " << error.description();
    throw ConfigError(line.str());
  }
  Config config = ConfigReader(source_name, folder).read(root);
  if (config.sensors.empty()) config.sensors.push_back(synthetic_sensor());
  return config;
}

}  // namespace

Config parse_config(std::string_view toml_text, const std::string& source_name) {
  return read_config(toml_text, source_name, std::nullopt);
}

std::string read_config_text(const std::filesystem::path& file) {
  const auto refuse = [&file](const std::string& why) { return ConfigError(file.string() + ":1:1: file: " + why); };
  // Without waiting for somebody who writes into a pipe.
  const int descriptor = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) throw refuse("cannot be read; check its path and permissions");
  const std::unique_ptr<const int, void (*)(const int*)> closed(&descriptor, [](const int* one) { close(*one); });

  struct stat status {};
  if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    throw refuse("cannot be read; it is no regular file, but a folder, a pipe or a device");
  }
  std::string text(kLargestConfig_bytes + 1, '\0');
  std::size_t length = 0;
  while (length < text.size()) {
    const ssize_t count = read(descriptor, text.data() + length, text.size() - length);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw refuse(std::string("cannot be read: ") + std::strerror(errno));
    if (count == 0) break;
    length += static_cast<std::size_t>(count);
  }
  if (length > kLargestConfig_bytes) throw refuse("is too large; allowed: up to 1 MB");
  text.resize(length);
  return text;
}

Config load_config(const std::filesystem::path& file) {
  return read_config(read_config_text(file), file.string(), file.parent_path());
}

namespace {

ConfigError cannot_open(const SensorConfig& sensor, const std::exception& why) {
  return ConfigError(place_of(sensor) + ": sensor: " + why.what());
}

}  // namespace

std::unique_ptr<drivers::sensor::Sensor> open_sensor(const SensorConfig& sensor) {
  try {
    return sensor.stand_in ? sensor.stand_in->open() : sensor.driver->open(sensor.values);
  } catch (const std::exception& error) {
    throw cannot_open(sensor, error);
  }
}

void check_sensor(const SensorConfig& sensor) {
  try {
    sensor.driver->open(sensor.values);
  } catch (const drivers::sensor::LineInUse&) {
    return;  // by what runs until the restart
  } catch (const std::exception& error) {
    throw cannot_open(sensor, error);
  }
}

std::vector<std::unique_ptr<drivers::sensor::Sensor>> open_sensors(std::span<const SensorConfig> sensors) {
  std::vector<std::unique_ptr<drivers::sensor::Sensor>> opened;
  opened.reserve(sensors.size());
  for (const SensorConfig& sensor : sensors) opened.push_back(open_sensor(sensor));
  refuse_same_device(sensors);
  return opened;
}

std::string to_toml(const Config& config) {
  toml::table root;
  root.insert("seed", static_cast<std::int64_t>(config.seed));
  root.insert("stream", to_table(config.by_name.stream));
  root.insert("http", to_table(config.by_name.http));
  root.insert("recording", to_table(config.by_name.recording));
  root.insert("animation", to_table(config.by_name.animation));
  root.insert("wind", to_table(config.by_name.wind));
  root.insert("shaping", to_table(config.by_name.shaping));
  root.insert("look", to_table(config.by_name.look));
  root.insert("log", to_table(config.by_name.log));

  const auto append = [&root](const char* list, const char* kind_key, std::string_view kind, const std::string& name,
                              const ParameterValues& values) {
    toml::table entry = to_table(values);
    entry.insert_or_assign(kNameKey, name);
    entry.insert_or_assign(kind_key, kind);
    if (!root.contains(list)) root.insert(list, toml::array{});
    root[list].as_array()->push_back(std::move(entry));
  };
  for (const SensorConfig& sensor : config.sensors) {
    append("sensor", "driver", sensor.driver->name, sensor.name, sensor.values);
    root["sensor"].as_array()->back().as_table()->insert(kCalibrationKey, to_table(sensor.by_name.calibration));
    root["sensor"].as_array()->back().as_table()->insert(kJudgeKey, to_table(sensor.by_name.judge));
    root["sensor"].as_array()->back().as_table()->insert(kBlendKey, to_table(sensor.by_name.blend));
  }
  for (const SceneConfig& scene : config.scenes) append("scene", "kind", scene.kind->name, scene.name, scene.values);

  toml::array cameras;
  for (const CameraConfig& camera : config.cameras) {
    toml::table entry = to_table(camera.values);
    entry.insert_or_assign(kNameKey, camera.name);
    cameras.push_back(std::move(entry));
  }
  if (!cameras.empty()) root.insert(kCameraList, std::move(cameras));

  toml::array alerts;
  for (const AlertConfig& alert : config.alerts) {
    toml::table entry = to_table(alert.values);
    entry.insert_or_assign(kNameKey, alert.name);
    alerts.push_back(std::move(entry));
  }
  if (!alerts.empty()) root.insert(kAlertList, std::move(alerts));

  toml::array outputs;
  for (const output::OutputTable& output : config.outputs) {
    toml::table entry = to_table(output.values);
    entry.insert_or_assign(kNameKey, output.output.name);
    toml::array windows;
    for (const ParameterValues& window : output.windows) windows.push_back(to_table(window));
    if (!windows.empty()) entry.insert(output::kWindowList, std::move(windows));
    outputs.push_back(std::move(entry));
  }
  if (!outputs.empty()) root.insert(output::kOutputList, std::move(outputs));

  std::ostringstream out;
  out << root << '\n';
  return out.str();
}

std::string to_recorded_toml(Config config) {
  if (!config.shaping.hours.is_always_open()) config.by_name.shaping.set("zone", config.shaping.hours.zone_name());
  return to_toml(config);
}

std::string to_toml(const ParameterValues& values) {
  std::ostringstream out;
  out << to_table(values);
  return out.str();
}

Result<ParameterValues, Failure> parse_values(std::string_view toml_text, std::span<const Parameter> parameters) {
  try {
    ParameterValues::Map given;
    for (const auto& [key, node] : tables::parse_toml(toml_text)) {
      const std::optional<ParameterValue> value = tables::parameter_value_of(node);
      if (!value) return Failure{std::string(key.str()) + ": takes one value: true, a number or a text"};
      given.emplace(key.str(), *value);
    }
    auto values = ParameterValues::resolve(parameters, given);
    if (!values) return Failure{values.error().name + ": " + values.error().message};
    return std::move(*values);
  } catch (const toml::parse_error& error) {
    return Failure{"TOML: " + std::string(error.description())};
  }
}

}  // namespace yuragi::daemon::settings
