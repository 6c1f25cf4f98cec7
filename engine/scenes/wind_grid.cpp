#include "engine/scenes/wind_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "engine/operators/grid_sample_job.hpp"
#include "engine/operators/sample_job.hpp"
#include "engine/scenes/grid_places.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi::scenes {
namespace {

constexpr std::size_t kMinNodes = 4;
constexpr std::size_t kMaxNodes = 64;

/// Below this a wind is set to 0: denormal numbers are slow.
constexpr float kNoWind_m_s = 1e-12F;

/// How many nodes of an axis are read from these places on it: up to the one behind the last place.
std::size_t nodes_read(std::span<const std::uint32_t> places, std::size_t nodes) {
  if (places.empty()) return 0;
  const std::uint32_t last = *std::max_element(places.begin(), places.end());
  return (std::uint64_t{last} * nodes >> 32U) + 2;
}

}  // namespace

/// A square torus over all places, a power of two of nodes a side. Only nodes that a place reads are computed: the last
/// column and row are beyond every place, so that no place reads across the torus's seam.
WindGrid::Layout::Layout(std::span<const float> x_m, std::span<const float> z_m, double finest_cell_m) {
  if (x_m.empty()) return;
  const auto [west, east] = std::minmax_element(x_m.begin(), x_m.end());
  const auto [north, south] = std::minmax_element(z_m.begin(), z_m.end());
  nodes.west_m = static_cast<double>(*west);
  nodes.north_m = static_cast<double>(*north);
  const double extent_m =
      std::max(static_cast<double>(*east) - nodes.west_m, static_cast<double>(*south) - nodes.north_m);
  const auto cells = static_cast<std::size_t>(std::ceil(std::min(extent_m / finest_cell_m, 1e6)));
  torus_nodes = std::clamp(std::bit_ceil(cells + 2), kMinNodes, kMaxNodes);
  const double cell_m = std::max(extent_m / static_cast<double>(torus_nodes - 2), finest_cell_m);
  const double period_m = cell_m * static_cast<double>(torus_nodes);
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    place_x.push_back(noise::torus_phase(static_cast<double>(x_m[i]) - nodes.west_m, period_m));
    place_z.push_back(noise::torus_phase(static_cast<double>(z_m[i]) - nodes.north_m, period_m));
  }
  nodes.cell_x_m = cell_m;
  nodes.cell_z_m = cell_m;
  nodes.columns = nodes_read(place_x, torus_nodes);
  nodes.lines = nodes_read(place_z, torus_nodes);
}

WindGrid::WindGrid(std::shared_ptr<const wind::turbulence::GustNoise> gusts, std::span<const float> x_m,
                   std::span<const float> z_m, SimdRow row, double finest_cell_m, std::size_t columns)
    : row_(row), layout_(x_m, z_m, finest_cell_m), gusts_(std::move(gusts), layout_.nodes, row), tape_nodes_(gusts_) {
  if (goes_along_axes(x_m, z_m, columns)) {
    column_x_.assign(layout_.place_x.begin(), layout_.place_x.begin() + static_cast<std::ptrdiff_t>(columns));
    for (std::size_t i = 0; i < layout_.place_z.size(); i += columns) row_z_.push_back(layout_.place_z[i]);
  }
  const std::size_t count = layout_.nodes.size();
  for (Component* component : {&east_, &south_}) {
    component->value.assign(count, 0.0F);
    component->target.assign(count, 0.0F);
    component->next_target.assign(count, 0.0F);
    component->rate_per_s.assign(count, 0.0F);
    component->on_torus = {layout_.torus_nodes, std::vector<float>(layout_.torus_nodes * layout_.torus_nodes)};
  }
  due_in_s_.assign(layout_.nodes.lines, 0.0);
}

void WindGrid::step(const wind::ground::Wind& wind, double dt_s) noexcept {
  const ReadingSchedule::Due due = schedule_.advance(wind.tick, dt_s);
  approach_targets(dt_s);
  read(wind, due);
  const double rate_rad_s = ReadingSchedule::matched_rate_rad_s(Wind::kOmega_rad_s, due);
  follow(east_, rate_rad_s, dt_s);
  follow(south_, rate_rad_s, dt_s);
}

/// Line by line, linearly toward the values that were read last, to arrive when the next ones are due.
void WindGrid::approach_targets(double dt_s) noexcept {
  for (std::size_t line = 0; line < due_in_s_.size(); ++line) {
    if (due_in_s_[line] <= 0.0) continue;
    const auto part = static_cast<float>(std::min(dt_s / due_in_s_[line], 1.0));
    due_in_s_[line] -= dt_s;
    const NodeRange nodes = gusts_.nodes_of({line, 1});
    for (Component* component : {&east_, &south_}) {
      const std::span<float> target = nodes.of(std::span(component->target));
      const std::span<const float> next = nodes.of(std::span<const float>(component->next_target));
      for (std::size_t i = 0; i < target.size(); ++i) target[i] += part * (next[i] - target[i]);
    }
  }
}

