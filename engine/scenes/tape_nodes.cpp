#include "engine/scenes/tape_nodes.hpp"

#include <algorithm>

namespace yuragi::scenes {

TapeNodes::TapeNodes(const GustNodes& nodes) : known_(nodes.x_m().size()), gain_(nodes.x_m().size()) {
  // A cache line between two octaves: arrays whole pages apart drive each other out of the cache.
  constexpr std::size_t kLine = 64 / sizeof(float);
  const auto padded = [](std::size_t count) { return (count / kLine + 2) * kLine; };
  const std::size_t fine = nodes.x_m().size();
  factors_.resize(2 * wind::ground::kTileOctaveCount * padded(fine));
  float* next = factors_.data();
  const auto part = [&](std::size_t count) {
    const std::span<float> factors(next, count);
    next += padded(count);
    return factors;
  };
  for (std::size_t i = 0; i < wind::ground::kTileOctaveCount; ++i) {
    if (!nodes.is_held(i)) continue;
    const bool is_coarse = GustNodes::is_coarse(i);
    wind::ground::WindTapes::NoiseLeft& left = is_coarse ? coarse_left_ : left_;
    for (auto* octaves : {&left.along, &left.across}) {
      (*octaves)[i] = part(is_coarse ? nodes.coarse_x_m().size() : fine);
    }
    weights_.along[i] = left.along[i];
    weights_.across[i] = left.across[i];
  }
}

void TapeNodes::read(const wind::ground::GroundWind& wind, const GustNodes& nodes) noexcept {
  constexpr std::size_t kAtOnce = 128;
  std::array<wind::ground::WindTapes::Known, kAtOnce> readings;
  wind::ground::WindTapes::NoiseLeft left = left_;
  for (std::size_t begin = 0; begin < known_.size(); begin += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, known_.size() - begin);
    wind.tapes->read(nodes.x_m().subspan(begin, count), nodes.z_m().subspan(begin, count),
                     std::span(readings).first(count), left);
    for (std::size_t i = 0; i < count; ++i) {
      known_[begin + i] = wind.measured(readings[i], nodes.x_m()[begin + i], nodes.z_m()[begin + i]);
      gain_[begin + i] = readings[i].gain;
    }
    for (auto* octaves : {&left.along, &left.across}) {
      for (std::span<float>& octave : *octaves) octave = octave.empty() ? octave : octave.subspan(count);
    }
  }
  wind.tapes->read(nodes.coarse_x_m(), nodes.coarse_z_m(), {}, coarse_left_);
}

}  // namespace yuragi::scenes
