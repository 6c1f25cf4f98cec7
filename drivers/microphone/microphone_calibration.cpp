#include "drivers/microphone/microphone_calibration.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "engine/base/fields.hpp"

namespace yuragi::drivers::microphone {

namespace {

struct LevelKeys {
  MicLevelSettings settings;
  double gain_m_s = 0.0;
  double exponent = 0.0;
  std::string curve;
};

auto of_level(auto member) {
  return member_of(&LevelKeys::settings, member);
}

const Fields<LevelKeys>& level_fields() {
  static const Fields<LevelKeys> kLevelFields = {
      {{"band_low", "Hz", 20.0, 2.0, 1000.0,
        "lower limit of the band of the wind: the lowest frequency that the microphone passes"},
       of_level(&MicLevelSettings::band_low_hz)},
      {{"band_high", "Hz", 200.0, 10.0, 2000.0, "upper limit of the band"}, of_level(&MicLevelSettings::band_high_hz)},
      {{"gain", "m/s", 0.0, 0.0, 1e6,
        "calibration: speed = gain (P - P_noise)^(1 / (2 exponent)), P the mean square in the band; 0: not calibrated; "
        "20 is used, and every reading is uncertain"},
       &LevelKeys::gain_m_s},
      {{"exponent", "", 2.0, 0.3, 6.0,
        "calibration: exponent by which the sound's root mean square grows with the wind speed"},
       &LevelKeys::exponent},
      {{.name = "curve",
        .default_value = std::string(""),
        .help = "calibration instead of gain and exponent: points level:speed in dB:m/s, \"-62:0 -50:1.2 -40:3.4\""},
       &LevelKeys::curve},
      {{"noise_floor", "dB", 0.0, -200.0, 0.0,
        "level in a calm, relative to full scale; 0: determined while running, from the quietest 2 % of the time"},
       of_level(&MicLevelSettings::noise_floor_db),
       [](double floor_db) { return floor_db < 0.0 ? std::optional(floor_db) : std::nullopt; }},
  };
  return kLevelFields;
}

decode::microphone::MicCalibration calibration_of(const LevelKeys& keys) {
  if (!keys.curve.empty()) {
    auto parsed = decode::microphone::parse_mic_curve(keys.curve);
    if (!parsed) throw std::runtime_error("curve = \"" + keys.curve + "\": " + parsed.error().message);
    return *parsed;
  }
  decode::microphone::MicPowerLaw law{.exponent = keys.exponent};
  if (keys.gain_m_s > 0.0) law.gain_m_s = keys.gain_m_s;
  return law;
}

}  // namespace

std::span<const Parameter> mic_level_parameters() {
  return level_fields().parameters();
}

MicLevelSettings mic_level_settings_of(const ParameterValues& values) {
  LevelKeys keys = level_fields().of(values);
  keys.settings.calibration = calibration_of(keys);
  keys.settings.is_calibrated = keys.gain_m_s > 0.0 || !keys.curve.empty();
  return keys.settings;
}

ParameterValues::Map parameters_of(const decode::microphone::MicCalibration& calibration) {
  if (const auto* law = std::get_if<decode::microphone::MicPowerLaw>(&calibration)) {
    const auto rounded = [](double value) { return std::round(1000.0 * value) / 1000.0; };
    return {{"gain", rounded(law->gain_m_s)}, {"exponent", rounded(law->exponent)}, {"curve", std::string()}};
  }
  return {{"curve", decode::microphone::format_mic_curve(std::get<decode::microphone::MicCurve>(calibration))}};
}

}  // namespace yuragi::drivers::microphone
