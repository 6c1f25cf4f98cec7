#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi {

/// The projection operator of leaves: each leans with the wind and flutters by its noise, as much as its petiole lets
/// it (Chiba, section 3.3). The bend, in StrandPose's meaning, is flexibility (lean + flutter noise) W, W = s^2 / (1 +
/// s^2) with s = wind / half_flutter_speed, toward where the wind blows to, turned by the leaf's own twist (its cosine
/// and sine), since no two leaves stand alike. Calm gives (0, 0). m/s, radians. All spans have the same size; the
/// outputs overlap nothing else. Owns nothing. Thread-safe: jobs with different outputs, yes. Realtime-safe: yes. Every
/// SIMD row computes the same bits. Cost: about 0.5 ns a leaf (x86-64-v3).
struct FlutterJob {
  double wind_east_m_s = 0.0;
  double wind_south_m_s = 0.0;
  std::span<const float> noise;  ///< at each leaf
  std::span<const float> along;  ///< compliance of each petiole: 1 is that of the softest
  std::span<const float> across;
  double half_flutter_speed_m_s = 5.0;  ///< at least 0.01
  double lean_rad = 0.4;
  double flutter_rad = 0.3;                   ///< for a noise of 1
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> bend_east_rad;
  std::span<float> bend_south_rad;

  enum class Problem : std::uint8_t {
    kNone,
    kWindNotFinite,     ///< or so strong (1e154 m/s) that its square is not
    kHalfFlutterSpeed,  ///< not a number of at least 0.01 m/s
    kAngles,            ///< lean or flutter is not finite
    kSizesDiffer,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Does the work, if validate() has nothing against it; returns what validate() says.
  Problem run() const noexcept;
};

}  // namespace yuragi
