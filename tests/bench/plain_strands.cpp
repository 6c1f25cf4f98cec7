#include "tests/bench/plain_strands.hpp"

#include <cmath>
#include <utility>

#include "engine/operators/oscillator_job.hpp"

namespace yuragi::bench {
namespace {

constexpr float kTurbulence = 0.4F;
constexpr float kHalfBendSpeed_m_s = 7.0F;
constexpr float kMaxBend_rad = 1.4F;
constexpr double kNatural_hz = 2.0;
constexpr double kDamping = 0.2;

}  // namespace

PlainStrands::PlainStrands(const pose::StrandSkeleton& skeleton, std::vector<float> flexibility, noise::Tile2 first,
                           noise::Tile2 second, double period_m, double second_period_m)
    : skeleton_(&skeleton),
      flexibility_(std::move(flexibility)),
      first_(std::move(first)),
      second_(std::move(second)),
      period_m_(period_m),
      second_period_m_(second_period_m),
      east_(skeleton.strand_count),
      south_(skeleton.strand_count),
      bend_east_rad_(skeleton.strand_count),
      bend_south_rad_(skeleton.strand_count),
      joints_m_(3 * skeleton.strand_count * skeleton.links_per_strand) {
  for (const float curl_rad : skeleton.rest_curl_rad) {
    curl_cos_.push_back(std::cos(curl_rad));
    curl_sin_.push_back(std::sin(curl_rad));
  }
}

float PlainStrands::noise_at(const noise::Tile2& tile, float x_m, float z_m, double period_m,
                             const PlainOffset& offset) const {
  const auto size = static_cast<float>(tile.size);
  const auto cells_per_m = static_cast<float>(static_cast<double>(tile.size) / period_m);
  float x = (x_m - static_cast<float>(offset.x_m)) * cells_per_m;
  float z = (z_m - static_cast<float>(offset.z_m)) * cells_per_m;
  x -= size * std::floor(x / size);
  z -= size * std::floor(z / size);
  const auto west = static_cast<std::size_t>(x) & (tile.size - 1);
  const auto north = static_cast<std::size_t>(z) & (tile.size - 1);
  const std::size_t east = (west + 1) & (tile.size - 1);
  const std::size_t south = (north + 1) & (tile.size - 1);
  const float x_share = x - std::floor(x);
  const float z_share = z - std::floor(z);
  const float along_north = tile.at(west, north) + x_share * (tile.at(east, north) - tile.at(west, north));
  const float along_south = tile.at(west, south) + x_share * (tile.at(east, south) - tile.at(west, south));
  return along_north + z_share * (along_south - along_north);
}

void PlainStrands::frame(double east_m_s, double south_m_s, double dt_s, double hybrid) {
  offset_.x_m += east_m_s * dt_s;
  offset_.z_m += south_m_s * dt_s;
  const auto speed = static_cast<float>(std::sqrt(east_m_s * east_m_s + south_m_s * south_m_s));
  const float toward_east = static_cast<float>(east_m_s) / speed;
  const float toward_south = static_cast<float>(south_m_s) / speed;
  const operators::OscillatorStep step = operators::OscillatorStep::exact(kNatural_hz, kDamping, dt_s);
  const auto sway = [&step, hybrid](Oscillator& oscillator, float g) {
    const float e = oscillator.value - g;
    const float value =
        g + (static_cast<float>(step.q_from_e) * e + static_cast<float>(step.q_from_v) * oscillator.rate);
    oscillator.rate = static_cast<float>(step.v_from_e) * e + static_cast<float>(step.v_from_v) * oscillator.rate;
    oscillator.value = value;
    return g + static_cast<float>(hybrid) * (value - g);
  };

  for (std::size_t strand = 0; strand < skeleton_->strand_count; ++strand) {
    const float x_m = skeleton_->root_x_m[strand];
    const float z_m = skeleton_->root_z_m[strand];
    const float noise = 0.70710678F * (noise_at(first_, x_m, z_m, period_m_, offset_) +
                                       noise_at(second_, x_m, z_m, second_period_m_, offset_));
    const float strength = std::fmax(1.0F + kTurbulence * noise, 0.0F);
    const float s = speed * strength * flexibility_[strand] / kHalfBendSpeed_m_s;
    const float bend = kMaxBend_rad * (s * s / (1.0F + s * s));
    float east = bend * toward_east;
    float south = bend * toward_south;
    if (hybrid > 0.0) {
      east = sway(east_[strand], east);
      south = sway(south_[strand], south);
    }
    bend_east_rad_[strand] = east;
    bend_south_rad_[strand] = south;
    joints_of(strand);
  }
}

void PlainStrands::joints_of(std::size_t strand) {
  const pose::StrandSkeleton& s = *skeleton_;
  const std::size_t links = s.links_per_strand;
  const float east = bend_east_rad_[strand];
  const float south = bend_south_rad_[strand];
  const float angle = std::sqrt(east * east + south * south);
  const float b_x = angle > 0.0F ? east / angle : 1.0F;
  const float b_z = angle > 0.0F ? south / angle : 0.0F;

  // One link's share of the bend, and of the curl; both are turned on from link to link.
  float turn_sin = 0.0F;
  float turn_cos = 0.0F;
  sincosf(angle / static_cast<float>(links), &turn_sin, &turn_cos);
  float bend_sin = turn_sin;
  float bend_cos = turn_cos;
  float curl_sin = 0.0F;
  float curl_cos = 1.0F;

  float x_m = s.root_x_m[strand];
  float y_m = s.root_y_m[strand];
  float z_m = s.root_z_m[strand];
  const float length_m = s.link_length_m[strand];
  float* out = joints_m_.data() + 3 * strand * links;
  for (std::size_t link = 0; link < links; ++link) {
    // The link's rest direction, in parts along the bend, up, and across; turned in the plane of the first two.
    const float d_x = s.rest_x[strand] * curl_cos + s.curl_x[strand] * curl_sin;
    const float d_y = s.rest_y[strand] * curl_cos + s.curl_y[strand] * curl_sin;
    const float d_z = s.rest_z[strand] * curl_cos + s.curl_z[strand] * curl_sin;
    const float along = d_x * b_x + d_z * b_z;
    const float across = d_x * b_z - d_z * b_x;
    const float turned = along * bend_cos + d_y * bend_sin;
    x_m += length_m * (turned * b_x + across * b_z);
    y_m += length_m * (d_y * bend_cos - along * bend_sin);
    z_m += length_m * (turned * b_z - across * b_x);
    out[3 * link] = x_m;
    out[3 * link + 1] = y_m;
    out[3 * link + 2] = z_m;

    const float next_bend_cos = bend_cos * turn_cos - bend_sin * turn_sin;
    bend_sin = bend_cos * turn_sin + bend_sin * turn_cos;
    bend_cos = next_bend_cos;
    const float next_curl_cos = curl_cos * curl_cos_[strand] - curl_sin * curl_sin_[strand];
    curl_sin = curl_cos * curl_sin_[strand] + curl_sin * curl_cos_[strand];
    curl_cos = next_curl_cos;
  }
}

}  // namespace yuragi::bench
