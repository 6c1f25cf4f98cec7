#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi::look {

/// How the places of sun and moon are determined.
enum class SunChoice : std::uint8_t {
  kEvening,  ///< always the same low sun in the south-west
  kTime,     ///< by the place on earth, the date and the time
  kFixed,    ///< by the given height and azimuth
};

/// How much work a picture is.
enum class Quality : std::uint8_t { kAuto, kLow, kMedium, kHigh };

/// The colors of plants: viewer/light/palettes.cpp has the table.
enum class Palette : std::uint8_t { kMeadow, kSpring, kSummerDry, kAutumn, kWinter, kInk };

/// The ground without streamed blades.
enum class GroundKind : std::uint8_t {
  kGrass,  ///< as tall as the meadow, short around objects
  kLawn,   ///< short everywhere
  kSand,
  kStone,  ///< gravel
  kSnow,
};

std::string_view name_of(SunChoice sun);
std::string_view name_of(Quality quality);
std::string_view name_of(Palette palette);
std::string_view name_of(GroundKind ground);

/// The light and the weather of the picture: the values of [look].
struct Look {
  SunChoice sun = SunChoice::kEvening;
  double latitude_deg = 35.68;    ///< for kTime; north is positive
  double longitude_deg = 139.77;  ///< east is above 0
  /// For kTime: a fixed hour of the day, by the sun (12: it is highest); nullopt: the time advances
  std::optional<double> solar_time_h = std::nullopt;
  double sun_height_deg = 30.0;    ///< for kFixed
  double sun_azimuth_deg = 220.0;  ///< for kFixed: 0 north, 90 east
  double clouds = 0.3;             ///< 0: a clear sky, 1: overcast
  double haze = 0.15;              ///< 0: very clear air, 1: fog
  double exposure_ev = 0.0;        ///< brighter by this many doublings
  Quality quality = Quality::kAuto;
  Palette palette = Palette::kMeadow;
  GroundKind ground = GroundKind::kGrass;
  /// Width of the repeated image on the ground, if the scene `ground` has one (ClothLook)
  double ground_image_width_m = 4.0;
  double density = 1.0;  ///< share of the quality's blades that are drawn

  friend bool operator==(const Look&, const Look&) = default;
};

/// The keys of the table [look], and of the viewer's `--look KEY=VALUE`.
std::span<const Parameter> look_parameters();

/// From values of look_parameters(). If they do not choose the sun, a place or a time means kTime, a height or an
/// azimuth kFixed.
Result<Look, ParameterError> look_of(const ParameterValues& values);

/// Returns `look`, changed by texts such as "time=06:30" and "clouds=1". Keys and values as in look_parameters(),
/// except those that name a file.
Result<Look, ParameterError> edited(const Look& look, std::span<const std::string> edits);

/// The same look with every number finite and within the limits of look_parameters(): for untrusted input.
Look within_limits(const Look& look);

}  // namespace yuragi::look
