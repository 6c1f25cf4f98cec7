#pragma once

#include "drivers/decode/microphone/mic_calibration.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi {

/// What the microphone driver's parameters say of its calibration: a curve where one is written, else the power law; a
/// gain of 0 (not calibrated) is taken for MicPowerLaw's own. Throws std::runtime_error for a curve that is none.
MicCalibration mic_calibration_of(const ParameterValues& values);

/// The way back: the parameters gain, exponent and curve that say it, in as many digits as a microphone is worth.
ParameterValues::Map parameters_of(const MicCalibration& calibration);

}  // namespace yuragi
