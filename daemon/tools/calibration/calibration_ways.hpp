#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "drivers/sensor/driver.hpp"

namespace yuragi::daemon::tools::calibration {

/// What a person gives for a calibration, besides the sensor.
enum class Given : std::uint8_t { kNothing, kBearing, kSpeed, kReference };

/// Its name in JSON: "nothing", "bearing" (degrees), "speed" (m/s), "reference" (another sensor).
std::string_view name_of(Given given) noexcept;

/// A way to calibrate a sensor: `yuragi calibrate zero`, for example.
struct Way {
  std::string_view calibration;  ///< "zero", "span", "north", "microphone"
  Given given;
  drivers::sensor::CalibrationMeans means;  ///< of the sensors that can be calibrated so
  double duration_s;                        ///< for how long it listens unless a person chooses another time
  std::string_view preparation;             ///< what a person does before; kNumber stands for the bearing or the speed
};

inline constexpr std::string_view kNumber = "{number}";

/// All ways, in the order in which a new sensor needs them.
std::span<const Way> ways();

/// Throws std::logic_error if there is none.
const Way& way_of(std::string_view calibration, Given given);

/// Its preparation with the bearing in degrees or the speed in m/s.
std::string preparation_of(const Way& way, double number = 0.0);

}  // namespace yuragi::daemon::tools::calibration
