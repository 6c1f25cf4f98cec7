#include "daemon/settings/config.hpp"

#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>

#include <toml++/toml.h>

#include "daemon/settings/shaping_parameters.hpp"
#include "daemon/settings/site_octaves.hpp"
#include "drivers/sensor/speed_unit.hpp"
#include "engine/base/address.hpp"

namespace yuragi {
namespace {

constexpr std::string_view kNameKey = "name";
constexpr std::string_view kCalibrationKey = "calibration";
constexpr std::string_view kBlendKey = "blend";
constexpr std::string_view kJudgeKey = "judge";

/// Everything that a [[sensor]] or a [[scene]] of this kind may hold.
std::vector<Parameter> parameters_of(const DriverDescription& driver) {
  return {driver.parameters.begin(), driver.parameters.end()};
}

std::vector<Parameter> parameters_of(const SceneDescription& scene) {
  std::vector<Parameter> all(scene.parameters.begin(), scene.parameters.end());
  const std::span<const Parameter> common = common_scene_parameters();
  all.insert(all.end(), common.begin(), common.end());
  return all;
}

/// And what it held once.
std::span<const RetiredParameter> retired_of(const DriverDescription&) {
  return {};
}
std::span<const RetiredParameter> retired_of(const SceneDescription& scene) {
  return scene.retired;
}

/// A TOML value as a parameter's; nothing for dates, arrays and tables, which no parameter takes.
std::optional<ParameterValue> to_parameter_value(const toml::node& node) {
  if (const auto* flag = node.as_boolean()) return ParameterValue(flag->get());
  if (const auto* whole = node.as_integer()) return ParameterValue(whole->get());
  if (const auto* number = node.as_floating_point()) return ParameterValue(number->get());
  if (const auto* text = node.as_string()) return ParameterValue(text->get());
  return std::nullopt;
}

/// Walks a parsed file and collects every mistake, each at its place.
class ConfigReader {
 public:
  explicit ConfigReader(std::string source_name) : source_name_(std::move(source_name)) {}

  Config read(const toml::table& root) {
    Config config;
    check_top_level(root);
    const ParameterValues general = read_top_level(root);
    config.seed = static_cast<std::uint64_t>(general.integer("seed"));
    config.stream = read_table(root, "", "stream", stream_parameters());
    check_listen(root, config.stream);
    config.animation = read_table(root, "", "animation", animation_parameters());
    config.wind = read_table(root, "", "wind", wind_parameters());
    check_site_octaves(root, config.wind);
    config.shaping = read_table(root, "", "shaping", shaping_parameters());
    check_shaping(root, config.shaping);
    if (const toml::node* node = root["wind"]["fallback_recording"].node()) {
      config.fallback_origin = place(node->source());
    }

    for_each_entry(root, "sensor", "driver", driver_table(),
                   [&](const auto& name, auto* driver, const auto& values, const toml::table& entry) {
                     const ParameterValues calibration =
                         read_table(entry, "sensor.", kCalibrationKey, calibration_parameters());
                     check_is_table(entry, kCalibrationKey);
                     check_curve(entry, calibration);
                     check_is_table(entry, kJudgeKey);
                     const ParameterValues judge = read_table(entry, "sensor.", kJudgeKey, judge_parameters());
                     config.sensors.push_back({name, driver, values, calibration, place(entry.source()), judge});
                     check_is_table(entry, kBlendKey);
                     config.sensors.back().blend = read_table(entry, "sensor.", kBlendKey, sensor_blend_parameters());
                     check_blend(entry, config.sensors.back().blend);
                   });
    for_each_entry(root, "scene", "kind", scene_table(),
                   [&](const auto& name, auto* kind, const auto& values, const auto&) {
                     config.scenes.push_back({name, kind, values});
                   });

    if (!mistakes_.empty()) throw ConfigError(mistakes_);
    const Config defaults = default_config();
    if (config.sensors.empty()) config.sensors = defaults.sensors;
    if (config.scenes.empty()) config.scenes = defaults.scenes;
    return config;
  }

