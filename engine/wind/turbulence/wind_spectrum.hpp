#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"
#include "engine/wind/turbulence/wind_component.hpp"

namespace yuragi::wind::turbulence {

// How the energy of the wind's fluctuations is spread over frequency: the named models, for analysis, fitting and
// tests. All are one-sided densities S(f) in m^2/s^2/Hz: their integral over f from 0 on is the component's variance.
// n = f z / U is the reduced frequency, u* the friction velocity, s the component's standard deviation, z the height in
// m, U the mean speed in m/s. The same table, with the integrals: engine/wind/model.md W1 to W6.
//
// clang-format off
//   model        component  f S                                                   source
//   simiu        u          u*^2 200 n / (1 + 50 n)^(5/3)                         Simiu and Scanlan 1996, Wind Effects
//                v          u*^2 15 n / (1 + 9.5 n)^(5/3)                         on Structures, ch. 2
//                w          u*^2 3.36 n / (1 + 10 n^(5/3))
//   kaimal       u          u*^2 105 n / (1 + 33 n)^(5/3)                         Kaimal, Wyngaard, Izumi, Cote 1972,
//                v          u*^2 17 n / (1 + 9.5 n)^(5/3)                         Spectral characteristics of surface-
//                w          u*^2 2.1 n / (1 + 5.3 n^(5/3))                        layer turbulence
//   davenport    u          u*^2 4 x^2 / (1 + x^2)^(4/3), x = 1200 f / U(10 m)    Davenport 1961, The spectrum of
//                                                                                 horizontal gustiness near the ground
//                                                                                 in high winds
//   von-karman   u          s^2 4 x / (1 + 70.8 x^2)^(5/6), x = f L_u / U         von Karman 1948, Progress in the
//                v, w       s^2 4 x (1 + 755.2 x^2) / (1 + 283.2 x^2)^(11/6),     statistical theory of turbulence
//                           x = f L_u / (2 U)
//   iec-kaimal   u, v, w    s^2 4 f T / (1 + 6 f T)^(5/3), T = L / U,             IEC 61400-1:2005, annex B.2
//                           L = (8.1, 2.7, 0.66) Lambda
// clang-format on

enum class SpectrumModel : std::uint8_t { kSimiu, kKaimal, kDavenport, kVonKarman, kIecKaimal };
inline constexpr std::array<std::string_view, 5> kSpectrumModelNames = {"simiu", "kaimal", "davenport", "von-karman",
                                                                        "iec-kaimal"};

/// The parameters of a spectrum. Missing ones follow from the others.
struct SpectrumSettings {
  SpectrumModel model = SpectrumModel::kVonKarman;
  WindComponent component = WindComponent::kAlong;
  double speed_m_s = 8.0;  ///< mean; of Davenport's model at 10 m, of the others at `height_m`
  double height_m = 10.0;
  /// Standard deviation of that component. Nullopt: from u*, in the models that are scaled by u*; the IEC's normal
  /// turbulence of class B in the others (iec_sigma_m_s).
  std::optional<double> sigma_m_s = std::nullopt;
  /// u*. Left out: the logarithmic profile over open country (roughness 0.03 m). Models that are scaled by s take u* to
  /// mean s = (2.39, 1.92, 1.25) u* (Panofsky and Dutton 1984, Atmospheric Turbulence, neutral air). Not with
  /// `sigma_m_s`.
  std::optional<double> friction_velocity_m_s = std::nullopt;
  /// Integral length scale of u along the wind, L_u; those of v and w are in the model's proportion. Of the models that
  /// have one (von-karman, iec-kaimal). Left out: 8.1 Lambda, the IEC's.
  std::optional<double> length_m = std::nullopt;
};

enum class SpectrumError : std::uint8_t {
  kSpeedOutOfRange,   ///< not above 0, not finite
  kHeightOutOfRange,  ///< not above 0, not finite; if u* follows from a profile, not above its roughness
  kSigmaOutOfRange,   ///< negative, not finite, or given together with u*
  kFrictionVelocityOutOfRange,
  kLengthOutOfRange,  ///< not above 0, not finite, or of a model without one
  kNoSuchComponent,   ///< Davenport's model has u only
};

/// For people: the allowed values.
std::string_view explain(SpectrumError error) noexcept;

[[noreturn]] inline void throw_exception_from_error(SpectrumError error, const boost::source_location&) {
  throw std::invalid_argument(std::string(explain(error)));
}

/// One spectrum, ready to be evaluated. Thread-safe and realtime-safe: yes.
class WindSpectrum {
 public:
  static Result<WindSpectrum, SpectrumError> make(const SpectrumSettings& settings) noexcept;

  /// S(f), m^2/s^2/Hz, f from 0 on. (At 0 it is the model's limit: 0 for Davenport's.)
  double density_m2_s2_hz(double frequency_hz) const noexcept;

  /// The integral over all frequencies, in closed form: the component's variance.
  double variance_m2_s2() const noexcept { return variance_m2_s2_; }

 private:
  /// S(f) = scale time shape(f time), where shape is the model's, without a unit: f S / scale over f time.
  double (*shape_)(double reduced) noexcept = nullptr;
  double scale_m2_s2_ = 0.0;
  double time_s_ = 0.0;  ///< reduced frequency over frequency
  double variance_m2_s2_ = 0.0;
};

}  // namespace yuragi::wind::turbulence
