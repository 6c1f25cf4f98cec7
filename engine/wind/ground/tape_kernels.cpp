#include "engine/wind/ground/tape_kernels.hpp"

#include "engine/base/kernel.hpp"

namespace yuragi::wind::ground {
namespace {

constexpr std::size_t kNorth = kTapeBandLanes;
constexpr std::size_t kAlong = 2 * kTapeBandLanes;
constexpr std::size_t kAcross = kAlong + kTapeOctaveLanes;

[[gnu::always_inline]] inline float between_two(float first, float second, float fraction) noexcept {
  return first + fraction * (second - first);
}

/// Adds the halves of the lanes repeatedly, so that every row adds in the same order.
[[gnu::always_inline]] inline float sum_of(float* lanes) noexcept {
  for (std::size_t i = 0; i < 8; ++i) lanes[i] += lanes[i + 8];
  for (std::size_t i = 0; i < 4; ++i) lanes[i] += lanes[i + 4];
  return (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]);
}

[[gnu::always_inline]] inline void read_gusts(const TapeKernelPlace& at, float* east_m_s, float* north_m_s) noexcept {
  alignas(64) float east[kTapeBandLanes];
  alignas(64) float north[kTapeBandLanes];
  for (std::size_t i = 0; i < kTapeBandLanes; ++i) {
    const float kept = at.kept * between_two(at.near[i], at.far[i], at.row_fraction);
    east[i] = kept * between_two(at.first[i], at.second[i], at.fraction);
    north[i] = kept * between_two(at.first[kNorth + i], at.second[kNorth + i], at.fraction);
  }
  *east_m_s = sum_of(east);
  *north_m_s = sum_of(north);
}

[[gnu::always_inline]] inline float left_of(float known) noexcept {
  const float left = 1.0F - known;
  return __builtin_sqrtf(left > 0.0F ? left : 0.0F);
}

[[gnu::always_inline]] inline void read_octaves(const TapeKernelPlace& at, float* __restrict along,
                                                float* __restrict across) noexcept {
  const float kept_square = at.kept * at.kept;
  for (std::size_t i = 0; i < kTapeOctaveLanes; ++i) {
    const float kept =
        kept_square * between_two(at.near[kTapeBandLanes + i], at.far[kTapeBandLanes + i], at.row_fraction);
    along[i] = left_of(kept * between_two(at.first[kAlong + i], at.second[kAlong + i], at.fraction));
    across[i] = left_of(kept * between_two(at.first[kAcross + i], at.second[kAcross + i], at.fraction));
  }
}

void gusts(const TapeKernelPlace& at, float* east_m_s, float* north_m_s) noexcept {
  read_gusts(at, east_m_s, north_m_s);
}

void octaves(const TapeKernelPlace& at, float* along, float* across) noexcept {
  read_octaves(at, along, across);
}

void many(const TapeKernelArguments& in) noexcept {
  for (std::size_t i = 0; in.east_m_s != nullptr && i < in.count; ++i) {
    read_gusts(in.places[i], in.east_m_s + i, in.north_m_s + i);
  }
  if (in.octave_count == 0) return;
  // All octaves of some places, and then place by place for each octave: arrays that are written alternately can evict
  // each other from the cache.
  constexpr std::size_t kAtOnce = 16;
  alignas(64) float along[kAtOnce][kTapeOctaveLanes];
  alignas(64) float across[kAtOnce][kTapeOctaveLanes];
  for (std::size_t begin = 0; begin < in.count; begin += kAtOnce) {
    const std::size_t count = in.count - begin < kAtOnce ? in.count - begin : kAtOnce;
    for (std::size_t i = 0; i < count; ++i) read_octaves(in.places[begin + i], along[i], across[i]);
    for (std::size_t k = 0; k < in.octave_count; ++k) {
      const TapeKernelOctave& out = in.octaves[k];
      for (std::size_t i = 0; i < count; ++i) out.along[begin + i] = along[i][out.octave];
      for (std::size_t i = 0; i < count; ++i) out.across[begin + i] = across[i][out.octave];
    }
  }
}

}  // namespace

const TapeKernels YURAGI_ROW_NAME(tape_kernels) = {gusts, octaves, many};

}  // namespace yuragi::wind::ground