 private:
  void mistake(const toml::source_region& where, const std::string& key, const std::string& what) {
    mistakes_.append(mistakes_.empty() ? "" : "\n")
        .append(place(where))
        .append(": ")
        .append(key)
        .append(": ")
        .append(what);
  }

  std::string place(const toml::source_region& where) const {
    return source_name_ + ':' + std::to_string(where.begin.line) + ':' + std::to_string(where.begin.column);
  }

  void check_top_level(const toml::table& root) {
    for (const auto& [key, node] : root) {
      const bool is_array = key == "sensor" || key == "scene";
      bool known = is_array || key == "seed";
      for (const ConfigTable& table : config_tables()) known = known || table.name == key.str();
      if (!known) {
        mistake(key.source(), std::string(key.str()),
                "is not known here; allowed: seed, [stream], [animation], [wind], [shaping], [[sensor]], [[scene]]");
      } else if (is_array && !(node.is_array_of_tables() || (node.is_array() && node.as_array()->empty()))) {
        mistake(key.source(), std::string(key.str()),
                "is one table; write [[" + std::string(key.str()) + "]] above it");
      } else if (!is_array && key != "seed" && !node.is_table()) {
        mistake(key.source(), std::string(key.str()),
                "is a value; write it as a table, [" + std::string(key.str()) + "]");
      }
    }
  }

  /// The values at the file's top level, among the tables; check_top_level has told of keys that are neither.
  ParameterValues read_top_level(const toml::table& root) {
    std::set<std::string_view> aside;
    for (const auto& [key, node] : root) aside.insert(key.str());
    for (const Parameter& parameter : general_parameters()) aside.erase(parameter.name);
    return read_values(root, "", general_parameters(), aside);
  }

  /// A table that is there once, or not at all.
  ParameterValues read_table(const toml::table& around, const std::string& prefix, std::string_view name,
                             std::span<const Parameter> parameters) {
    static const toml::table kNothing;
    const toml::node* node = around.get(name);
    const toml::table* table = node != nullptr ? node->as_table() : nullptr;
    // By pointer: a copy of a TOML table forgets its lines and columns.
    return read_values(table != nullptr ? *table : kNothing, prefix + std::string(name) + ".", parameters, {});
  }

  void check_is_table(const toml::table& sensor, std::string_view key) {
    if (const toml::node* node = sensor.get(key); node != nullptr && !node->is_table()) {
      const std::string path = "sensor." + std::string(key);
      mistake(node->source(), path, "is a value; write it as a table, [" + path + "]");
    }
  }

  void check_shaping(const toml::table& root, const ParameterValues& shaping) {
    // A mistake that a default takes part in stands at the table.
    for (const ParameterError& error : shaping_mistakes(shaping)) {
      const toml::node* table = root.get("shaping");
      const toml::node* node = table != nullptr && table->is_table() ? table->as_table()->get(error.name) : nullptr;
      const toml::node& place = node != nullptr ? *node : table != nullptr ? *table : root;
      mistake(place.source(), "shaping." + error.name, error.message);
    }
  }

  void check_site_octaves(const toml::table& root, const ParameterValues& wind) {
    if (const auto octaves = parse_site_octaves(wind.text("site_octaves")); !octaves) {
      mistake(root["wind"]["site_octaves"].node()->source(), "wind.site_octaves", octaves.error().message);
    }
  }

  void check_curve(const toml::table& sensor, const ParameterValues& calibration) {
    if (const auto curve = parse_calibration_curve(calibration.text("curve")); !curve) {
      mistake(sensor[kCalibrationKey]["curve"].node()->source(), "sensor.calibration.curve", curve.error().message);
    }
  }

  void check_blend(const toml::table& sensor, const ParameterValues& blend) {
    if (const auto error = sensor_blend_mistake(blend)) {
      mistake(sensor[kBlendKey][error->name].node()->source(), "sensor.blend." + error->name, error->message);
    }
  }

