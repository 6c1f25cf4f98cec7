#include "engine/scenes/gust_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/operators/sample_job.hpp"

namespace yuragi::scenes {
namespace {

constexpr std::size_t kMinCoarseNodes = 4;
constexpr double kMaxCoarseCell_m = 16.0;

/// The number of coarse nodes for this maximum spacing, at most that of the fine ones.
std::size_t coarse_nodes(std::size_t nodes, double cell_m) {
  if (nodes == 0) return 0;
  const double extent_m = static_cast<double>(nodes - 1) * cell_m;
  const auto cells = static_cast<std::size_t>(std::ceil(extent_m / kMaxCoarseCell_m));
  return std::min(nodes, std::max(kMinCoarseNodes, cells + 1));
}

double stretched_cell_m(std::size_t nodes, double cell_m, std::size_t coarse) {
  return coarse < 2 ? cell_m : static_cast<double>(nodes - 1) * cell_m / static_cast<double>(coarse - 1);
}

/// Coarse nodes over the same ground.
GroundNodes coarse_of(const GroundNodes& nodes) {
  GroundNodes coarse = nodes;
  coarse.columns = coarse_nodes(nodes.columns, nodes.cell_x_m);
  coarse.lines = coarse_nodes(nodes.lines, nodes.cell_z_m);
  coarse.cell_x_m = stretched_cell_m(nodes.columns, nodes.cell_x_m, coarse.columns);
  coarse.cell_z_m = stretched_cell_m(nodes.lines, nodes.cell_z_m, coarse.lines);
  return coarse;
}

}  // namespace

GustNodes::Nodes::Nodes(const wind::turbulence::GustNoise& gusts, const GroundNodes& nodes)
    : along_m_s(nodes.size()), across_m_s(nodes.size()) {
  for (std::size_t line = 0; line < nodes.lines; ++line) {
    for (std::size_t column = 0; column < nodes.columns; ++column) {
      x_m.push_back(nodes.west_m + nodes.cell_x_m * static_cast<double>(column));
      z_m.push_back(nodes.north_m + nodes.cell_z_m * static_cast<double>(line));
      for (std::size_t torus = 0; torus < wind::turbulence::GustNoise::kTori; ++torus) {
        const noise::TorusPhase phase = gusts.place_on(torus, x_m.back(), z_m.back());
        on_torus_x[torus].push_back(phase.x);
        on_torus_z[torus].push_back(phase.z);
      }
    }
  }
}

GustNodes::GustNodes(std::shared_ptr<const wind::turbulence::GustNoise> gusts, const GroundNodes& nodes, SimdRow row)
    : gusts_(std::move(gusts)), row_(row), fine_(*gusts_, nodes), coarse_(*gusts_, coarse_of(nodes)) {
  const GroundNodes coarse = coarse_of(nodes);
  columns_ = between(nodes.columns, coarse.columns);
  lines_ = between(nodes.lines, coarse.lines);
  envelope_.resize(coarse.size());
  for (auto* line : {&line_along_m_s_, &line_across_m_s_, &line_envelope_}) line->resize(coarse.columns);

  const double cell_m = std::max(nodes.cell_x_m, nodes.cell_z_m);
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const double shortest_m =
        2.0 * std::numbers::pi / gusts_->octaves()[wind::turbulence::GustNoise::kFirstTileOctave + i].to_rad_m;
    held_[i] = is_coarse(i) ? 1.0F : static_cast<float>(std::clamp(std::log2(0.5 * shortest_m / cell_m), 0.0, 1.0));
  }
}

std::vector<GustNodes::Between> GustNodes::between(std::size_t nodes, std::size_t coarse_nodes) {
  std::vector<Between> result(nodes);
  for (std::size_t i = 0; i < nodes && coarse_nodes > 1; ++i) {
    const double at = static_cast<double>(i * (coarse_nodes - 1)) / static_cast<double>(nodes - 1);
    const std::size_t first = std::min(static_cast<std::size_t>(at), coarse_nodes - 2);
    result[i] = {first, static_cast<float>(at - static_cast<double>(first))};
  }
  return result;
}

NodeRange GustNodes::coarse_nodes_of(const NodeRange& lines) const noexcept {
  if (lines.count == 0) return {};
  const std::size_t coarse_columns = line_envelope_.size();
  const std::size_t first = lines_[lines.first].first;
  const std::size_t end = lines_[lines.first + lines.count - 1].first + 2;  // the line behind it, too
  return {first * coarse_columns, (std::min(end, envelope_.size() / coarse_columns) - first) * coarse_columns};
}

void GustNodes::read(const wind::turbulence::GustNoise::Moment& moment, const GustWeights& weights,
                     const NodeRange& lines) noexcept {
  read_tiles(moment, weights, lines);
  const NodeRange coarse = coarse_nodes_of(lines);
  for (std::size_t i = coarse.first; i < coarse.first + coarse.count; ++i) {
    envelope_[i] = gusts_->envelope(moment, coarse_.x_m[i], coarse_.z_m[i]);
  }
  add_coarse(lines);
}

