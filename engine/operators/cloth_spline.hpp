#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/operators/cloth_dynamics.hpp"

namespace yuragi {

/// The way from a coarse cloth's leans to those of all links: a uniform cubic B-spline in both directions (de Boor
/// 1978, "A practical guide to splines"). Smooth to the second derivative, and a mean with weights of at least 0, so
/// that it never exceeds or outpaces what it goes through. Holds the weights, and the coarse rows spread over all
/// columns. Allocates when it is made. Thread-safe: no. Realtime-safe: spread().
class ClothSpline {
 public:
  ClothSpline(const CoarseCloth& coarse, std::size_t columns, std::size_t links);

  /// Takes over the leans of `coarse`, which has the size that this was made for. Cost: about 10 us.
  void spread(const CoarseCloth& coarse, SimdRow row) noexcept;

 private:
  friend struct ClothSplineJob;

  std::size_t width_, links_, coarse_links_;
  std::size_t taps_ = 0;
  std::vector<std::size_t> first_;  ///< coarse column of each block's first tap
  std::vector<float> weights_;      ///< [block][tap][column of the block]
  std::vector<float> spread_;       ///< a row a coarse link
};

/// out += share * the spline's leans, of the links from first_link on: a row a link, east of all columns, then south.
/// Leans of 0 change no bit. Owns nothing. Thread-safe: jobs with different `out`, yes. Realtime-safe: yes. Every SIMD
/// row computes the same bits. Cost: about 0.15 ns a value (x86-64-v3).
struct ClothSplineJob {
  const ClothSpline* spline = nullptr;
  float share = 1.0F;  ///< finite
  std::size_t first_link = 0;
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> out;

  enum class Problem : std::uint8_t { kNone, kNoSpline, kShareNotFinite, kSizesDiffer, kRowNotRunnable };
  [[nodiscard]] Problem validate() const noexcept;

  /// Does the work, if validate() has nothing against it; returns what validate() says.
  Problem run() const noexcept;
};

}  // namespace yuragi
