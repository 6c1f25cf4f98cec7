#pragma once

#include <optional>
#include <span>

#include "drivers/decode/microphone/mic_calibration.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::drivers::microphone {

/// The parameters gain, exponent and curve of a calibration, with as many digits as a microphone's accuracy justifies.
ParameterValues::Map parameters_of(const decode::microphone::MicCalibration& calibration);

/// The unit of a microphone's level, and the corresponding speeds.
struct MicLevelSettings {
  decode::microphone::MicCalibration calibration{};
  bool is_calibrated = false;              ///< or `calibration` is a common one
  std::optional<double> noise_floor_db{};  ///< level of a calm, below 0; none: it is estimated while running
  double band_low_hz = 0.0;                ///< the band whose power is the level
  double band_high_hz = 0.0;
};

/// The driver's parameters of these, from band_low to noise_floor.
std::span<const Parameter> mic_level_parameters();

/// Their values: a curve if one is given, otherwise the power law; a gain of 0 (not calibrated) is taken for
/// MicPowerLaw's own. Throws std::runtime_error for a curve that is none.
MicLevelSettings mic_level_settings_of(const ParameterValues& values);

}  // namespace yuragi::drivers::microphone
