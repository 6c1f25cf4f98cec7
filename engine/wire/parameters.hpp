#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/parameter.hpp"

namespace yuragi::wire {

// The values of [look] and of the scenes, as a client sees and sets them. A value is a text, as in the configuration
// but without quotes: "0.4", "12", "true", "evening".

// The limits that decode() accepts; encoders leave out more.
inline constexpr std::size_t kMaxParameterEdits = 64;
inline constexpr std::size_t kMaxParameters = 256;  ///< of [look] or of one scene
inline constexpr std::size_t kMaxParameterChoices = 64;

/// A value to set.
struct ParameterEdit {
  std::string key;
  std::optional<std::string> value;  ///< nullopt: back to the configuration's
};

/// Sets values of [look] or of one scene, until the configuration is read again or the server restarts.
struct ParameterCommand {
  std::string scene = {};                 ///< its name; empty: [look]
  std::vector<ParameterEdit> edits = {};  ///< all of them, or none if one has a mistake
  bool describe = false;                  ///< the reply lists all parameters, with their new values
  std::uint32_t number = 0;               ///< chosen by the client, and returned in the reply
};

/// What a value is.
enum class ParameterKind : std::uint8_t { kNumber, kWholeNumber, kYesNo, kText };

/// A parameter with its description and value.
struct ParameterState {
  std::string name;
  std::string unit = {};  ///< "m/s"; empty: none
  ParameterKind kind = ParameterKind::kNumber;
  std::optional<double> min = std::nullopt;  ///< numbers only; nullopt: no limit
  std::optional<double> max = std::nullopt;
  std::vector<std::string> choices = {};  ///< texts only; empty: any text
  std::string help = {};
  std::string left_out = {};                                ///< meaning of a missing value
  std::optional<std::string> default_value = std::nullopt;  ///< nothing: left out
  std::optional<std::string> value = std::nullopt;          ///< now
  std::optional<std::string> configured = std::nullopt;     ///< by the configuration
  /// Effect of a new value. A parameter with a kind or a change that this build does not know is decoded as a text that
  /// needs a restart.
  KeyChange change = KeyChange::kAtOnce;
};

/// The parameters of [look], or of a scene.
struct ParameterGroup {
  std::string scene;  ///< its name; empty: [look]
  std::string kind;   ///< of the scene
  std::vector<ParameterState> parameters;
};

struct ParameterReport {
  std::uint32_t number = 0;                 ///< of the command
  std::string refusal = {};                 ///< why this client may set no values; empty: it may
  std::vector<ParameterGroup> groups = {};  ///< [look], then the scenes in order; empty unless requested
};

}  // namespace yuragi::wire
