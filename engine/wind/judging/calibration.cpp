#include "engine/wind/judging/calibration.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

namespace yuragi::wind::judging {
namespace {

std::optional<double> number_of(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
  return is_number ? std::optional(value) : std::nullopt;
}

/// Linear between the points, and on in the same direction beyond the first and the last.
double on_curve(const std::vector<CalibrationPoint>& curve, double measured_m_s) noexcept {
  std::size_t upper = 1;
  while (upper + 1 < curve.size() && measured_m_s > curve[upper].measured_m_s) ++upper;
  const CalibrationPoint& a = curve[upper - 1];
  const CalibrationPoint& b = curve[upper];
  return a.true_m_s + (measured_m_s - a.measured_m_s) * (b.true_m_s - a.true_m_s) / (b.measured_m_s - a.measured_m_s);
}

double calibrated_speed_m_s(const Calibration& calibration, double speed_m_s) noexcept {
  if (speed_m_s <= 0.0) return 0.0;
  double speed = calibration.gain * calibration.unit_m_s * speed_m_s + calibration.offset_m_s;
  if (calibration.curve.size() >= 2) speed = on_curve(calibration.curve, speed);
  return std::clamp(calibration.height_factor * speed, 0.0, kMaxPlausibleSpeed_m_s);
}

}  // namespace

Reading Calibration::applied_to(const Reading& reading) const noexcept {
  Reading calibrated = reading;
  calibrated.speed_m_s = calibrated_speed_m_s(*this, reading.speed_m_s);
  if (reading.gust_m_s) calibrated.gust_m_s = calibrated_speed_m_s(*this, *reading.gust_m_s);
  if (reading.direction_deg) {
    const double turned_deg = std::fmod(*reading.direction_deg + north_offset_deg, 360.0);
    calibrated.direction_deg = turned_deg < 0.0 ? turned_deg + 360.0 : turned_deg;
    if (*calibrated.direction_deg >= 360.0) calibrated.direction_deg = 0.0;  // a tiny negative, rounded
  }
  return calibrated;
}

double zero_point_m_s(const Calibration& calibration) noexcept {
  double before_curve_m_s = 0.0;
  if (calibration.curve.size() >= 2) {
    const CalibrationPoint& a = calibration.curve[0];
    const CalibrationPoint& b = calibration.curve[1];
    before_curve_m_s = a.measured_m_s - a.true_m_s * (b.measured_m_s - a.measured_m_s) / (b.true_m_s - a.true_m_s);
  }
  return (before_curve_m_s - calibration.offset_m_s) / calibration.gain;
}

Result<std::vector<CalibrationPoint>, Failure> parse_calibration_curve(std::string_view text) {
  const Failure failure{"\"" + std::string(text) +
                        "\" is not a curve; allowed: two or more points measured:true in m/s, both rising, such as "
                        "\"0:0 5:5.2 12:12.9\""};
  std::vector<CalibrationPoint> curve;
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    if (text.empty()) break;
    const std::string_view point = text.substr(0, text.find_first_of(" \t"));
    text.remove_prefix(point.size());
    const std::size_t colon = point.find(':');
    if (colon == std::string_view::npos) return failure;
    const auto measured = number_of(point.substr(0, colon));
    const auto truth = number_of(point.substr(colon + 1));
    if (!measured || !truth || *measured < 0.0 || *truth < 0.0) return failure;
    const bool rises = curve.empty() || (*measured > curve.back().measured_m_s && *truth > curve.back().true_m_s);
    if (!rises) return failure;
    curve.push_back({*measured, *truth});
  }
  if (curve.size() == 1) return failure;
  return curve;
}

double height_factor(double from_m, double to_m, double roughness_m) noexcept {
  const auto above_ground = [roughness_m](double height_m) {
    return std::log(std::max(height_m, 10.0 * roughness_m) / roughness_m);
  };
  return above_ground(to_m) / above_ground(from_m);
}

}  // namespace yuragi::wind::judging
