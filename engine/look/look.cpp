#include "engine/look/look.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/look/time_of_day.hpp"

namespace yuragi::look {
namespace {

constexpr std::array<std::string_view, 3> kSuns{"evening", "time", "fixed"};
constexpr std::array<std::string_view, 4> kQualities{"auto", "low", "medium", "high"};
constexpr std::array<std::string_view, 6> kPalettes{"meadow", "spring", "summer-dry", "autumn", "winter", "ink"};
constexpr std::array<std::string_view, 5> kGrounds{"grass", "lawn", "sand", "stone", "snow"};
constexpr Look kDefault{};

const std::array<Parameter, 15> kParameters{{
    {.name = "sun",
     .unit = "",
     .default_value = std::string("evening"),
     .help =
         "\"evening\": always low in the south-west; \"time\": where sun and moon are at a place and time; \"fixed\": "
         "where sun_height and sun_azimuth say",
     .choices = kSuns,
     .left_out =
         "\"time\" where a place or a time is given, \"fixed\" where a height or an azimuth is, otherwise \"evening\""},
    {.name = "latitude",
     .unit = "deg",
     .default_value = 0.0,
     .min = -90.0,
     .max = 90.0,
     .help = "The place for sun = \"time\"; north of the equator is above 0",
     .left_out = "35.68, Tokyo"},
    {.name = "longitude",
     .unit = "deg",
     .default_value = 0.0,
     .min = -180.0,
     .max = 180.0,
     .help = "The place for sun = \"time\"; east of Greenwich is above 0",
     .left_out = "139.77, Tokyo"},
    {.name = "time",
     .unit = "",
     .default_value = std::string(),
     .help = "For sun = \"time\": the hour at which the day stands still, HH:MM by the sun (at 12:00 it is highest), "
             "or \"now\"",
     .left_out = "now"},
    {.name = "sun_height",
     .unit = "deg",
     .default_value = 0.0,
     .min = -30.0,
     .max = 90.0,
     .help = "The sun's height for sun = \"fixed\"; below 0 it has set",
     .left_out = "30"},
    {.name = "sun_azimuth",
     .unit = "deg",
     .default_value = 0.0,
     .min = 0.0,
     .max = 360.0,
     .help = "The sun's bearing for sun = \"fixed\": 0 north, 90 east",
     .left_out = "220"},
    {.name = "clouds",
     .unit = "",
     .default_value = kDefault.clouds,
     .min = 0.0,
     .max = 1.0,
     .help = "0: a clear sky; 1: overcast"},
    {.name = "haze",
     .unit = "",
     .default_value = kDefault.haze,
     .min = 0.0,
     .max = 1.0,
     .help = "0: very clear air; 1: fog"},
    {.name = "exposure",
     .unit = "EV",
     .default_value = kDefault.exposure_ev,
     .min = -4.0,
     .max = 4.0,
     .help = "Makes the picture brighter by so many doublings, or darker"},
    {.name = "quality",
     .unit = "",
     .default_value = std::string("auto"),
     .help = "How much work a picture is; \"auto\": as much as the machine can draw in time",
     .choices = kQualities},
    {.name = "palette",
     .unit = "",
     .default_value = std::string("meadow"),
     .help =
         "The colors of grass, flowers, leaves and woods; \"winter\" has snow on the hills, \"ink\" no color at all",
     .choices = kPalettes},
    {.name = "ground",
     .unit = "",
     .default_value = std::string("grass"),
     .help = "What the ground is around the scenes; \"lawn\" is short everywhere",
     .choices = kGrounds},
    {.name = "ground_image",
     .unit = "",
     .default_value = std::string(),
     .help = "A PNG or JPEG file, from the configuration's folder on: it lies on the ground, again and again, where no "
             "grass grows; with ground = \"sand\", \"stone\" or \"snow\" that is everywhere. Needs a scene of the kind "
             "\"ground\"",
     .left_out = "the ground as it is built in"},
    {.name = "ground_image_width",
     .unit = "m",
     .default_value = kDefault.ground_image_width_m,
     .min = 0.1,
     .max = 200.0,
     .help = "How wide ground_image is on the ground, from west to east; its upper edge is north"},
    {.name = "density",
     .unit = "",
     .default_value = kDefault.density,
     .min = 0.1,
     .max = 1.0,
     .help = "How many blades of grass are drawn, as a part of what the quality draws; fewer are wider"},
}};

template <class Choice, std::size_t kCount>
Choice choice_of(const std::array<std::string_view, kCount>& names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  return static_cast<Choice>(found == names.end() ? 0 : found - names.begin());
}

double limited(double value, std::string_view name, double fallback) {
  if (!std::isfinite(value)) return fallback;
  const auto found = std::ranges::find(kParameters, name, &Parameter::name);
  return std::clamp(value, found->min, found->max);
}

/// Takes over one value; nothing, or what is wrong with it.
std::optional<ParameterError> change(Look& look, std::string_view name, const ParameterValue& value) {
  const auto number = [&] { return std::get<double>(value); };
  const auto text = [&]() -> const std::string& { return std::get<std::string>(value); };
  if (name == "sun") look.sun = choice_of<SunChoice>(kSuns, text());
  if (name == "quality") look.quality = choice_of<Quality>(kQualities, text());
  if (name == "palette") look.palette = choice_of<Palette>(kPalettes, text());
  if (name == "ground") look.ground = choice_of<GroundKind>(kGrounds, text());
  if (name == "ground_image_width") look.ground_image_width_m = number();
  if (name == "density") look.density = number();
  if (name == "latitude") look.latitude_deg = number();
  if (name == "longitude") look.longitude_deg = number();
  if (name == "sun_height") look.sun_height_deg = number();
  if (name == "sun_azimuth") look.sun_azimuth_deg = number();
  if (name == "clouds") look.clouds = number();
  if (name == "haze") look.haze = number();
  if (name == "exposure") look.exposure_ev = number();
  if (name == "time") {
    look.solar_time_h = time_of_day_h(text());
    if (!look.solar_time_h && text() != "now") {
      return ParameterError{"time", "is \"" + text() + "\"; allowed: \"now\", or a time of the day such as \"06:30\""};
    }
  }
  return std::nullopt;
}

Result<Look, ParameterError> changed(Look look, const ParameterValues::Map& values) {
  for (const auto& [name, value] : values) {
    if (auto error = change(look, name, value)) return *error;
  }
  if (values.contains("sun")) return look;
  if (values.contains("sun_height") || values.contains("sun_azimuth")) look.sun = SunChoice::kFixed;
  if (values.contains("latitude") || values.contains("longitude") || values.contains("time")) {
    look.sun = SunChoice::kTime;
  }
  return look;
}

}  // namespace

std::string_view name_of(SunChoice sun) {
  return kSuns.at(static_cast<std::size_t>(sun));
}
std::string_view name_of(Quality quality) {
  return kQualities.at(static_cast<std::size_t>(quality));
}
std::string_view name_of(Palette palette) {
  return kPalettes.at(static_cast<std::size_t>(palette));
}
std::string_view name_of(GroundKind ground) {
  return kGrounds.at(static_cast<std::size_t>(ground));
}

std::span<const Parameter> look_parameters() {
  return kParameters;
}

bool names_file(std::string_view key) noexcept {
  return key == "ground_image";
}

Result<Look, ParameterError> look_of(const ParameterValues& values) {
  return changed({}, values.all());
}

Result<Look, ParameterError> edited(const Look& look, std::span<const std::string> edits) {
  ParameterValues::Map given;
  for (const std::string& edit : edits) {
    const std::size_t equals = std::min(edit.find('='), edit.size());
    const std::string name = edit.substr(0, equals);
    const std::string text = edit.substr(std::min(equals + 1, edit.size()));
    if (names_file(name)) {
      return ParameterError{name, "is a file that the daemon reads: write it into [look] of its configuration"};
    }
    const auto parameter = std::ranges::find(kParameters, name, &Parameter::name);
    given.insert_or_assign(name, parameter == kParameters.end() ? ParameterValue(text) : typed_value(*parameter, text));
  }
  // Checked as a whole, and applied without the defaults of what was not given.
  auto checked = ParameterValues::resolve(kParameters, given);
  if (!checked) return checked.error();
  return changed(look, given);
}

Look within_limits(const Look& look) {
  Look to = look;
  if (static_cast<std::size_t>(look.sun) >= kSuns.size()) to.sun = kDefault.sun;
  if (static_cast<std::size_t>(look.quality) >= kQualities.size()) to.quality = kDefault.quality;
  if (static_cast<std::size_t>(look.palette) >= kPalettes.size()) to.palette = kDefault.palette;
  if (static_cast<std::size_t>(look.ground) >= kGrounds.size()) to.ground = kDefault.ground;
  to.ground_image_width_m = limited(look.ground_image_width_m, "ground_image_width", kDefault.ground_image_width_m);
  to.density = limited(look.density, "density", kDefault.density);
  to.latitude_deg = limited(look.latitude_deg, "latitude", kDefault.latitude_deg);
  to.longitude_deg = limited(look.longitude_deg, "longitude", kDefault.longitude_deg);
  if (look.solar_time_h) {
    to.solar_time_h.reset();
    if (std::isfinite(*look.solar_time_h)) to.solar_time_h = std::clamp(*look.solar_time_h, 0.0, 24.0);
  }
  to.sun_height_deg = limited(look.sun_height_deg, "sun_height", kDefault.sun_height_deg);
  to.sun_azimuth_deg = limited(look.sun_azimuth_deg, "sun_azimuth", kDefault.sun_azimuth_deg);
  to.clouds = limited(look.clouds, "clouds", kDefault.clouds);
  to.haze = limited(look.haze, "haze", kDefault.haze);
  to.exposure_ev = limited(look.exposure_ev, "exposure", kDefault.exposure_ev);
  return to;
}

}  // namespace yuragi::look
