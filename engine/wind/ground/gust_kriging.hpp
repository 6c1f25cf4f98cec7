#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "engine/wind/ground/wind_stroke.hpp"

namespace yuragi::wind::ground {

/// The gusts at a place by sensors at several others: simple kriging, one octave at a time (Krige 1951; Chiles and
/// Delfiner 2012, Geostatistics, 3.2; engine/wind/model.md W27). The weights of the sensors are
///
///     w = (C + N)^-1 c,
///
/// c_i the coherence of sensor i with the place, C_ij that of two sensors, N a small nugget. While a sensor comes or
/// goes its presence is between 0 and 1, and the weights are the mean of those with it and those without it, so that
/// nothing jumps, even if two sensors are nearly the same. The part w' C w of the power is known, at most 1. One lane
/// an octave.
///
/// Thread-safe: reading, yes. Realtime-safe: yes.
template <std::size_t lanes>
class GustKriging {
 public:
  static constexpr std::size_t kMost = WindStroke::kMaxPens;
  using Lanes = std::array<float, lanes>;

  /// Updates the part that depends on the wind only, not on the place, for these sensors. `coherent(i, distance_m)`:
  /// the remaining part of the gusts of sensor i at this distance of the law, for each lane.
  template <class Coherent>
  void prepare(std::span<const WindPen> pens, Vector ahead, const GustCoherence& law, Coherent coherent) noexcept {
    count_ = pens.size();
    for (std::size_t i = 0; i < count_; ++i) {
      presence_[i] = std::clamp(pens[i].presence, 0.0, 1.0);
      coherence_[i][i].fill(1.0F);
      for (std::size_t j = 0; j < i; ++j) {
        const double east_m = pens[i].east_m - pens[j].east_m;
        const double north_m = pens[j].south_m - pens[i].south_m;
        const double distance_m =
            law.distance_m(east_m * ahead.u_m_s + north_m * ahead.v_m_s, north_m * ahead.u_m_s - east_m * ahead.v_m_s);
        const Lanes one = coherent(i, distance_m);
        const Lanes other = coherent(j, distance_m);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          coherence_[i][j][lane] = coherence_[j][i][lane] = std::sqrt(one[lane] * other[lane]);
        }
      }
    }
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j < count_; ++j) inverse_[i][j].fill(0.0F);
    }
    for (unsigned there = 0; there < 1U << count_; ++there) {
      double part = 1.0;
      for (std::size_t i = 0; i < count_; ++i) part *= is_among(there, i) ? presence_[i] : 1.0 - presence_[i];
      if (part == 0.0) continue;
      for (std::size_t lane = 0; lane < lanes; ++lane) add_inverse(there, part, lane);
    }
  }

  /// The weights of the sensors at a place; coherent[i] is c_i.
  void weigh(const std::array<Lanes, kMost>& coherent, std::array<Lanes, kMost>& weights) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
      weights[i].fill(0.0F);
      for (std::size_t j = 0; j < count_; ++j) {
        for (std::size_t lane = 0; lane < lanes; ++lane) weights[i][lane] += inverse_[i][j][lane] * coherent[j][lane];
      }
    }
    const Lanes known = power(weights, [](std::size_t, std::size_t, std::size_t) { return 1.0F; });
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const float limit = 1.0F / std::sqrt(std::max(known[lane], 1.0F));
      for (std::size_t i = 0; i < count_; ++i) weights[i][lane] *= limit;
    }
  }

  /// w' (C . part) w: the known power, if each two sensors know `part(i, j, lane)` of the possible.
  template <class Part>
  Lanes power(const std::array<Lanes, kMost>& weights, Part part) const noexcept {
    Lanes sum{};
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j < count_; ++j) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          sum[lane] += weights[i][lane] * weights[j][lane] * coherence_[i][j][lane] * part(i, j, lane);
        }
      }
    }
    return sum;
  }

 private:
  static constexpr double kNugget = 0.001;

  static bool is_among(unsigned there, std::size_t i) noexcept { return (there >> i & 1U) != 0; }

  /// Adds `part` of (C + N)^-1 of the sensors in `there`. Gauss and Jordan; it is positive definite.
  void add_inverse(unsigned there, double part, std::size_t lane) noexcept {
    std::array<std::array<double, kMost>, kMost> left{}, right{};
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j < count_; ++j) {
        if (is_among(there, i) && is_among(there, j)) left[i][j] = static_cast<double>(coherence_[i][j][lane]);
      }
      left[i][i] = 1.0 + kNugget;
      right[i][i] = is_among(there, i) ? 1.0 : 0.0;
    }
    for (std::size_t pivot = 0; pivot < count_; ++pivot) {
      const double scale = 1.0 / left[pivot][pivot];
      for (std::size_t j = 0; j < count_; ++j) {
        left[pivot][j] *= scale;
        right[pivot][j] *= scale;
      }
      for (std::size_t i = 0; i < count_; ++i) {
        if (i == pivot) continue;
        const double factor = left[i][pivot];
        for (std::size_t j = 0; j < count_; ++j) {
          left[i][j] -= factor * left[pivot][j];
          right[i][j] -= factor * right[pivot][j];
        }
      }
    }
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j < count_; ++j) {
        inverse_[i][j][lane] += static_cast<float>(part * right[i][j]);
      }
    }
  }

  std::size_t count_ = 0;
  std::array<double, kMost> presence_{};
  std::array<std::array<Lanes, kMost>, kMost> coherence_{}, inverse_{};
};

}  // namespace yuragi::wind::ground
