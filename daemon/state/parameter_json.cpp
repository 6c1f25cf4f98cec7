#include "daemon/state/parameter_json.hpp"

#include <array>
#include <optional>
#include <string>

namespace yuragi::daemon::state {
namespace {

/// The value in its own type; null: left out.
nlohmann::ordered_json json_of(const wire::ParameterState& state, const std::optional<std::string>& value) {
  if (!value) return nullptr;
  if (state.kind == wire::ParameterKind::kText) return *value;
  const auto json = nlohmann::ordered_json::parse(*value, nullptr, false);
  return json.is_discarded() ? nlohmann::ordered_json(*value) : json;
}

nlohmann::ordered_json json_of(const wire::ParameterState& state) {
  constexpr std::array kKinds = {"number", "whole number", "true or false", "text"};
  constexpr std::array kChanges = {"at once", "cross-fade", "takes a restart", "takes a reload"};
  nlohmann::ordered_json json{{"name", state.name},
                              {"value", json_of(state, state.value)},
                              {"configured", json_of(state, state.configured)},
                              {"default", json_of(state, state.default_value)},
                              {"unit", state.unit},
                              {"kind", kKinds.at(static_cast<std::size_t>(state.kind))},
                              {"min", nullptr},
                              {"max", nullptr},
                              {"choices", state.choices},
                              {"left_out", state.left_out},
                              {"change", kChanges.at(static_cast<std::size_t>(state.change))},
                              {"help", state.help}};
  if (state.min) json["min"] = *state.min;
  if (state.max) json["max"] = *state.max;
  return json;
}

}  // namespace

nlohmann::ordered_json parameters_json(std::span<const wire::ParameterGroup> groups) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const wire::ParameterGroup& group : groups) {
    nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
    for (const wire::ParameterState& state : group.parameters) parameters.push_back(json_of(state));
    list.push_back({{"scene", group.scene}, {"kind", group.kind}, {"parameters", parameters}});
  }
  return list;
}

}  // namespace yuragi::daemon::state