void GustNodes::read_carried(const wind::turbulence::GustNoise::Moment& moment, wind::Vector carried_m,
                             const GustWeights& weights, const NodeRange& lines) noexcept {
  wind::turbulence::GustNoise::Moment later = moment;
  gusts_->carry(later.carried, carried_m.u_m_s, -carried_m.v_m_s, 1.0);
  read(later, weights, lines);
}

/// Reads at the nodes, and separately at the coarse nodes.
void GustNodes::read_tiles(const wind::turbulence::GustNoise::Moment& moment, const GustWeights& weights,
                           const NodeRange& lines) noexcept {
  std::array<wind::turbulence::GustNoise::Layer, wind::turbulence::GustNoise::kMaxLayers> octaves;
  const std::size_t count = gusts_->layers(moment, octaves);
  static_assert(wind::turbulence::GustNoise::kMaxLayers <= operators::VectorSampleJob::kMaxLayers);
  std::array<operators::VectorLayer, wind::turbulence::GustNoise::kMaxLayers> fine;
  std::array<operators::VectorLayer, wind::turbulence::GustNoise::kMaxLayers> coarse;
  const NodeRange fine_range = nodes_of(lines);
  const NodeRange coarse_range = coarse_nodes_of(lines);
  std::size_t fine_count = 0;
  std::size_t coarse_count = 0;
  for (const wind::turbulence::GustNoise::Layer& layer : std::span(octaves).first(count)) {
    const float held = held_[layer.octave];
    if (held == 0.0F) continue;
    const bool is_slow = is_coarse(layer.octave);
    const Nodes& nodes = is_slow ? coarse_ : fine_;
    const NodeRange& range = is_slow ? coarse_range : fine_range;
    const std::size_t torus = wind::turbulence::GustNoise::torus_of(layer.octave);
    // Not in one expression: gcc 12 leaves arguments unset if a list is assigned to a conditional.
    operators::VectorLayer& sampled = is_slow ? coarse[coarse_count++] : fine[fine_count++];
    sampled = {.tile = layer.tile,
               .quarter = layer.quarter,
               .cosine = layer.cosine,
               .sine = layer.sine,
               .place_x = range.of(std::span(nodes.on_torus_x[torus])),
               .place_z = range.of(std::span(nodes.on_torus_z[torus])),
               .offset = layer.offset,
               .ahead_x = layer.ahead_x,
               .ahead_z = layer.ahead_z,
               .along = held * layer.along_m_s,
               .across = held * layer.across_m_s,
               .along_weights = range.of(weights.along[layer.octave]),
               .across_weights = range.of(weights.across[layer.octave]),
               .strength = layer.strength,
               .strength_per_fall_s = layer.strength_per_fall_s,
               .samples_per_m = layer.samples_per_m};
  }
  const auto add_up = [this](std::span<const operators::VectorLayer> layers, Nodes& nodes, const NodeRange& range) {
    operators::VectorSampleJob{.layers = layers,
                               .row = row_,
                               .out_along = range.of(std::span(nodes.along_m_s)),
                               .out_across = range.of(std::span(nodes.across_m_s))}
        .run();
  };
  add_up(std::span(fine).first(fine_count), fine_, fine_range);
  add_up(std::span(coarse).first(coarse_count), coarse_, coarse_range);
}

/// Adds the coarse nodes' values to the nodes', and multiplies them by the strength at the place.
void GustNodes::add_coarse(const NodeRange& lines) noexcept {
  const std::size_t coarse_columns = line_envelope_.size();
  for (std::size_t line = lines.first; line < lines.first + lines.count; ++line) {
    const std::size_t north = lines_[line].first;
    const float z_fraction = lines_[line].fraction;
    for (std::size_t column = 0; column < coarse_columns; ++column) {
      const std::size_t here = north * coarse_columns + column;
      const std::size_t south = here + (envelope_.size() > coarse_columns ? coarse_columns : 0);
      const auto at = [&](const std::vector<float>& values) {
        return values[here] + z_fraction * (values[south] - values[here]);
      };
      line_along_m_s_[column] = at(coarse_.along_m_s);
      line_across_m_s_[column] = at(coarse_.across_m_s);
      line_envelope_[column] = at(envelope_);
    }
    for (std::size_t column = 0; column < columns_.size(); ++column) {
      const std::size_t west = columns_[column].first;
      const float x_fraction = columns_[column].fraction;
      const std::size_t east = std::min(west + 1, coarse_columns - 1);
      const auto at = [&](const std::vector<float>& values) {
        return values[west] + x_fraction * (values[east] - values[west]);
      };
      const std::size_t node = line * columns_.size() + column;
      const float strength = at(line_envelope_);
      fine_.along_m_s[node] = strength * (fine_.along_m_s[node] + at(line_along_m_s_));
      fine_.across_m_s[node] = strength * (fine_.across_m_s[node] + at(line_across_m_s_));
    }
  }
}

}  // namespace yuragi::scenes
