#include "engine/scenes/tape_nodes.hpp"

#include <algorithm>
#include <array>

namespace yuragi::scenes {
namespace {

/// Number of nodes that are read at a time.
constexpr std::size_t kAtOnce = 128;

/// The upwind origin of the wind that will be at some places.
struct Upwind {
  std::array<double, kAtOnce> x_m, z_m;
  std::size_t count = 0;
};
Upwind upwind(std::span<const double> x_m, std::span<const double> z_m, wind::Vector carried_m) noexcept {
  Upwind from;
  from.count = x_m.size();
  for (std::size_t i = 0; i < from.count; ++i) {
    from.x_m[i] = x_m[i] - carried_m.u_m_s;
    from.z_m[i] = z_m[i] + carried_m.v_m_s;
  }
  return from;
}

/// `left`: of all nodes; those of the range are read.
void read_tapes(const wind::ground::WindTapes& tapes, const Upwind& from,
                std::span<wind::ground::WindTapes::Known> known, wind::ground::WindTapes::NoiseLeft left,
                const NodeRange& range) noexcept {
  for (auto* octaves : {&left.along, &left.across}) {
    for (std::span<float>& octave : *octaves) octave = range.of(octave);
  }
  tapes.read(std::span(from.x_m).first(from.count), std::span(from.z_m).first(from.count), known, left);
}

}  // namespace

TapeNodes::TapeNodes(const GustNodes& nodes) : known_(nodes.x_m().size()), gain_(nodes.x_m().size()) {
  // A cache line between two octaves: arrays that are whole pages apart would evict each other from the cache.
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

void TapeNodes::read(const wind::ground::Wind& wind, const GustNodes& nodes, const NodeRange& lines,
                     wind::Vector carried_m) noexcept {
  const NodeRange fine = nodes.nodes_of(lines);
  for (std::size_t begin = fine.first; begin < fine.first + fine.count; begin += kAtOnce) {
    const NodeRange range{begin, std::min(kAtOnce, fine.first + fine.count - begin)};
    std::array<wind::ground::WindTapes::Known, kAtOnce> readings;
    read_tapes(*wind.tapes, upwind(range.of(nodes.x_m()), range.of(nodes.z_m()), carried_m),
               std::span(readings).first(range.count), left_, range);
    for (std::size_t i = 0; i < range.count; ++i) {
      const std::size_t node = begin + i;
      known_[node] = wind.measured(readings[i], nodes.x_m()[node], nodes.z_m()[node]);
      gain_[node] = readings[i].gain;
    }
  }
  const NodeRange coarse = nodes.coarse_nodes_of(lines);
  for (std::size_t begin = coarse.first; begin < coarse.first + coarse.count; begin += kAtOnce) {
    const NodeRange range{begin, std::min(kAtOnce, coarse.first + coarse.count - begin)};
    read_tapes(*wind.tapes, upwind(range.of(nodes.coarse_x_m()), range.of(nodes.coarse_z_m()), carried_m), {},
               coarse_left_, range);
  }
}

}  // namespace yuragi::scenes
