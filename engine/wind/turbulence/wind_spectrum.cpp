#include "engine/wind/turbulence/wind_spectrum.hpp"

#include <cmath>
#include <numbers>

#include "engine/wind/turbulence/von_karman.hpp"
#include "engine/wind/turbulence/wind_profile.hpp"

namespace yuragi::wind::turbulence {
namespace {

constexpr double kOpenCountryRoughness_m = 0.03;

/// f S over its scale as a function of the reduced frequency x, divided by x, so that it has a value at 0.
using Shape = double (*)(double x) noexcept;

/// a / (1 + b x)^(5/3): its integral is 1.5 a / b.
double blunt(double a, double b, double x) noexcept {
  return a / std::pow(1.0 + b * x, 5.0 / 3.0);
}
double pointed(double a, double b, double x) noexcept {
  return a / (1.0 + b * std::pow(x, 5.0 / 3.0));
}
double blunt_integral(double a, double b) noexcept {
  return 1.5 * a / b;
}
/// The integral of a / (1 + b x^p) is a b^(-1/p) (pi/p) / sin(pi/p).
double pointed_integral(double a, double b) noexcept {
  constexpr double kTurn = 3.0 / 5.0 * std::numbers::pi;
  return a * std::pow(b, -3.0 / 5.0) * kTurn / std::sin(kTurn);
}

double simiu_u(double n) noexcept {
  return blunt(200.0, 50.0, n);
}
double simiu_v(double n) noexcept {
  return blunt(15.0, 9.5, n);
}
double simiu_w(double n) noexcept {
  return pointed(3.36, 10.0, n);
}
double kaimal_u(double n) noexcept {
  return blunt(105.0, 33.0, n);
}
double kaimal_v(double n) noexcept {
  return blunt(17.0, 9.5, n);
}
double kaimal_w(double n) noexcept {
  return pointed(2.1, 5.3, n);
}
double davenport_u(double x) noexcept {
  return 4.0 * x / std::pow(1.0 + x * x, 4.0 / 3.0);
}
double von_karman_vw(double x) noexcept {
  return 4.0 * (1.0 + 755.2 * x * x) / std::pow(1.0 + 283.2 * x * x, 11.0 / 6.0);
}
double iec_kaimal(double x) noexcept {
  return blunt(4.0, 6.0, x);
}

/// A model's formula for one component.
struct Form {
  Shape shape = nullptr;  ///< nullptr: nothing
  double integral = 0.0;  ///< of the shape over x, exact for the printed constants
};

/// The integral over x from 0 on of 4 / (1 + c x^2)^(5/6): with t = x sqrt(c), a beta function.
double von_karman_integral_u() noexcept {
  return 4.0 / std::sqrt(kVonKarmanBend) * 0.5 * std::beta(0.5, 1.0 / 3.0);
}
/// The same of 4 (1 + d x^2) / (1 + c x^2)^(11/6).
double von_karman_integral_vw() noexcept {
  constexpr double c = 283.2;
  constexpr double d = 755.2;
  return 4.0 / std::sqrt(c) * 0.5 * (std::beta(0.5, 4.0 / 3.0) + d / c * std::beta(1.5, 1.0 / 3.0));
}

Form form_of(SpectrumModel model, WindComponent component) noexcept {
  const bool is_u = component == WindComponent::kAlong;
  const bool is_v = component == WindComponent::kAcross;
  switch (model) {
    case SpectrumModel::kSimiu:
      if (is_u) return {simiu_u, blunt_integral(200.0, 50.0)};
      return is_v ? Form{simiu_v, blunt_integral(15.0, 9.5)} : Form{simiu_w, pointed_integral(3.36, 10.0)};
    case SpectrumModel::kKaimal:
      if (is_u) return {kaimal_u, blunt_integral(105.0, 33.0)};
      return is_v ? Form{kaimal_v, blunt_integral(17.0, 9.5)} : Form{kaimal_w, pointed_integral(2.1, 5.3)};
    case SpectrumModel::kDavenport:
      return is_u ? Form{davenport_u, 6.0} : Form{};
    case SpectrumModel::kVonKarman:
      return is_u ? Form{von_karman_density, von_karman_integral_u()} : Form{von_karman_vw, von_karman_integral_vw()};
    case SpectrumModel::kIecKaimal:
      return {iec_kaimal, blunt_integral(4.0, 6.0)};
  }
  return {};
}

bool is_scaled_by_sigma(SpectrumModel model) noexcept {
  return model == SpectrumModel::kVonKarman || model == SpectrumModel::kIecKaimal;
}

bool is_positive(double value) noexcept {
  return std::isfinite(value) && value > 0.0;
}

/// Panofsky and Dutton 1984: sigma over u* in neutral air.
double sigma_per_friction_velocity(WindComponent component) noexcept {
  constexpr std::array<double, 3> kRatios = {2.39, 1.92, 1.25};
  return kRatios[static_cast<std::size_t>(component)];
}

/// The x of the model's formula over f.
double time_of(const SpectrumSettings& settings) noexcept {
  const double u = settings.speed_m_s;
  const double length_m = settings.length_m.value_or(iec_length_scale_m(WindComponent::kAlong, settings.height_m));
  const bool is_u = settings.component == WindComponent::kAlong;
  switch (settings.model) {
    case SpectrumModel::kSimiu:
    case SpectrumModel::kKaimal:
      return settings.height_m / u;
    case SpectrumModel::kDavenport:
      return 1200.0 / u;
    case SpectrumModel::kVonKarman:
      return (is_u ? length_m : 0.5 * length_m) / u;
    case SpectrumModel::kIecKaimal:
      return length_m * iec_length_scale_m(settings.component, settings.height_m) /
             iec_length_scale_m(WindComponent::kAlong, settings.height_m) / u;
  }
  return 0.0;
}

std::optional<SpectrumError> fault_of(const SpectrumSettings& settings) noexcept {
  if (form_of(settings.model, settings.component).shape == nullptr) return SpectrumError::kNoSuchComponent;
  if (!is_positive(settings.speed_m_s)) return SpectrumError::kSpeedOutOfRange;
  if (!is_positive(settings.height_m)) return SpectrumError::kHeightOutOfRange;
  if (const auto& sigma = settings.sigma_m_s) {
    if (!std::isfinite(*sigma) || *sigma < 0.0 || settings.friction_velocity_m_s)
      return SpectrumError::kSigmaOutOfRange;
  }
  if (const auto& friction = settings.friction_velocity_m_s) {
    if (!std::isfinite(*friction) || *friction < 0.0) return SpectrumError::kFrictionVelocityOutOfRange;
  }
  if (const auto& length = settings.length_m) {
    if (!is_positive(*length) || !is_scaled_by_sigma(settings.model)) return SpectrumError::kLengthOutOfRange;
  }
  const bool needs_profile =
      !is_scaled_by_sigma(settings.model) && !settings.sigma_m_s && !settings.friction_velocity_m_s;
  if (needs_profile && settings.height_m <= kOpenCountryRoughness_m) return SpectrumError::kHeightOutOfRange;
  return std::nullopt;
}

}  // namespace

std::string_view explain(SpectrumError error) noexcept {
  switch (error) {
    case SpectrumError::kSpeedOutOfRange:
      return "the mean speed must be above 0 m/s";
    case SpectrumError::kHeightOutOfRange:
      return "the height must be above 0 m, and above the roughness of 0.03 m if u* is computed from it";
    case SpectrumError::kSigmaOutOfRange:
      return "sigma must be 0 m/s or more, and cannot be given together with u*";
    case SpectrumError::kFrictionVelocityOutOfRange:
      return "u* must be 0 m/s or more";
    case SpectrumError::kLengthOutOfRange:
      return "the length must be above 0 m, and only von-karman and iec-kaimal have one";
    case SpectrumError::kNoSuchComponent:
      return "davenport is defined for component u only";
  }
  return "?";
}

Result<WindSpectrum, SpectrumError> WindSpectrum::make(const SpectrumSettings& settings) noexcept {
  if (const auto error = fault_of(settings)) return *error;
  const Form form = form_of(settings.model, settings.component);
  WindSpectrum spectrum;
  spectrum.shape_ = form.shape;
  spectrum.time_s_ = time_of(settings);

  if (is_scaled_by_sigma(settings.model)) {
    // The formula itself is for a variance of s^2: its printed constants integrate to 1 within a few in 10,000.
    double sigma_m_s = iec_sigma_m_s(IecTurbulenceClass::kB, settings.component, settings.speed_m_s);
    if (settings.friction_velocity_m_s) {
      sigma_m_s = sigma_per_friction_velocity(settings.component) * *settings.friction_velocity_m_s;
    }
    if (settings.sigma_m_s) sigma_m_s = *settings.sigma_m_s;
    spectrum.scale_m2_s2_ = sigma_m_s * sigma_m_s;
  } else if (settings.sigma_m_s) {
    spectrum.scale_m2_s2_ = *settings.sigma_m_s * *settings.sigma_m_s / form.integral;
  } else {
    const double friction_m_s =
        settings.friction_velocity_m_s
            ? *settings.friction_velocity_m_s
            : friction_velocity_m_s(settings.speed_m_s,
                                    settings.model == SpectrumModel::kDavenport ? 10.0 : settings.height_m,
                                    kOpenCountryRoughness_m);
    spectrum.scale_m2_s2_ = friction_m_s * friction_m_s;
  }
  spectrum.variance_m2_s2_ = spectrum.scale_m2_s2_ * form.integral;
  return spectrum;
}

double WindSpectrum::density_m2_s2_hz(double frequency_hz) const noexcept {
  return scale_m2_s2_ * time_s_ * shape_(frequency_hz * time_s_);
}

}  // namespace yuragi::wind::turbulence
