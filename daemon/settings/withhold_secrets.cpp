#include "daemon/settings/withhold_secrets.hpp"

#include <algorithm>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "daemon/settings/config.hpp"
#include "daemon/settings/config_edit.hpp"
#include "daemon/settings/toml_places.hpp"
#include "drivers/sensor/driver.hpp"
#include "engine/tables/parse_toml.hpp"

namespace yuragi::daemon::settings {
namespace {

using Keys = std::vector<std::string_view>;

Keys secret_keys(std::span<const Parameter> parameters) {
  Keys keys;
  for (const Parameter& parameter : parameters) {
    if (std::holds_alternative<Secret>(parameter.default_value)) keys.push_back(parameter.name);
  }
  return keys;
}

/// Returns the names of a driver's secrets; of all drivers' if there is no such driver.
Keys secret_keys_of(std::string_view driver) {
  if (const auto* const found = drivers::sensor::find_driver(driver)) return secret_keys(found->parameters);
  Keys of_all;
  for (const drivers::sensor::DriverDescription* description : drivers::sensor::driver_table()) {
    for (const std::string_view key : secret_keys(description->parameters)) of_all.push_back(key);
  }
  return of_all;
}

/// Withholds values of one text.
class SecretWithholder {
 public:
  /// Throws toml::parse_error.
  explicit SecretWithholder(std::string_view text) : text_(text), places_(text), root_(tables::parse_toml(text)) {}

  toml::table& root() { return root_; }

  /// The values of these keys of a table.
  void withhold(toml::table& table, const Keys& secret_keys) {
    for (const std::string_view key : secret_keys) {
      const toml::node* node = table.get(key);
      if (node == nullptr) continue;
      const std::string* held = node->is_string() ? &node->as_string()->get() : nullptr;
      if (held != nullptr && (held->empty() || *held == Secret::kWithheld)) continue;
      edits_.emplace_back(places_.at(node->source().begin), places_.at(node->source().end));
      table.insert_or_assign(key, Secret::kWithheld);
    }
  }

  WithheldText take() {
    if (edits_.empty()) return {std::string(text_), 0};
    std::string edited(text_);
    std::ranges::sort(edits_, std::greater<>());  // from the back, so that the places before stay valid
    for (const auto& [begin, end] : edits_) {
      edited.replace(begin, std::max(begin, end) - begin, toml_value(std::string(Secret::kWithheld)));
    }
    return {is_root(edited) ? edited : written_root(), edits_.size()};
  }

 private:
  bool is_root(const std::string& edited) const {
    try {
      return tables::parse_toml(edited) == root_;
    } catch (const toml::parse_error&) {
      return false;
    }
  }
  std::string written_root() const {
    std::ostringstream out;
    out << root_ << '\n';
    std::string text = out.str();
    tables::parse_toml(text);  // throws if escapes have made it too large
    return text;
  }

  std::string_view text_;
  TextPlaces places_;
  toml::table root_;
  std::vector<std::pair<std::size_t, std::size_t>> edits_;  // from, to: bytes of the text
};

template <class Withhold>
Result<WithheldText, Failure> withhold_in(std::string_view toml_text, const Withhold& withhold) {
  try {
    SecretWithholder withholder(toml_text);
    withhold(withholder);
    return withholder.take();
  } catch (const toml::parse_error&) {
    return Failure{"is not TOML, or is too large or too deeply nested", FailureKind::kBadData};
  }
}

}  // namespace

Result<WithheldText, Failure> withhold_in_configuration(std::string_view toml_text) {
  return withhold_in(toml_text, [](SecretWithholder& withholder) {
    toml::table& root = withholder.root();
    const auto withhold_of_table = [&withholder](toml::table& around, std::string_view name,
                                                 std::span<const Parameter> parameters) {
      toml::table* const table = name.empty() ? &around : around[name].as_table();
      if (table != nullptr) withholder.withhold(*table, secret_keys(parameters));
    };
    const auto for_each_entry = [&root](std::string_view list, const auto& use) {
      toml::array* const entries = root[list].as_array();
      if (entries == nullptr) return;
      for (toml::node& element : *entries) {
        if (toml::table* const entry = element.as_table()) use(*entry);
      }
    };
    for (const ConfigTable& table : config_tables()) withhold_of_table(root, table.name, table.parameters);
    for_each_entry("sensor", [&](toml::table& sensor) {
      withholder.withhold(sensor, secret_keys_of(sensor["driver"].value_or(std::string())));
      for (const SensorTable& table : sensor_tables()) withhold_of_table(sensor, table.name, table.parameters);
    });
    for_each_entry("scene", [&](toml::table& scene) {
      for (const scenes::Description* const kind : scenes::scene_table())
        withhold_of_table(scene, "", scene_parameters(*kind));
    });
    for_each_entry("camera", [&](toml::table& camera) { withhold_of_table(camera, "", look::camera_parameters()); });
    for_each_entry("alert", [&](toml::table& alert) { withhold_of_table(alert, "", alert_parameters()); });
    for (const feeds::ListTable& list : feeds::list_tables()) {
      for_each_entry(list.name, [&](toml::table& entry) { withhold_of_table(entry, "", list.parameters); });
    }
    for_each_entry("output", [&](toml::table& output) { withhold_of_table(output, "", output::output_parameters()); });
  });
}

Result<WithheldText, Failure> withhold_in_options(std::string_view toml_text, std::string_view driver) {
  return withhold_in(
      toml_text, [&](SecretWithholder& withholder) { withholder.withhold(withholder.root(), secret_keys_of(driver)); });
}

}  // namespace yuragi::daemon::settings
