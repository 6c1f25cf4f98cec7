#include "engine/look/look.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/base/fields.hpp"
#include "engine/look/time_of_day.hpp"

namespace yuragi::look {
namespace {

constexpr std::array<std::string_view, 3> kSuns{"evening", "time", "fixed"};
constexpr std::array<std::string_view, 4> kQualities{"auto", "low", "medium", "high"};
constexpr std::array<std::string_view, 6> kPalettes{"meadow", "spring", "summer-dry", "autumn", "winter", "ink"};
constexpr std::array<std::string_view, 5> kGrounds{"grass", "lawn", "sand", "stone", "snow"};
constexpr Look kDefault{};

Result<std::optional<double>, Failure> hour_or_now(const std::string& text) {
  const std::optional<double> hour = time_of_day_h(text);
  if (!hour && text != "now") {
    return Failure{"is \"" + text + "\"; allowed: \"now\", or a time of the day such as \"06:30\""};
  }
  return hour;
}

const Fields<Look>& look_fields() {
  static const Fields<Look> kFields{
      {{.name = "sun",
        .default_value = std::string("evening"),
        .help = "\"evening\": always low in the south-west; \"time\": as sun and moon stand at a place and time; "
                "\"fixed\": at sun_height and sun_azimuth",
        .choices = kSuns,
        .left_out = "\"time\" if a place or a time is given, \"fixed\" if a height or an azimuth is given, otherwise "
                    "\"evening\""},
       &Look::sun},
      {{.name = "latitude",
        .unit = "deg",
        .default_value = 0.0,
        .min = -90.0,
        .max = 90.0,
        .help = "The place for sun = \"time\"; north of the equator is above 0",
        .left_out = "35.68, Tokyo"},
       &Look::latitude_deg},
      {{.name = "longitude",
        .unit = "deg",
        .default_value = 0.0,
        .min = -180.0,
        .max = 180.0,
        .help = "The place for sun = \"time\"; east of Greenwich is above 0",
        .left_out = "139.77, Tokyo"},
       &Look::longitude_deg},
      {{.name = "time",
        .default_value = std::string(),
        .help =
            "For sun = \"time\": the hour at which the day stands still, HH:MM by the sun (at 12:00 it is highest), "
            "or \"now\"",
        .left_out = "now"},
       &Look::solar_time_h,
       hour_or_now},
      {{.name = "sun_height",
        .unit = "deg",
        .default_value = 0.0,
        .min = -30.0,
        .max = 90.0,
        .help = "The sun's height for sun = \"fixed\"; below 0 it has set",
        .left_out = "30"},
       &Look::sun_height_deg},
      {{.name = "sun_azimuth",
        .unit = "deg",
        .default_value = 0.0,
        .min = 0.0,
        .max = 360.0,
        .help = "The sun's bearing for sun = \"fixed\": 0 north, 90 east",
        .left_out = "220"},
       &Look::sun_azimuth_deg},
      {{.name = "clouds",
        .default_value = kDefault.clouds,
        .min = 0.0,
        .max = 1.0,
        .help = "0: a clear sky; 1: overcast"},
       &Look::clouds},
      {{.name = "haze", .default_value = kDefault.haze, .min = 0.0, .max = 1.0, .help = "0: very clear air; 1: fog"},
       &Look::haze},
      {{.name = "exposure",
        .unit = "EV",
        .default_value = kDefault.exposure_ev,
        .min = -4.0,
        .max = 4.0,
        .help = "Makes the picture brighter by this many doublings; negative: darker"},
       &Look::exposure_ev},
      {{.name = "quality",
        .default_value = std::string("auto"),
        .help = "Quality of the picture; \"auto\": the best that the machine can draw in time",
        .choices = kQualities},
       &Look::quality},
      {{.name = "palette",
        .default_value = std::string("meadow"),
        .help =
            "The colors of grass, flowers, leaves and woods; \"winter\" has snow on the hills, \"ink\" no color at all",
        .choices = kPalettes},
       &Look::palette},
      {{.name = "ground",
        .default_value = std::string("grass"),
        .help = "What the ground is around the scenes; \"lawn\" is short everywhere",
        .choices = kGrounds},
       &Look::ground},
      {{.name = "ground_image",
        .default_value = std::string(),
        .help = "A PNG or JPEG file, relative to the configuration's folder: it is repeated on the ground wherever no "
                "grass grows; with ground = \"sand\", \"stone\" or \"snow\" everywhere. Needs a scene of the kind "
                "\"ground\"",
        .left_out = "the ground as it is built in",
        .change = KeyChange::kTakesReload}},
      {{.name = "ground_image_width",
        .unit = "m",
        .default_value = kDefault.ground_image_width_m,
        .min = 0.1,
        .max = 200.0,
        .help = "How wide ground_image is on the ground, from west to east; its upper edge is north"},
       &Look::ground_image_width_m},
      {{.name = "density",
        .default_value = kDefault.density,
        .min = 0.1,
        .max = 1.0,
        .help = "How many blades of grass are drawn, as a part of what the quality draws; fewer are wider"},
       &Look::density},
  };
  return kFields;
}

Result<Look, ParameterError> changed(Look look, const ParameterValues::Map& values) {
  const std::vector<ParameterError> errors = look_fields().fill(look, values);
  if (!errors.empty()) return errors.front();
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
  return look_fields().parameters();
}

Result<Look, ParameterError> look_of(const ParameterValues& values) {
  return changed({}, values.all());
}

Result<Look, ParameterError> edited(const Look& look, std::span<const std::string> edits) {
  const std::span<const Parameter> parameters = look_parameters();
  ParameterValues::Map given;
  for (const std::string& edit : edits) {
    const std::size_t equals = std::min(edit.find('='), edit.size());
    const std::string name = edit.substr(0, equals);
    const std::string text = edit.substr(std::min(equals + 1, edit.size()));
    const auto parameter = std::ranges::find(parameters, name, &Parameter::name);
    if (parameter != parameters.end() && parameter->change == KeyChange::kTakesReload) {
      return ParameterError{name, "is a file that the daemon reads: write it into [look] of its configuration"};
    }
    given.insert_or_assign(name, parameter == parameters.end() ? ParameterValue(text) : typed_value(*parameter, text));
  }
  // Checked as a whole, and applied without defaults for missing values.
  auto checked = ParameterValues::resolve(parameters, given);
  if (!checked) return checked.error();
  return changed(look, given);
}

Look within_limits(const Look& look) {
  Look to = look_fields().within_limits(look, kDefault);
  if (to.solar_time_h) {
    to.solar_time_h.reset();
    if (std::isfinite(*look.solar_time_h)) to.solar_time_h = std::clamp(*look.solar_time_h, 0.0, 24.0);
  }
  return to;
}

}  // namespace yuragi::look
