#include "drivers/decode/microphone/mic_direction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "drivers/decode/microphone/mic_block.hpp"

namespace yuragi::drivers::decode::microphone {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kCalm_m_s = 0.3;
/// Modulation s1 / s0 at which the confidence of a steady side is one half.
constexpr double kHalfModulation = 0.1;

using Matrix3 = std::array<std::array<double, 3>, 3>;

double determinant(const Matrix3& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// The solution of m x = b, by Cramer's rule: three unknowns, solved once.
std::array<double, 3> solve_three(const Matrix3& m, const std::array<double, 3>& b) {
  const double whole = determinant(m);
  std::array<double, 3> x{};
  for (std::size_t i = 0; i < 3; ++i) {
    Matrix3 replaced = m;
    for (std::size_t row = 0; row < 3; ++row) replaced[row][i] = b[row];
    x[i] = determinant(replaced) / whole;
  }
  return x;
}

}  // namespace

MicDirection::MicDirection(const std::vector<double>& faces_deg, double smoothing_s) : smoothing_s_(smoothing_s) {
  if (faces_deg.size() < 3 || faces_deg.size() > kMicMaxChannels) {
    throw std::invalid_argument("a direction needs three or four microphones that face in different directions");
  }
  // Normal equations of the fit, which are the same for every block.
  std::vector<std::array<double, 3>> basis;
  Matrix3 normal{};
  for (const double face_deg : faces_deg) {
    basis.push_back({1.0, std::cos(face_deg * kDegree), std::sin(face_deg * kDegree)});
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) normal[i][j] += basis.back()[i] * basis.back()[j];
    }
  }
  // 6.75 for three faces at thirds of the circle; near 0 if two of three face the same way.
  if (determinant(normal) < 0.5) {
    throw std::invalid_argument("the microphones' faces are too similar for a direction: spread them out");
  }
  for (const auto& row : basis) {
    const auto weights = solve_three(normal, row);
    fit_.push_back({weights[0], weights[1], weights[2]});
  }
}

void MicDirection::restart() noexcept {
  north_ = east_ = mean_ = length_ = weight_ = 0.0;
}

std::optional<MicDirectionEstimate> MicDirection::add(std::span<const double> speeds_m_s, double duration_s) noexcept {
  Weights now{};
  for (std::size_t i = 0; i < fit_.size(); ++i) {
    now.mean += fit_[i].mean * speeds_m_s[i];
    now.north += fit_[i].north * speeds_m_s[i];
    now.east += fit_[i].east * speeds_m_s[i];
  }

  // Smoothed as a vector that grows with the wind: a gust weighs more than a lull.
  const double keep = std::exp(-duration_s / smoothing_s_);
  const auto follow = [&](double& value, double next) { value = keep * value + (1.0 - keep) * next; };
  follow(north_, now.north);
  follow(east_, now.east);
  follow(mean_, now.mean);
  follow(length_, std::hypot(now.north, now.east));
  follow(weight_, 1.0);

  const double length = std::hypot(north_, east_);
  if (!(mean_ > kCalm_m_s * weight_) || !(length > 0.0) || !(length_ > 0.0)) return std::nullopt;
  const double modulation = length / mean_;
  double direction_deg = std::atan2(east_, north_) / kDegree;
  if (direction_deg < 0.0) direction_deg += 360.0;
  if (direction_deg >= 360.0) direction_deg = 0.0;
  return MicDirectionEstimate{direction_deg,
                              std::min(1.0, length / length_) * modulation / (modulation + kHalfModulation)};
}

}  // namespace yuragi::drivers::decode::microphone
