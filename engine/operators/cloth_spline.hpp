#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"

namespace yuragi::operators {

/// A coarse grid of leans over a cloth's links. Rows of `stride` (whole blocks): a ghost before the first column, the
/// columns, and padding, whose first element is a ghost, too. Columns are spread evenly from the cloth's first to its
/// last, the ghosts one spacing beyond; links evenly along the threads. Leans have a row per link, east of all columns,
/// then south: size() values.
struct ClothKnots {
  std::size_t columns = 2;  ///< without ghosts; 2 or more, and 2 fewer than the stride or less
  std::size_t links = 1;
  std::size_t stride = 16;

  std::size_t size() const noexcept { return 2 * links * stride; }
};

/// Interpolates from a coarse grid of leans to those of all links: across the threads a uniform cubic B-spline (de Boor
/// 1978, "A practical guide to splines"), and along them such a spline too (ClothSplineJob), or straight lines
/// (ClothLineJob). A mean with weights of at least 0, so that neither values nor rates exceed those of the grid. Holds
/// the weights, and the coarse rows spread over all columns. Allocates when it is made. Thread-safe: no. Realtime-safe:
/// spread().
class ClothSpline {
 public:
  ClothSpline(const ClothKnots& knots, std::size_t columns, std::size_t links);

  /// Takes the leans of the knots for which this was made: knots.size() values. Cost: about 0.1 ns a column and link of
  /// the knots.
  void spread(std::span<const float> leans, SimdRow row) noexcept;

 private:
  friend struct ClothSplineJob;
  friend struct ClothLineJob;

  ClothKnots knots_;
  std::size_t width_, links_;
  std::size_t taps_ = 0;
  std::vector<std::size_t> first_;  ///< coarse column of each block's first tap
  std::vector<float> weights_;      ///< [block][tap][column of the block]
  std::vector<float> spread_;       ///< a row a coarse link
};

/// out += share * the spline's leans, of the links from first_link on: a row a link, east of all columns, then south.
/// Smooth to the second derivative in both directions. Leans of 0 change no bit. Owns nothing. Thread-safe: jobs with
/// different `out`, yes. Realtime-safe: yes. Every SIMD row computes the same bits. Cost: about 0.15 ns a value
/// (x86-64-v3).
struct ClothSplineJob {
  const ClothSpline* spline = nullptr;
  float share = 1.0F;  ///< finite
  std::size_t first_link = 0;
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> out;

  enum class Problem : std::uint8_t { kNone, kNoSpline, kShareNotFinite, kSizesDiffer, kRowNotRunnable };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

/// out = base + the spline's leans, of the links from first_link on, as ClothSplineJob's; but straight from knot to
/// knot along the threads, and level before the first and behind the last. The joints are still on a smooth curve,
/// because a lean is a direction. `base` is one row, the same for all links. Leans of 0 give `base` to the bit. Owns
/// nothing. Thread-safe: jobs with different `out`, yes. Realtime-safe: yes. Every SIMD row computes the same bits.
/// Cost: about 0.1 ns a value (x86-64-v3).
struct ClothLineJob {
  const ClothSpline* spline = nullptr;
  std::span<const float> base;
  std::size_t first_link = 0;
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> out;  ///< overlaps no other

  enum class Problem : std::uint8_t { kNone, kNoSpline, kSizesDiffer, kRowNotRunnable };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
