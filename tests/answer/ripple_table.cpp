#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <variant>
#include <vector>

#include "tests/answer/scene_table.hpp"
#include "tests/answer/spectra.hpp"
#include "tests/answer/wave_field.hpp"

// Water. Sources of the bounds: the mean square slope of a clean surface is 0.003 + 0.00512 U, that along the wind 1.2
// to 1.5 times that across it (Cox and Munk 1954), waves finer than this grid's counted; and waves on deep water go at
// sqrt(g lambda / 2 pi + 2 pi sigma / (rho lambda)).

namespace yuragi::answer {
namespace {

constexpr std::array kRippleBounds = {
    Bound{"mean square slope", "", 4, {{{0.0003, 0.004}, {0.009, 0.026}, {0.018, 0.051}, {0.028, 0.083}}}},
    Bound{"slope variance along / across the wind", "", 2, {{kAny, {0.85, 1.8}, {0.85, 2.2}, {0.85, 2.4}}}},
    Bound{"strongest waves, length", "m", 2, {}},
    Bound{"speed of the strongest waves / dispersion", "", 2, {{kAny, {0.65, 1.1}, {0.65, 1.1}, {0.65, 1.1}}}},
    Bound{"slope variance with the wind, correlation", "", 2, {{at_least(0.6), at_least(0.4), at_least(0.3), kAny}}},
};

/// Slopes are taken at every so many ticks, and waves at that tick and the next.
constexpr std::size_t kSlopeTicks = 15;
constexpr std::size_t kWaveTicks = 30;

class RippleMeter final : public Meter {
 public:
  explicit RippleMeter(const pose::Skeleton& skeleton) : RippleMeter(std::get<pose::SurfaceSkeleton>(skeleton)) {}

  bool needs_joints(std::size_t tick) const override { return tick % kSlopeTicks < 2; }

  void take(std::size_t tick, const pose::Pose& /*pose*/, const pose::Kinematics& joints) override {
    if (!needs_joints(tick)) return;
    const std::span<const float> up_m = std::get<pose::PointPositions>(joints.joints()).axis_m(1);
    const bool is_second = tick % kSlopeTicks == 1;
    if (is_second) {
      for (std::size_t i = 0; i < up_m.size(); ++i) {
        largest_step_m_ = std::max(largest_step_m_, std::abs(static_cast<double>(up_m[i]) - heights_m_[i]));
      }
    }
    std::copy(up_m.begin(), up_m.end(), heights_m_.begin());
    if (!is_second) take_slopes();
    if (tick % kWaveTicks < 2) waves_.take(heights_m_, is_second);
  }

  Horizontal direction(const pose::Pose& /*pose*/, const pose::Kinematics& /*joints*/) const override { return {}; }
  double largest_step_m() const override { return largest_step_m_; }

  Figures figures(const WindRecord& wind) const override {
    const Horizontal ahead = wind.downwind();
    const double xx = mean(slope_xx_);
    const double xz = mean(slope_xz_);
    const double zz = mean(slope_zz_);
    const double along =
        ahead.east * ahead.east * xx + 2.0 * ahead.east * ahead.south * xz + ahead.south * ahead.south * zz;
    const double across = xx + zz - along;

    const WaveField::Strongest waves = waves_.strongest(ahead);
    return {
        {"mean square slope", xx + zz},
        {"slope variance along / across the wind", along / across},
        {"strongest waves, length", waves.length_m},
        {"speed of the strongest waves / dispersion", waves.speed_m_s / dispersion_m_s(waves.length_m)},
        {"slope variance with the wind, correlation", with_wind(wind)},
    };
  }

  std::vector<Trace> traces(const WindRecord& /*wind*/) const override {
    Series slope;  // as long as the others
    for (const float value : squared_slope()) slope.insert(slope.end(), kSlopeTicks, value);
    return {{"mean square slope", "", slope}};
  }

 private:
  explicit RippleMeter(const pose::SurfaceSkeleton& water)
      : size_(water.columns),
        pitch_m_(static_cast<double>(water.rest_x_m[1] - water.rest_x_m[0])),
        heights_m_(size_ * size_, 0.0),
        waves_(size_, pitch_m_ * static_cast<double>(size_), kRate_hz) {}

  static double dispersion_m_s(double length_m) {
    constexpr double kGravity_m_s2 = 9.81;
    constexpr double kTension_m3_s2 = 0.0728 / 998.0;  ///< surface tension over density
    constexpr double kTurn = 2.0 * std::numbers::pi;
    return std::sqrt(kGravity_m_s2 * length_m / kTurn + kTurn * kTension_m3_s2 / length_m);
  }

  void take_slopes() {
    double xx = 0.0, xz = 0.0, zz = 0.0;
    for (std::size_t row = 0; row + 1 < size_; ++row) {
      for (std::size_t column = 0; column + 1 < size_; ++column) {
        const std::size_t i = row * size_ + column;
        const double x = (heights_m_[i + 1] - heights_m_[i]) / pitch_m_;
        const double z = (heights_m_[i + size_] - heights_m_[i]) / pitch_m_;
        xx += x * x;
        xz += x * z;
        zz += z * z;
      }
    }
    const auto count = static_cast<double>((size_ - 1) * (size_ - 1));
    slope_xx_.push_back(static_cast<float>(xx / count));
    slope_xz_.push_back(static_cast<float>(xz / count));
    slope_zz_.push_back(static_cast<float>(zz / count));
  }

  Series squared_slope() const {
    Series all = slope_xx_;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] += slope_zz_[i];
    return all;
  }

  /// The correlation of the slopes with the wind's speed, both averaged over 2 s, at the lag from 0 to 3 s at which it
  /// is largest: waves take their time.
  double with_wind(const WindRecord& wind) const {
    constexpr std::size_t kMean = kAnswerTicks / kSlopeTicks;
    const Series speed_m_s = wind.speed_m_s();
    Series thinned_m_s;
    for (std::size_t i = 0; i < speed_m_s.size(); i += kSlopeTicks) thinned_m_s.push_back(speed_m_s[i]);
    constexpr double kSlopes_hz = kRate_hz / static_cast<double>(kSlopeTicks);
    return lag_of(running_mean(thinned_m_s, kMean), running_mean(squared_slope(), kMean), kSlopes_hz, 0.0, 3.0)
        .correlation;
  }

  std::size_t size_;  ///< points an edge
  double pitch_m_;
  std::vector<double> heights_m_;
  Series slope_xx_, slope_xz_, slope_zz_;
  WaveField waves_;
  double largest_step_m_ = 0.0;
};

}  // namespace

SceneTable ripple_table() {
  return {.name = "ripple",
          .scene = "ripple",
          .parameters = {},
          .bounds = {kRippleBounds.begin(), kRippleBounds.end()},
          .make_meter = [](const pose::Skeleton& skeleton) -> std::unique_ptr<Meter> {
            return std::make_unique<RippleMeter>(skeleton);
          },
          .largest_turn_deg = 0.0};
}

}  // namespace yuragi::answer
