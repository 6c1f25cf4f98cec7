#pragma once

#include "drivers/decode/microphone/mic_calibration.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi {

/// The calibration by the microphone driver's parameters: a curve where one is given, else the power law; a
/// gain of 0 (not calibrated) is taken for MicPowerLaw's own. Throws std::runtime_error for a curve that is none.
MicCalibration mic_calibration_of(const ParameterValues& values);

/// The inverse: the parameters gain, exponent and curve, with as many digits as a microphone's accuracy justifies.
ParameterValues::Map parameters_of(const MicCalibration& calibration);

}  // namespace yuragi
