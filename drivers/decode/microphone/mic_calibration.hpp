#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/base/result.hpp"

namespace yuragi::drivers::decode::microphone {

// From the level of wind noise to wind speed (drivers/SOURCES.md S6.1). A bare microphone measures stagnation pressure,
// whose root mean square in a low band goes as U^n; published exponents range from 1.3 to 3.2 with site and mount, so
// that gain and exponent belong to one installation and are fitted there, beside any other anemometer.

/// U = gain (P - P_noise)^(1 / (2 n)), with P the mean square in the band (full scale 1) and P_noise that of a calm.
struct MicPowerLaw {
  double gain_m_s = 20.0;  ///< the wind that would bring the band to a mean square of 1
  double exponent = 2.0;   ///< n

  bool operator==(const MicPowerLaw&) const = default;
};

/// One point of a curve, or one pair to fit one to.
struct MicLevelAndSpeed {
  double level_db = 0.0;  ///< 10 log10 of the mean square in the band, full scale 1
  double speed_m_s = 0.0;

  bool operator==(const MicLevelAndSpeed&) const = default;
};

/// Straight lines from point to point: at least two, levels rising, speeds never falling. Below the first point it is
/// flat; above the last it continues with the same slope. The noise of a calm is part of it.
struct MicCurve {
  std::vector<MicLevelAndSpeed> points;

  bool operator==(const MicCurve&) const = default;
};

using MicCalibration = std::variant<MicPowerLaw, MicCurve>;

/// The wind of a band power, between 0 and kMaxPlausibleSpeed_m_s, never falling with the power. `noise_power` is used
/// by a power law. Thread-safe and realtime-safe: yes.
double mic_speed_m_s(const MicCalibration& calibration, double power, double noise_power) noexcept;

/// The inverse: returns the level of a band, dB, that gives this wind; nullopt if many levels do (a calm). Thread-safe
/// and realtime-safe: yes.
std::optional<double> mic_level_db(const MicCalibration& calibration, double speed_m_s, double noise_power) noexcept;

/// "-62:0 -50:1.2 -40:3.4" (dB:m/s). The failure's text: what is wrong.
Result<MicCurve, Failure> parse_mic_curve(std::string_view text);
std::string format_mic_curve(const MicCurve& curve);

/// The result of a fit.
struct MicFit {
  MicCalibration calibration;
  double mean_error_m_s = 0.0;  ///< mean absolute error on pairs that the fit did not see (see fit_mic_calibration)
};

/// The power law with the least squared error in speed. Fails with too few pairs or too little difference between them.
Result<MicPowerLaw, Failure> fit_mic_power_law(std::span<const MicLevelAndSpeed> pairs, double noise_power);

/// The power law through two known winds; the noise is taken off both. Fails if they are too similar, or if no power
/// law goes through both.
Result<MicPowerLaw, Failure> mic_power_law_through(const MicLevelAndSpeed& soft, const MicLevelAndSpeed& loud,
                                                   double noise_power);

/// A parabola in the level by least squares, held level on the side where it would turn back, as a curve. Fails
/// likewise.
Result<MicCurve, Failure> fit_mic_curve(std::span<const MicLevelAndSpeed> pairs);

/// Which fits to try: a power law needs levels from which the noise of a calm can be taken off (or has been), a curve
/// levels that include it.
enum class MicFitKind : std::uint8_t { kPowerLawOrCurve, kPowerLaw, kCurve };

/// A power law, which extrapolates beyond the pairs, unless a curve is better by a tenth. Each is fitted to every
/// second pair and tried on the others, by the mean absolute error, and what is chosen is fitted to all. Pairs in the
/// order of time, each a mean of some seconds; at least 8, over at least 1 m/s and 3 dB.
Result<MicFit, Failure> fit_mic_calibration(std::span<const MicLevelAndSpeed> pairs, double noise_power = 0.0,
                                            MicFitKind kind = MicFitKind::kPowerLawOrCurve);

}  // namespace yuragi::drivers::decode::microphone
