#include "drivers/mqtt/home_assistant.hpp"

#include <algorithm>
#include <optional>
#include <regex>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "drivers/mqtt/mqtt_payload.hpp"
#include "drivers/mqtt/mqtt_preset.hpp"
#include "engine/base/json_text.hpp"
#include "engine/base/printable_text.hpp"

namespace yuragi::drivers::mqtt {
namespace {

using Announcement = nlohmann::json;

/// Longer texts are not names or topics, and would fill the list.
constexpr std::size_t kMaxAnnouncedText = 200;

/// The text under that key, or under its abbreviation; empty if there is none, or no printable one.
std::string text_of(const Announcement& announcement, const char* key, const char* abbreviation) {
  for (const char* const name : {key, abbreviation}) {
    const auto found = announcement.find(name);
    if (found == announcement.end() || !found->is_string()) continue;
    const auto& text = found->get_ref<const std::string&>();
    std::string shown = text;
    make_printable(shown);
    if (text.size() <= kMaxAnnouncedText && shown == text) return text;
  }
  return "";
}

/// The object under that key, or under its abbreviation; an empty one if there is none.
Announcement object_of(const Announcement& announcement, const char* key, const char* abbreviation) {
  for (const char* const name : {key, abbreviation}) {
    const auto found = announcement.find(name);
    if (found != announcement.end() && found->is_object()) return *found;
  }
  return Announcement::object();
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  });
  return text;
}

bool says(const std::string& text, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(words, [&](std::string_view word) { return text.find(word) != std::string::npos; });
}

/// Speed, direction, gust, or nothing about the wind. `label` is all that names the value, in lower case.
std::optional<AnnouncedKind> kind_of(const std::string& device_class, const std::string& unit,
                                     const std::string& label) {
  const bool is_of_wind = says(label, {"wind"});
  if (device_class == "wind_direction" || (is_of_wind && unit == "\u00b0")) return AnnouncedKind::kDirection;
  if (device_class != "wind_speed" && !(is_of_wind && !speed_unit_of_word(unit).empty())) return std::nullopt;
  return says(label, {"gust", "max"}) ? AnnouncedKind::kGust : AnnouncedKind::kSpeed;
}

/// Returns where a template takes the value from, as a JSON pointer; nullopt for one that does more than that. Rounding
/// and conversion to a number are accepted.
std::optional<std::string> pointer_of_template(const std::string& text) {
  static const std::regex kPath(
      R"(^\{\{\s*(value|value_json((?:\.[A-Za-z_]\w*|\[\s*(?:'[^'\]]+'|"[^"\]]+"|\d+)\s*\])+))\s*)"
      R"((?:\|\s*(?:float|int|round)(?:\([^()]*\))?\s*)*\}\}\s*$)");
  static const std::regex kStep(R"re(\.([A-Za-z_]\w*)|\[\s*(?:'([^'\]]+)'|"([^"\]]+)"|(\d+))\s*\])re");
  if (text.empty()) return "";
  std::smatch match;
  if (!std::regex_match(text, match, kPath)) return std::nullopt;
  const std::string path = match[2];
  std::string pointer;
  for (std::sregex_iterator step(path.begin(), path.end(), kStep); step != std::sregex_iterator(); ++step) {
    for (std::size_t group = 1; group < step->size(); ++group) {
      if (!(*step)[group].matched) continue;
      pointer += '/';
      for (const char letter : (*step)[group].str())
        pointer += letter == '~' ? "~0" : letter == '/' ? "~1" : std::string(1, letter);
    }
  }
  return pointer;
}

/// "~" at either end of a topic stands for the announcement's base.
std::string with_base(std::string topic, const std::string& base) {
  if (topic.starts_with('~')) return base + topic.substr(1);
  if (topic.ends_with('~')) return topic.substr(0, topic.size() - 1) + base;
  return topic;
}

