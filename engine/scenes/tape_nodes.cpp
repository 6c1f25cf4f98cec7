#include "engine/scenes/tape_nodes.hpp"

namespace yuragi {

TapeNodes::TapeNodes(const GustNodes& nodes) : known_(nodes.x_m().size()), gain_(nodes.x_m().size(), 1.0) {
  for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
    const std::size_t count = GustNodes::is_coarse(i) ? nodes.coarse_x_m().size() : nodes.x_m().size();
    along_[i].resize(count);
    across_[i].resize(count);
    weights_.along[i] = along_[i];
    weights_.across[i] = across_[i];
  }
}

void TapeNodes::keep(const WindTapes::Reading& reading, bool is_coarse, std::size_t node) noexcept {
  for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
    if (GustNodes::is_coarse(i) != is_coarse) continue;
    along_[i][node] = reading.noise_along[i];
    across_[i][node] = reading.noise_across[i];
  }
}

void TapeNodes::read(const GroundWind& wind, const GustNodes& nodes) noexcept {
  for (std::size_t i = 0; i < known_.size(); ++i) {
    const double east_m = nodes.x_m()[i];
    const double south_m = nodes.z_m()[i];
    const WindTapes::Reading reading = wind.tapes->at(east_m, south_m);
    known_[i] = wind.measured(reading, east_m, south_m);
    gain_[i] = reading.gain;
    keep(reading, false, i);
  }
  for (std::size_t i = 0; i < nodes.coarse_x_m().size(); ++i) {
    keep(wind.tapes->at(nodes.coarse_x_m()[i], nodes.coarse_z_m()[i]), true, i);
  }
}

}  // namespace yuragi
