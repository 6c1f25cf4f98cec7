#include "daemon/feeds/dmx_rest.hpp"

#include <algorithm>

namespace yuragi::daemon::feeds {
namespace {

constexpr std::uint64_t kOfRest = 25, kInAll = kOfRest + 3;

}  // namespace

DmxRest::DmxRest(const settings::feeds::Dmx& config) : levels_(config.universe_count()) {
  const ComponentId component = component_id_of(machine_id(), config.name);
  for (std::size_t i = 0; i < levels_.size(); ++i) universes_.emplace_back(config, i, component).leave_sequence();
  for (const settings::feeds::DmxChannel& channel : config.channels) DmxChannelLevel(channel).write_to(levels_[0]);
  for (const settings::feeds::DmxGrid& grid : config.grids) write_grid(grid, {}, levels_);
}

void DmxRest::step(MonoTime now) {
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const std::uint64_t sent = universes_[i].target().messages();
    if (sent < kInAll) universes_[i].send_now(levels_[i], now, sent >= kOfRest);
  }
}

bool DmxRest::is_over() const noexcept {
  return std::ranges::all_of(universes_, [](const auto& universe) { return universe.target().messages() >= kInAll; });
}

std::string DmxRest::trouble() const {
  for (const DmxUniverse& universe : universes_) {
    if (!universe.target().trouble().empty()) return universe.target().trouble();
  }
  return {};
}

}  // namespace yuragi::daemon::feeds