/// The parts that are due.
void WindGrid::read(const wind::ground::Wind& wind, const ReadingSchedule::Due& due) noexcept {
  const std::size_t lines = layout_.nodes.lines;
  for (std::size_t i = 0; i < due.count; ++i) {
    const std::size_t part = (due.first + i) % due.parts;
    const std::size_t begin = part * lines / due.parts;
    const std::size_t end = (part + 1) * lines / due.parts;
    read_lines(wind, {begin, end - begin}, due.lead_s);
    std::fill(due_in_s_.begin() + static_cast<std::ptrdiff_t>(begin),
              due_in_s_.begin() + static_cast<std::ptrdiff_t>(end), due.lead_s);
  }
  if (has_targets_ && due.lead_s > 0.0) return;
  has_targets_ = true;
  for (Component* component : {&east_, &south_}) component->target = component->next_target;
}

/// The known wind at each node, and the noise that fills the rest (along the mean wind and to the left of it, turned
/// into the world), as they will be lead_s later.
void WindGrid::read_lines(const wind::ground::Wind& wind, const NodeRange& lines, double lead_s) noexcept {
  if (lines.count == 0) return;
  const wind::Vector carried_m = lead_s * wind.advection;
  if (wind.tapes != nullptr) tape_nodes_.read(wind, gusts_, lines, carried_m);
  gusts_.read_carried(wind.gusts, carried_m, wind.tapes != nullptr ? tape_nodes_.weights() : GustWeights{}, lines);
  const wind::Vector ahead = wind.gusts.ahead;
  const NodeRange nodes = gusts_.nodes_of(lines);
  for (std::size_t i = nodes.first; i < nodes.first + nodes.count; ++i) {
    const auto along = static_cast<double>(gusts_.along_m_s()[i]);
    const auto across = static_cast<double>(gusts_.across_m_s()[i]);
    const wind::Vector gust{along * ahead.u_m_s - across * ahead.v_m_s, along * ahead.v_m_s + across * ahead.u_m_s};
    const wind::Vector here = wind.tapes != nullptr ? tape_nodes_.known(i) + tape_nodes_.gain(i) * gust
                                                    : wind.untaped_at(gusts_.x_m()[i], gusts_.z_m()[i]) + gust;
    const wind::Vector felt = Wind::cut(here);
    east_.next_target[i] = static_cast<float>(felt.u_m_s);
    south_.next_target[i] = static_cast<float>(-felt.v_m_s);
  }
}

/// Wind's filter at each node.
void WindGrid::follow(Component& component, double rate_rad_s, double dt_s) const noexcept {
  const double phase = rate_rad_s * dt_s;
  const double decay = std::exp(-phase);
  const auto value_from_distance = static_cast<float>(decay * (1.0 + phase));
  const auto value_from_rate = static_cast<float>(decay * dt_s);
  const auto rate_from_rate = static_cast<float>(decay * (1.0 - phase));
  const auto rate_from_distance = static_cast<float>(-decay * rate_rad_s * phase);
  for (std::size_t i = 0; i < component.target.size(); ++i) {
    const float target = component.target[i];
    const float distance = component.value[i] - target;
    const float rate = component.rate_per_s[i];
    const float value = target + value_from_distance * distance + value_from_rate * rate;
    const float new_rate = rate_from_rate * rate + rate_from_distance * distance;
    const bool is_still = std::abs(value) < kNoWind_m_s && std::abs(new_rate) < kNoWind_m_s;
    component.value[i] = is_still ? 0.0F : value;
    component.rate_per_s[i] = is_still ? 0.0F : new_rate;
  }
  const std::size_t columns = layout_.nodes.columns;
  auto on_torus = component.on_torus.values.begin();
  for (std::size_t i = 0; i < component.value.size(); i += columns) {
    std::ranges::copy(std::span(component.value).subspan(i, columns), on_torus);
    on_torus += static_cast<std::ptrdiff_t>(component.on_torus.size);
  }
}

void WindGrid::read(const Component& component, std::size_t first, std::span<float> out) const noexcept {
  if (!column_x_.empty() && out.size() == layout_.place_x.size()) {
    const operators::GridNoiseLayer layer{.tile = &component.on_torus, .column_x = column_x_, .row_z = row_z_};
    operators::GridSampleJob{.layers = std::span(&layer, 1), .row = row_, .out = out}.run();
    return;
  }
  const operators::NoiseLayer layer{.tile = &component.on_torus,
                                    .place_x = std::span(layout_.place_x).subspan(first, out.size()),
                                    .place_z = std::span(layout_.place_z).subspan(first, out.size())};
  operators::SampleJob{.layers = std::span(&layer, 1), .row = row_, .out = out}.run();
}

void WindGrid::sample(std::size_t first, std::span<float> east_m_s, std::span<float> south_m_s) const noexcept {
  read(east_, first, east_m_s);
  read(south_, first, south_m_s);
}

}  // namespace yuragi::scenes
