#include "engine/noise/noise_kernels.hpp"

#include "engine/base/kernel.hpp"
#include "engine/math/trig.hpp"

namespace yuragi::noise {
namespace {

constexpr double kNearestWhole = 0x1.8p52;     // where doubles stand 1 apart
constexpr double kNearestGrid = 0x1.8p32;      // where doubles stand 2^-20 apart
constexpr double kPhasesPerTurn = 0x1p32 - 1;  // less one, so that half a turn still is a signed number of 32 bits
constexpr float kRadPerPhase = 0x1.921fb6p-30F;

void turn_modes(const TurnModesArguments& arguments) noexcept {
  const TurnModesArguments in = arguments;  // a copy, which no store can be taken for a change of
  std::uint32_t* const __restrict phase = in.phase;
  double* const __restrict out = in.out_modes;
  for (std::size_t i = 0; i < in.count; ++i) {
    // Whole turns are left out.
    const double turns = in.turns_per_s[i] * in.dt_s;
    const double part = turns - ((turns + kNearestWhole) - kNearestWhole);
    phase[i] += static_cast<std::uint32_t>(static_cast<std::int32_t>(part * kPhasesPerTurn));

    // F_k exp(-i angle)
    const math::SinCos angle = math::sin_cos(static_cast<float>(static_cast<std::int32_t>(phase[i])) * kRadPerPhase);
    const auto sine = static_cast<double>(angle.sin);
    const auto cosine = static_cast<double>(angle.cos);
    out[2 * i] = in.first_re[i] * cosine + in.first_im[i] * sine;
    out[2 * i + 1] = in.first_im[i] * cosine - in.first_re[i] * sine;
  }
}

void standardise(const StandardiseArguments& arguments) noexcept {
  const StandardiseArguments in = arguments;
  float* const __restrict out = in.out;
  for (std::size_t i = 0; i < in.count; ++i) {
    out[i] = static_cast<float>(((in.samples[i] - in.mean) * in.scale + kNearestGrid) - kNearestGrid);
  }
}

}  // namespace

const NoiseKernels YURAGI_ROW_NAME(noise_kernels) = {turn_modes, standardise};

}  // namespace yuragi::noise
