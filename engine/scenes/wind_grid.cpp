#include "engine/scenes/wind_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "engine/operators/grid_sample_job.hpp"
#include "engine/operators/sample_job.hpp"
#include "engine/scenes/grid_places.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi {
namespace {

constexpr std::size_t kFewestNodes = 4;
constexpr std::size_t kMostNodes = 64;

/// What is left of a wind that has ceased is nothing: numbers too small are slow.
constexpr float kNoWind_m_s = 1e-12F;

/// The standard deviation of a usual wind, as a part of its speed.
constexpr double kUsualTurbulence = 0.2;

ScenePlacement first_of(std::span<const float> x_m, std::span<const float> z_m) {
  if (x_m.empty()) return {};
  return {.x_m = static_cast<double>(x_m.front()), .z_m = static_cast<double>(z_m.front())};
}

}  // namespace

WindGrid::WindGrid(std::shared_ptr<const GustNoise> gusts, std::span<const float> x_m, std::span<const float> z_m,
                   SimdRow row, double finest_cell_m, std::size_t columns)
    : gusts_(std::move(gusts)), row_(row), east_m_s_(x_m.size()), south_m_s_(x_m.size()), smooth_(first_of(x_m, z_m)) {
  // A square over all places, a power of two of nodes a side; the last column and row are beyond every place, so that
  // none reads where the torus closes.
  const auto [west, east] = std::minmax_element(x_m.begin(), x_m.end());
  const auto [north, south] = std::minmax_element(z_m.begin(), z_m.end());
  const double first_x_m = x_m.empty() ? 0.0 : static_cast<double>(*west);
  const double first_z_m = z_m.empty() ? 0.0 : static_cast<double>(*north);
  const double extent_m =
      x_m.empty() ? 0.0 : std::max(static_cast<double>(*east) - first_x_m, static_cast<double>(*south) - first_z_m);
  const auto cells = static_cast<std::size_t>(std::ceil(std::min(extent_m / finest_cell_m, 1e6)));
  const std::size_t nodes = std::clamp(std::bit_ceil(cells + 2), kFewestNodes, kMostNodes);
  const double cell_m = std::max(extent_m / static_cast<double>(nodes - 2), finest_cell_m);
  const double period_m = cell_m * static_cast<double>(nodes);

  for (std::size_t line = 0; line < nodes; ++line) {
    for (std::size_t column = 0; column < nodes; ++column) {
      const double node_x_m = first_x_m + cell_m * static_cast<double>(column);
      const double node_z_m = first_z_m + cell_m * static_cast<double>(line);
      node_x_m_.push_back(node_x_m);
      node_z_m_.push_back(node_z_m);
      for (std::size_t which = 0; which < 2; ++which) {
        const TorusPhase phase = gusts_->place_on(which, node_x_m, node_z_m);
        node_x_[which].push_back(phase.x);
        node_z_[which].push_back(phase.z);
      }
    }
  }
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    place_x_.push_back(torus_phase(static_cast<double>(x_m[i]) - first_x_m, period_m));
    place_z_.push_back(torus_phase(static_cast<double>(z_m[i]) - first_z_m, period_m));
  }
  if (goes_along_axes(x_m, z_m, columns)) {
    column_x_.assign(place_x_.begin(), place_x_.begin() + static_cast<std::ptrdiff_t>(columns));
    for (std::size_t i = 0; i < place_z_.size(); i += columns) row_z_.push_back(place_z_[i]);
  }
  for (Component* component : {&east_, &south_}) {
    component->value = {nodes, std::vector<float>(nodes * nodes)};
    component->target.assign(nodes * nodes, 0.0F);
    component->rate_per_s.assign(nodes * nodes, 0.0F);
  }
}

void WindGrid::read_octaves(const GroundWind& wind, GustNoise::Component component,
                            std::span<float> out) const noexcept {
  std::array<GustNoise::Layer, GustNoise::kMaxLayers> octaves;
  const std::size_t count = gusts_->layers(wind.gusts, component, octaves);
  if (count == 0) {
    std::ranges::fill(out, 0.0F);
    return;
  }
  std::array<NoiseLayer, GustNoise::kMaxLayers> layers;
  static_assert(GustNoise::kMaxLayers <= SampleJob::kMaxLayers);
  for (std::size_t i = 0; i < count; ++i) {
    const GustNoise::Layer& octave = octaves[i];
    layers[i] = {.tile = octave.tile,
                 .place_x = node_x_[octave.which],
                 .place_z = node_z_[octave.which],
                 .offset = octave.offset,
                 .weight = octave.weight_m_s};
  }
  SampleJob{.layers = std::span(layers).first(count), .row = row_, .out = out}.run();
}

