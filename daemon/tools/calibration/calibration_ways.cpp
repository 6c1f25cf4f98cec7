#include "daemon/tools/calibration/calibration_ways.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

namespace yuragi::daemon::tools::calibration {
namespace {

using enum drivers::sensor::CalibrationMeans;

constexpr std::array kWays = {
    Way{.calibration = "zero",
        .given = Given::kNothing,
        .means = kFactors,
        .duration_s = 30.0,
        .preparation =
            "The air at the sensor must not move: put a box or a bag over it, close windows, switch off fans, and keep "
            "your\nhands away. Cups must be free to turn."},
    Way{.calibration = "span",
        .given = Given::kSpeed,
        .means = kFactors,
        .duration_s = 60.0,
        .preparation = "Set the wind at the sensor to a steady {number} m/s: with a fan or a wind tunnel, and an "
                       "accurate meter next to it."},
    Way{.calibration = "span",
        .given = Given::kReference,
        .means = kFactors,
        .duration_s = 900.0,
        .preparation = "Both sensors must be in the same wind, as close together as possible without sheltering each "
                       "other; the more the\nwind varies meanwhile, the better."},
    Way{.calibration = "north",
        .given = Given::kBearing,
        .means = kFactors,
        .duration_s = 20.0,
        .preparation = "Turn the vane so that its tip points to the landmark at {number} degrees, as if the wind "
                       "came from there, and hold it\nstill."},
    Way{.calibration = "north",
        .given = Given::kReference,
        .means = kFactors,
        .duration_s = 900.0,
        .preparation = "Both vanes must be in the same wind, of more than 1 m/s."},
    Way{.calibration = "microphone",
        .given = Given::kReference,
        .means = kSoundLevel,
        .duration_s = 900.0,
        .preparation = "The microphone and the reference must be in the same wind, as close together as possible. Both "
                       "calm and wind are\nneeded: the more the wind varies meanwhile, the better."},
    Way{.calibration = "microphone",
        .given = Given::kSpeed,
        .means = kSoundLevel,
        .duration_s = 60.0,
        .preparation = "Set the wind at the microphone to a steady {number} m/s, with no other sound."},
};

}  // namespace

std::string_view name_of(Given given) noexcept {
  constexpr std::array<std::string_view, 4> kNames = {"nothing", "bearing", "speed", "reference"};
  return kNames[static_cast<std::size_t>(given)];
}

std::span<const Way> ways() {
  return kWays;
}

const Way& way_of(std::string_view calibration, Given given) {
  for (const Way& way : kWays) {
    if (way.calibration == calibration && way.given == given) return way;
  }
  throw std::logic_error("no such way to calibrate");
}

std::string preparation_of(const Way& way, double number) {
  std::string text(way.preparation);
  const std::size_t place = text.find(kNumber);
  if (place != std::string::npos) text.replace(place, kNumber.size(), fmt::format("{:g}", number));
  return text;
}

}  // namespace yuragi::daemon::tools::calibration
