#include "drivers/microphone/microphone_calibration.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace yuragi::drivers::microphone {

decode::microphone::MicCalibration mic_calibration_of(const ParameterValues& values) {
  if (const std::string& curve = values.text("curve"); !curve.empty()) {
    auto parsed = decode::microphone::parse_mic_curve(curve);
    if (!parsed) throw std::runtime_error("curve = \"" + curve + "\": " + parsed.error().message);
    return *parsed;
  }
  decode::microphone::MicPowerLaw law{.exponent = values.number("exponent")};
  if (const double gain_m_s = values.number("gain"); gain_m_s > 0.0) law.gain_m_s = gain_m_s;
  return law;
}

ParameterValues::Map parameters_of(const decode::microphone::MicCalibration& calibration) {
  if (const auto* law = std::get_if<decode::microphone::MicPowerLaw>(&calibration)) {
    const auto rounded = [](double value) { return std::round(1000.0 * value) / 1000.0; };
    return {{"gain", rounded(law->gain_m_s)}, {"exponent", rounded(law->exponent)}, {"curve", std::string()}};
  }
  return {{"curve", decode::microphone::format_mic_curve(std::get<decode::microphone::MicCurve>(calibration))}};
}

MicLevelSettings mic_level_settings_of(const ParameterValues& values) {
  MicLevelSettings settings{.calibration = mic_calibration_of(values),
                            .band_low_hz = values.number("band_low"),
                            .band_high_hz = values.number("band_high")};
  if (const double floor_db = values.number("noise_floor"); floor_db < 0.0) settings.noise_floor_db = floor_db;
  return settings;
}

}  // namespace yuragi::drivers::microphone