/// Returns the value that an announcement describes for `sensor`, which is all of it or one of its components.
std::optional<AnnouncedValue> value_of(const Announcement& all, const Announcement& sensor, const std::string& path) {
  const auto text = [&](const char* key, const char* abbreviation) {
    const std::string own = text_of(sensor, key, abbreviation);
    return own.empty() ? text_of(all, key, abbreviation) : own;
  };
  const std::string unit = text_of(sensor, "unit_of_measurement", "unit_of_meas");
  const std::string name = text_of(sensor, "name", "name");
  const std::size_t last_step = path.rfind('/');
  const std::string label = lower_case(path.substr(last_step) + " " + name);
  const auto kind = kind_of(text_of(sensor, "device_class", "dev_cla"), unit, label);
  if (!kind) return std::nullopt;

  const Announcement device = object_of(all, "device", "dev");
  const std::string device_name = text_of(device, "name", "name");
  const auto identifiers = device.find(device.contains("identifiers") ? "identifiers" : "ids");
  AnnouncedValue value;
  value.kind = *kind;
  value.device = identifiers != device.end() ? json_text(*identifiers)
                 : !device_name.empty()      ? device_name
                                             : path.substr(0, last_step);
  value.name = fmt::format("{}{}{} ({})", device_name, device_name.empty() || name.empty() ? "" : ", ", name, path);
  value.topic = with_base(text("state_topic", "stat_t"), text_of(all, "~", "~"));
  const std::string value_template = text_of(sensor, "value_template", "val_tpl");
  const auto pointer = pointer_of_template(value_template);
  value.pointer = pointer.value_or("");
  value.unit = speed_unit_of_word(unit);
  if (value.topic.empty() || value.topic.find_first_of("+#") != std::string::npos) {
    value.trouble = "it names no topic that can be read";
  } else if (!pointer) {
    value.trouble = fmt::format("its value uses a template that is not supported: {}", value_template);
  } else if (*kind != AnnouncedKind::kDirection && value.unit.empty()) {
    value.trouble = fmt::format("its unit \"{}\" is not one of m/s, km/h, kn, mph, ft/s", unit);
  }
  return value;
}

/// One of the kind that can be read, of the same device as the speed, and in its unit.
const AnnouncedValue* companion_of(const AnnouncedValue& speed, AnnouncedKind kind,
                                   std::span<const AnnouncedValue> values) {
  const auto found = std::ranges::find_if(values, [&](const AnnouncedValue& each) {
    const bool shares_unit = kind == AnnouncedKind::kDirection || each.unit == speed.unit;
    const bool is_same_place = each.topic == speed.topic && each.pointer == speed.pointer;
    return each.kind == kind && each.device == speed.device && each.trouble.empty() && shares_unit && !is_same_place;
  });
  return found == values.end() ? nullptr : &*found;
}

std::string lines_of(const AnnouncedValue& value, std::string_view topic_key, std::string_view path_key) {
  std::string lines = fmt::format("{} = {}\n", topic_key, quoted_for_toml(value.topic));
  if (!value.pointer.empty()) lines += fmt::format("{} = {}\n", path_key, quoted_for_toml(value.pointer));
  return lines;
}

}  // namespace

std::string quoted_for_toml(const std::string& text) {
  // TOML can read strings that JSON writes in quotes; invalid UTF-8 is replaced.
  std::string printable = text;
  make_printable(printable);
  return json_text(nlohmann::json(printable));
}

std::vector<AnnouncedValue> announced_in(std::string_view topic, std::string_view payload) {
  constexpr std::string_view kSuffix = "/config";
  if (!topic.ends_with(kSuffix)) return {};
  std::string path(topic.substr(0, topic.size() - kSuffix.size()));
  make_printable(path);
  const Payload parsed(payload);
  const Announcement& announcement = parsed.json();
  if (!announcement.is_object()) return {};

  std::vector<AnnouncedValue> values;
  if (path.find("/sensor/") != std::string::npos) {
    if (auto value = value_of(announcement, announcement, path)) values.push_back(std::move(*value));
  } else if (path.find("/device/") != std::string::npos) {
    const Announcement components = object_of(announcement, "components", "cmps");
    for (const auto& [key, component] : components.items()) {
      if (!component.is_object() || text_of(component, "platform", "p") != "sensor") continue;
      std::string component_path = fmt::format("{}/{}", path, key);
      make_printable(component_path);
      if (auto value = value_of(announcement, component, component_path)) values.push_back(std::move(*value));
    }
  }
  return values;
}

std::vector<sensor::FoundDevice> announced_anemometers(std::span<const AnnouncedValue> values,
                                                       const std::string& broker) {
  std::vector<sensor::FoundDevice> found;
  for (const AnnouncedValue& speed : values) {
    if (speed.kind != AnnouncedKind::kSpeed) continue;
    sensor::FoundDevice& device = found.emplace_back();
    device.what = speed.name;
    if (!speed.trouble.empty()) {
      device.trouble = speed.trouble;
      device.remedy = "write topic, speed_path and speed_unit by hand: `yuragi sensors describe mqtt`";
      continue;
    }
    device.settings = broker + lines_of(speed, "topic", "speed_path");
    if (const auto* const direction = companion_of(speed, AnnouncedKind::kDirection, values))
      device.settings += lines_of(*direction, "direction_topic", "direction_path");
    if (const auto* const gust = companion_of(speed, AnnouncedKind::kGust, values))
      device.settings += lines_of(*gust, "gust_topic", "gust_path");
    device.settings += fmt::format("speed_unit = {}\n", quoted_for_toml(speed.unit));
  }
  return found;
}

}  // namespace yuragi::drivers::mqtt
