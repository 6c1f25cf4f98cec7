#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/scenes/gust_nodes.hpp"
#include "engine/wind/ground/ground_wind.hpp"

namespace yuragi::scenes {

/// The measured wind at the nodes of a grid: WindTapes read at each of them, and at the coarse nodes for the octaves of
/// the noise that are read there.
///
/// Allocates when it is made, never afterwards. Thread-safe: no. Realtime-safe: all but construction.
class TapeNodes {
 public:
  /// For this grid of nodes.
  explicit TapeNodes(const GustNodes& nodes);

  /// Reads a wind with tapes at the nodes of some lines, as it will be when the mean wind has carried it by `carried_m`
  /// (east and north).
  void read(const wind::ground::Wind& wind, const GustNodes& nodes, const NodeRange& lines,
            wind::Vector carried_m) noexcept;

  /// The measured wind at a node.
  wind::Vector known(std::size_t node) const noexcept { return known_[node]; }
  /// The ceiling's factor on the noise.
  double gain(std::size_t node) const noexcept { return gain_[node]; }
  /// The remaining part of each octave of the noise.
  const GustWeights& weights() const noexcept { return weights_; }

 private:
  std::vector<wind::Vector> known_;
  std::vector<double> gain_;
  std::vector<float> factors_;  ///< of the octaves that are held, first along, then across
  wind::ground::WindTapes::NoiseLeft left_, coarse_left_;
  GustWeights weights_;
};

}  // namespace yuragi::scenes