  void check_listen(const toml::table& root, const ParameterValues& stream) {
    if (const auto address = parse_address(stream.text("listen")); !address) {
      mistake(root["stream"]["listen"].node()->source(), "stream.listen", address.error().message);
    }
  }

  /// The values of one table; keys in `aside` are read elsewhere.
  ParameterValues read_values(const toml::table& table, const std::string& prefix,
                              std::span<const Parameter> parameters, const std::set<std::string_view>& aside,
                              std::span<const RetiredParameter> retired = {}) {
    // One key at a time, so that each mistake is told, at its own place.
    ParameterValues::Map good;
    for (const auto& [key, node] : table) {
      if (aside.contains(key.str())) continue;
      const std::optional<ParameterValue> value = to_parameter_value(node);
      if (!value) {
        mistake(node.source(), prefix + std::string(key.str()), "takes one value: true, a number or a text");
        continue;
      }
      const auto gone = std::ranges::find(retired, key.str(), &RetiredParameter::name);
      if (gone != retired.end()) {
        mistake(node.source(), prefix + std::string(key.str()), std::string(gone->now));
        continue;
      }
      const ParameterValues::Map one{{std::string(key.str()), *value}};
      if (auto checked = ParameterValues::resolve(parameters, one); !checked) {
        mistake(node.source(), prefix + checked.error().name, checked.error().message);
      } else {
        good.insert(one.begin(), one.end());
      }
    }
    return ParameterValues::resolve(parameters, good).value();
  }

  /// Every [[sensor]] or [[scene]]: finds its description by `kind_key`, its name, and its values.
  template <class Description, class Use>
  void for_each_entry(const toml::table& root, std::string_view list, std::string_view kind_key,
                      std::span<const Description* const> descriptions, const Use& use) {
    const toml::node* node = root.get(list);
    const toml::array* entries = node != nullptr ? node->as_array() : nullptr;
    if (entries == nullptr) return;
    std::set<std::string> names;
    for (const toml::node& element : *entries) {
      const toml::table* entry = element.as_table();
      if (entry == nullptr) continue;  // check_top_level has told
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
      use(name, description, values, *entry);
    }
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
    const toml::node* node = entry.get(kNameKey);
    if (node == nullptr) return otherwise;
    const auto name = node->value<std::string>();
    if (name && !name->empty() && name->size() <= 64) return *name;
    mistake(node->source(), prefix + "name", "takes a text of 1 to 64 characters");
    return otherwise;
  }

