#include "daemon/settings/scene_config.hpp"

#include <charconv>
#include <span>
#include <string_view>
#include <utility>

#include "daemon/pictures/picture_file.hpp"
#include "daemon/settings/config_tables.hpp"

namespace yuragi::daemon::settings {
namespace {

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

std::vector<Parameter> scene_parameters(const scenes::SceneDescription& kind) {
  std::vector<Parameter> all(kind.parameters.begin(), kind.parameters.end());
  const std::span<const Parameter> common = common_scene_parameters();
  all.insert(all.end(), common.begin(), common.end());
  return all;
}

bool remakes_scene(std::string_view key) noexcept {
  return key != "gain" && key != "shown";
}

bool names_file(std::string_view key) noexcept {
  return key == "image";
}

SceneConfig scene_config_of(std::string name, const scenes::SceneDescription& kind, ParameterValues values) {
  SceneConfig scene{.name = std::move(name), .kind = &kind, .values = std::move(values)};
  scene.placement = {.x_m = scene.values.number("x"),
                     .y_m = scene.values.number("y"),
                     .z_m = scene.values.number("z"),
                     .heading_deg = scene.values.number("heading")};
  scene.wind_gain = scene.values.number("gain");
  scene.is_shown = scene.values.flag("shown");
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