void WindGrid::step(const GroundWind& wind, double dt_s) noexcept {
  smooth_.step(wind, dt_s);

  // The gusts at each node, along the mean wind and to the left of it, turned into the world.
  read_octaves(wind, GustNoise::Component::kAlong, east_.target);
  read_octaves(wind, GustNoise::Component::kAcross, south_.target);
  const WindVector ahead = wind.gusts.ahead;
  for (std::size_t i = 0; i < east_.target.size(); ++i) {
    const auto along = static_cast<double>(east_.target[i]);
    const auto across = static_cast<double>(south_.target[i]);
    const WindVector gust{along * ahead.u_m_s - across * ahead.v_m_s, along * ahead.v_m_s + across * ahead.u_m_s};
    const WindVector here = SceneWind::cut(wind.smooth_at(node_x_m_[i], node_z_m_[i]) + gust);
    east_.target[i] = static_cast<float>(here.u_m_s);
    south_.target[i] = static_cast<float>(-here.v_m_s);
  }
  follow(east_, dt_s);
  follow(south_, dt_s);
}

/// CriticallyDamped, for all nodes at once.
void WindGrid::follow(Component& component, double dt_s) noexcept {
  const double phase = SceneWind::kOmega_rad_s * dt_s;
  const double decay = std::exp(-phase);
  const auto value_from_distance = static_cast<float>(decay * (1.0 + phase));
  const auto value_from_rate = static_cast<float>(decay * dt_s);
  const auto rate_from_rate = static_cast<float>(decay * (1.0 - phase));
  const auto rate_from_distance = static_cast<float>(-decay * SceneWind::kOmega_rad_s * phase);
  for (std::size_t i = 0; i < component.target.size(); ++i) {
    const float target = component.target[i];
    const float distance = component.value.values[i] - target;
    const float rate = component.rate_per_s[i];
    const float value = target + value_from_distance * distance + value_from_rate * rate;
    const float new_rate = rate_from_rate * rate + rate_from_distance * distance;
    const bool is_still = std::abs(value) < kNoWind_m_s && std::abs(new_rate) < kNoWind_m_s;
    component.value.values[i] = is_still ? 0.0F : value;
    component.rate_per_s[i] = is_still ? 0.0F : new_rate;
  }
}

void WindGrid::read(const Component& component, std::size_t first, std::span<float> out) const noexcept {
  if (!column_x_.empty() && out.size() == place_x_.size()) {
    const GridNoiseLayer layer{.tile = &component.value, .column_x = column_x_, .row_z = row_z_};
    GridSampleJob{.layers = std::span(&layer, 1), .row = row_, .out = out}.run();
    return;
  }
  const NoiseLayer layer{.tile = &component.value,
                         .place_x = std::span(place_x_).subspan(first, out.size()),
                         .place_z = std::span(place_z_).subspan(first, out.size())};
  SampleJob{.layers = std::span(&layer, 1), .row = row_, .out = out}.run();
}

void WindGrid::sample(std::size_t first, std::span<float> east_m_s, std::span<float> south_m_s) const noexcept {
  read(east_, first, east_m_s);
  read(south_, first, south_m_s);
}

void WindGrid::sample_gusts(std::size_t first, std::span<float> out, float limit) noexcept {
  const std::span<float> east_m_s = std::span(east_m_s_).first(out.size());
  const std::span<float> south_m_s = std::span(south_m_s_).first(out.size());
  sample(first, east_m_s, south_m_s);
  const double speed_m_s = smooth_.speed_m_s();
  if (speed_m_s < static_cast<double>(kNoWind_m_s)) {
    std::ranges::fill(out, 0.0F);
    return;
  }
  const double per_square = 1.0 / (kUsualTurbulence * speed_m_s * speed_m_s);
  const auto from_east = static_cast<float>(smooth_.east_m_s() * per_square);
  const auto from_south = static_cast<float>(smooth_.south_m_s() * per_square);
  constexpr auto kMean = static_cast<float>(1.0 / kUsualTurbulence);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = std::clamp(east_m_s[i] * from_east + south_m_s[i] * from_south - kMean, -limit, limit);
  }
}

}  // namespace yuragi