  std::string source_name_;
  std::string mistakes_;
};

template <class Description>
const Description* find_by_name(std::span<const Description* const> table, std::string_view name) {
  for (const Description* description : table) {
    if (description->name == name) return description;
  }
  throw std::logic_error("no " + std::string(name) + " in its table");
}

ParameterValues defaults_of(std::span<const Parameter> parameters) {
  return ParameterValues::resolve(parameters, {}).value();
}

toml::table to_table(const ParameterValues& values) {
  toml::table table;
  for (const auto& [name, value] : values.all()) {
    std::visit([&table, &key = name](const auto& held) { table.insert(key, held); }, value);
  }
  return table;
}

}  // namespace

ParameterValues no_calibration() {
  return defaults_of(calibration_parameters());
}

ParameterValues default_judge() {
  return defaults_of(judge_parameters());
}

std::optional<JudgeSettings> judge_settings_of(const SensorConfig& sensor) {
  constexpr double kAlonePatience = 6.0;
  const ParameterValues& values = sensor.judge;
  if (!values.flag("enabled")) return std::nullopt;
  return JudgeSettings{.max_speed_m_s = values.number("max_speed"),
                       .slew_m_s2 = values.number("slew"),
                       .least_spike_m_s = values.number("spike"),
                       .frozen_s = values.number("frozen"),
                       .seized_s = values.number("seized"),
                       .seized_alone_s = kAlonePatience * values.number("seized")};
}

Calibration calibration_of(const SensorConfig& sensor) {
  const ParameterValues& values = sensor.calibration;
  auto curve = parse_calibration_curve(values.text("curve"));
  if (!curve) throw ConfigError(sensor.origin + ": sensor.calibration.curve: " + curve.error().message);
  Calibration calibration{.unit_m_s = metres_per_second_in(values.text("unit")),
                          .gain = values.number("gain"),
                          .offset_m_s = values.number("offset"),
                          .curve = std::move(*curve),
                          .north_offset_deg = values.number("north_offset")};
  if (const double height_m = values.number("height"); height_m > 0.0) {
    calibration.height_factor = height_factor(height_m, values.number("scene_height"), values.number("roughness"));
  }
  return calibration;
}

Config default_config() {
  Config config;
  config.stream = defaults_of(stream_parameters());
  config.animation = defaults_of(animation_parameters());
  config.wind = defaults_of(wind_parameters());
  config.shaping = defaults_of(shaping_parameters());
  const auto* synthetic = find_by_name(driver_table(), "synthetic");
  config.sensors.push_back({"synthetic", synthetic, defaults_of(parameters_of(*synthetic)), no_calibration(), {}});
  const auto* grass = find_by_name(scene_table(), "grass");
  config.scenes.push_back({"grass", grass, defaults_of(parameters_of(*grass))});
  return config;
}

Config parse_config(std::string_view toml_text, const std::string& source_name) {
  toml::table root;
  try {
    root = toml::parse(toml_text, source_name);
  } catch (const toml::parse_error& error) {
    std::ostringstream line;
    line << source_name << ':' << error.source().begin.line << ':' << error.source().begin.column
         << ": TOML: " << error.description();
    throw ConfigError(line.str());
  }
  return ConfigReader(source_name).read(root);
}

std::string read_config_text(const std::filesystem::path& file) {
  std::ifstream input(file, std::ios::binary);
  if (!input.is_open() || std::filesystem::is_directory(file)) {
    throw ConfigError(file.string() + ":1:1: file: cannot be read; check its path and permissions");
  }
  return {std::istreambuf_iterator<char>(input), {}};
}

Config load_config(const std::filesystem::path& file) {
  return parse_config(read_config_text(file), file.string());
}

std::unique_ptr<Sensor> open_sensor(const SensorConfig& sensor) {
  try {
    return sensor.driver->open(sensor.values);
  } catch (const std::exception& error) {
    throw ConfigError((sensor.origin.empty() ? sensor.name : sensor.origin) + ": sensor: " + error.what());
  }
}

std::string to_toml(const Config& config) {
  toml::table root;
  root.insert("seed", static_cast<std::int64_t>(config.seed));
  root.insert("stream", to_table(config.stream));
  root.insert("animation", to_table(config.animation));
  root.insert("wind", to_table(config.wind));
  root.insert("shaping", to_table(config.shaping));

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
    root["sensor"].as_array()->back().as_table()->insert(kCalibrationKey, to_table(sensor.calibration));
    root["sensor"].as_array()->back().as_table()->insert(kJudgeKey, to_table(sensor.judge));
    root["sensor"].as_array()->back().as_table()->insert(kBlendKey, to_table(sensor.blend));
  }
  for (const SceneConfig& scene : config.scenes) append("scene", "kind", scene.kind->name, scene.name, scene.values);

  std::ostringstream out;
  out << root << '\n';
  return out.str();
}

std::string to_toml(const ParameterValues& values) {
  std::ostringstream out;
  out << to_table(values);
  return out.str();
}

Result<ParameterValues, Failure> parse_values(std::string_view toml_text, std::span<const Parameter> parameters) {
  try {
    ParameterValues::Map given;
    for (const auto& [key, node] : toml::parse(toml_text)) {
      const std::optional<ParameterValue> value = to_parameter_value(node);
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

}  // namespace yuragi
