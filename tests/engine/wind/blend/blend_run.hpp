#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "engine/wind/blend/blended_estimator.hpp"

namespace yuragi::wind::blend {

inline constexpr double kBlendTick_s = 1.0 / 60.0;

/// The noise that all tests of the blend share.
inline std::shared_ptr<const turbulence::GustNoise> shared_gust_noise() {
  static const auto shared = std::make_shared<const turbulence::GustNoise>(turbulence::GustNoiseSettings{});
  return shared;
}

/// An estimator, and a wind that is read every now and then; time is moved by hand.
class BlendRun {
 public:
  explicit BlendRun(std::size_t sources, const Settings& settings)
      : estimator_(sources, settings, shared_gust_noise()) {
    state_ = estimator_.advance(now_);
  }

  /// A climate of 4 m/s from south.
  static Settings usual(std::uint64_t seed = 1, double turbulence_intensity = 0.2) {
    return {.climate = {.mean_speed_m_s = 4.0,
                        .mean_direction_deg = 180.0,
                        .turbulence_intensity = turbulence_intensity,
                        .seed = seed}};
  }

  MonoTime now() const { return now_; }
  State state() const { return state_; }
  BlendedEstimator& estimator() { return estimator_; }
  SourceReport report(std::size_t source = 0) const { return estimator_.report(source); }

  bool read(double speed_m_s, std::optional<double> direction_deg, std::size_t source = 0) {
    Reading reading;
    reading.time.mono = now_;
    reading.speed_m_s = speed_m_s;
    reading.direction_deg = direction_deg;
    return estimator_.accept(source, reading);
  }

  /// Goes on for so long; `each` is called at each tick.
  void run_for(double duration_s, const std::function<void(const State&)>& each = {}) {
    const auto ticks = static_cast<int>(std::lround(duration_s / kBlendTick_s));
    for (int tick = 0; tick < ticks; ++tick) {
      now_ += from_seconds(kBlendTick_s);
      const Vector before = state_.wind;
      state_ = estimator_.advance(now_);
      largest_step_m_s_ = std::max(largest_step_m_s_, speed_of(state_.wind - before));
      if (each) each(state_);
    }
  }

  void read_for(double duration_s, double interval_s, double speed_m_s, std::optional<double> direction_deg,
                std::size_t source = 0, const std::function<void(const State&)>& each = {}) {
    const auto readings = static_cast<int>(std::lround(duration_s / interval_s));
    for (int i = 0; i < readings; ++i) {
      read(speed_m_s, direction_deg, source);
      run_for(interval_s, each);
    }
  }

  /// Time goes by without anyone asking for the wind.
  void halt_for(MonoTime::duration duration) { now_ += duration; }

  double take_largest_step_m_s() { return std::exchange(largest_step_m_s_, 0.0); }

 private:
  BlendedEstimator estimator_;
  MonoTime now_{std::chrono::hours(1)};
  State state_;
  double largest_step_m_s_ = 0.0;
};

/// Mean, and variance about it, of the states of a while.
struct BlendMoments {
  Vector sum{};
  double squares_u = 0.0, squares_v = 0.0;
  int count = 0;
  void add(const State& state) {
    sum = sum + state.wind;
    squares_u += state.wind.u_m_s * state.wind.u_m_s;
    squares_v += state.wind.v_m_s * state.wind.v_m_s;
    ++count;
  }
  Vector mean() const { return (1.0 / count) * sum; }
  double variance_u() const { return squares_u / count - mean().u_m_s * mean().u_m_s; }
  double variance_v() const { return squares_v / count - mean().v_m_s * mean().v_m_s; }
  double variance() const { return variance_u() + variance_v(); }
};

/// Gusts that last for about 8 s, as a sensor hears them once a second: unit variance.
class TestGusts {
 public:
  explicit TestGusts(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ULL + 1) {}
  double next() {
    value_ = kKept * value_ + std::sqrt(1.0 - kKept * kKept) * normal();
    return value_;
  }
  /// White noise of unit variance, nearly normal: the sum of twelve uniform numbers.
  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) {
      state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
      sum += static_cast<double>(state_ >> 11U) * 0x1p-53;
    }
    return sum;
  }

 private:
  static constexpr double kKept = 0.88;
  std::uint64_t state_;
  double value_ = 0.0;
};

}  // namespace yuragi::wind::blend
