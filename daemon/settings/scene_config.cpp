#include "daemon/settings/scene_config.hpp"

#include <charconv>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "daemon/pictures/picture_file.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::daemon::settings {
namespace {

auto of_placement(auto member) {
  return member_of(&SceneConfig::placement, member);
}

const Fields<SceneConfig>& common_scene_fields() {
  static const Fields<SceneConfig> kFields{
      {{.name = "x",
        .unit = "m",
        .default_value = 0.0,
        .min = -1000.0,
        .max = 1000.0,
        .help = "position of the scene to the east"},
       of_placement(&scenes::Placement::x_m)},
      {{.name = "y",
        .unit = "m",
        .default_value = 0.0,
        .min = -1000.0,
        .max = 1000.0,
        .help = "position of the scene upward"},
       of_placement(&scenes::Placement::y_m)},
      {{.name = "z",
        .unit = "m",
        .default_value = 0.0,
        .min = -1000.0,
        .max = 1000.0,
        .help = "position of the scene to the south"},
       of_placement(&scenes::Placement::z_m)},
      {{.name = "heading",
        .unit = "deg",
        .default_value = 0.0,
        .min = -360.0,
        .max = 360.0,
        .help = "rotation of the scene, clockwise from north; the wind is not rotated with it"},
       of_placement(&scenes::Placement::heading_deg)},
      {{.name = "gain",
        .default_value = 1.0,
        .min = 0.0,
        .max = 10.0,
        .help = "factor on the wind speed for this scene",
        .change = KeyChange::kAtOnce},
       &SceneConfig::wind_gain},
      {{.name = "shown",
        .default_value = true,
        .help = "false: hidden until `yuragi scene show` or `yuragi scene switch` shows it",
        .change = KeyChange::kAtOnce},
       &SceneConfig::is_shown},
  };
  return kFields;
}

/// "#1b2a49".
std::optional<look::Color> color_of(std::string_view text) {
  constexpr std::size_t kDigits = 6;
  if (text.size() != 1 + kDigits || text.front() != '#') return std::nullopt;
  std::uint32_t rgb = 0;
  const char* const end = text.data() + text.size();
  const auto [behind, error] = std::from_chars(text.data() + 1, end, rgb, 16);
  if (error != std::errc{} || behind != end) return std::nullopt;
  const auto part = [&](unsigned shift) { return static_cast<std::uint8_t>(rgb >> shift & 0xFFU); };
  return look::Color{part(16), part(8), part(0)};
}

}  // namespace

std::span<const Parameter> common_scene_parameters() {
  return common_scene_fields().parameters();
}

std::vector<Parameter> scene_parameters(const scenes::Description& kind) {
  std::vector<Parameter> all(kind.parameters.begin(), kind.parameters.end());
  const std::span<const Parameter> common = common_scene_parameters();
  all.insert(all.end(), common.begin(), common.end());
  return all;
}

SceneConfig scene_config_of(std::string name, const scenes::Description& kind, ParameterValues values) {
  SceneConfig scene{.name = std::move(name), .kind = &kind, .values = std::move(values)};
  common_scene_fields().fill(scene, scene.values.all());
  return scene;
}

Result<look::ClothLook, std::vector<ParameterError>> cloth_look_of(const ParameterValues& values,
                                                                   const std::optional<std::filesystem::path>& folder) {
  look::ClothLook cloth;
  std::vector<ParameterError> errors;
  const auto read_color = [&](const std::string& key, std::optional<look::Color>& color) {
    if (!values.has(key)) return;
    color = color_of(values.text(key));
    if (!color) {
      errors.push_back({key, "is \"" + values.text(key) + "\"; allowed: \"#rrggbb\", as in \"#1b2a49\""});
    }
  };
  read_color("color", cloth.color);
  read_color("color_2", cloth.color_2);
  if (folder && values.has("image")) {
    constexpr look::Color kWhite{255, 255, 255};
    const std::string& file = values.text("image");
    auto picture = pictures::read_picture(*folder / file, cloth.color.value_or(kWhite));
    if (picture) {
      cloth.image = std::move(*picture);
    } else {
      errors.push_back({"image", "\"" + file + "\" " + picture.error().message});
    }
  }
  if (!errors.empty()) return errors;
  return cloth;
}

}  // namespace yuragi::daemon::settings
