#include "daemon/settings/withhold_secrets.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "daemon/settings/config_edit.hpp"
#include "daemon/settings/toml_places.hpp"
#include "drivers/sensor/driver.hpp"
#include "engine/tables/parse_toml.hpp"

namespace yuragi::daemon::settings {
namespace {

/// The names of a driver's secrets; of all secrets where there is no such driver.
std::vector<std::string_view> secret_keys_of(std::string_view driver) {
  std::vector<std::string_view> keys;
  std::vector<std::string_view> keys_of_all;
  bool is_known = false;
  for (const drivers::sensor::DriverDescription* description : drivers::sensor::driver_table()) {
    is_known = is_known || description->name == driver;
    for (const Parameter& parameter : description->parameters) {
      if (!std::holds_alternative<Secret>(parameter.default_value)) continue;
      keys_of_all.push_back(parameter.name);
      if (description->name == driver) keys.push_back(parameter.name);
    }
  }
  return is_known ? keys : keys_of_all;
}

/// Withholds values of one text.
class SecretWithholder {
 public:
  /// Throws toml::parse_error.
  explicit SecretWithholder(std::string_view text) : text_(text), places_(text), root_(tables::parse_toml(text)) {}

  toml::table& root() { return root_; }

  /// The secrets among the values of a sensor's table.
  void withhold(toml::table& table, std::string_view driver) {
    for (const std::string_view key : secret_keys_of(driver)) {
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
    return Failure{"is no TOML, or too large or too deep", FailureKind::kBadData};
  }
}

}  // namespace

Result<WithheldText, Failure> withhold_in_configuration(std::string_view toml_text) {
  return withhold_in(toml_text, [](SecretWithholder& withholder) {
    toml::array* const sensors = withholder.root()["sensor"].as_array();
    if (sensors == nullptr) return;
    for (toml::node& element : *sensors) {
      toml::table* const sensor = element.as_table();
      if (sensor != nullptr) withholder.withhold(*sensor, (*sensor)["driver"].value_or(std::string()));
    }
  });
}

Result<WithheldText, Failure> withhold_in_options(std::string_view toml_text, std::string_view driver) {
  return withhold_in(toml_text, [&](SecretWithholder& withholder) { withholder.withhold(withholder.root(), driver); });
}

}  // namespace yuragi::daemon::settings
