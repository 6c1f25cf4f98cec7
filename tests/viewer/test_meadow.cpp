#include "tests/viewer/test_meadow.hpp"

#include <array>
#include <cmath>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"

namespace yuragi::viewer {

pose::Skeleton test_meadow(std::size_t side, double size_m) {
  constexpr std::size_t kLinks = 10;
  pose::StrandSkeleton meadow;
  meadow.strand_count = side * side;
  meadow.links_per_strand = kLinks;
  const math::RandomStream chance(1, math::stream_id("test meadow"));
  for (std::size_t i = 0; i < meadow.padded_count(); ++i) {
    const auto [jitter_x, jitter_z] = chance.uniform_pair(3 * i);
    const auto [tilt, bearing] = chance.uniform_pair(3 * i + 1);
    const auto [longer, curl] = chance.uniform_pair(3 * i + 2);
    const std::size_t row = i / side;
    const double cell_m = size_m / static_cast<double>(side);
    const double x_m = (static_cast<double>(i % side) + jitter_x) * cell_m - size_m / 2;
    const double z_m = (static_cast<double>(row) + jitter_z) * cell_m - size_m / 2;
    const double angle = 2 * kPi * bearing;
    const double lean = 0.25 * tilt;
    const double patch = std::sin(0.8 * x_m) * std::sin(0.6 * z_m + 1.0);
    const std::array<double, 3> rest{std::sin(lean) * std::sin(angle), std::cos(lean),
                                     std::sin(lean) * std::cos(angle)};
    const std::array<double, 3> across{std::cos(lean) * std::sin(angle), -std::sin(lean),
                                       std::cos(lean) * std::cos(angle)};
    meadow.root_x_m.push_back(static_cast<float>(x_m));
    meadow.root_y_m.push_back(0.0F);
    meadow.root_z_m.push_back(static_cast<float>(z_m));
    meadow.rest_x.push_back(static_cast<float>(rest[0]));
    meadow.rest_y.push_back(static_cast<float>(rest[1]));
    meadow.rest_z.push_back(static_cast<float>(rest[2]));
    meadow.curl_x.push_back(static_cast<float>(across[0]));
    meadow.curl_y.push_back(static_cast<float>(across[1]));
    meadow.curl_z.push_back(static_cast<float>(across[2]));
    meadow.rest_curl_rad.push_back(static_cast<float>(0.02 + 0.06 * curl));
    meadow.link_length_m.push_back(static_cast<float>((0.55 + 0.3 * longer + 0.12 * patch) / kLinks));
  }
  return meadow;
}

pose::Pose test_pose(const pose::Skeleton& meadow, double time_s, double lean_rad, double sway_rad, double toward_deg) {
  const auto& strands = std::get<pose::StrandSkeleton>(meadow);
  const double toward = toward_deg * kRadPerDeg;
  pose::StrandPose pose;
  for (std::size_t i = 0; i < strands.padded_count(); ++i) {
    const auto x_m = static_cast<double>(strands.root_x_m[i]);
    const auto z_m = static_cast<double>(strands.root_z_m[i]);
    const double downwind_m = x_m * std::sin(toward) - z_m * std::cos(toward);
    const double crosswind_m = x_m * std::cos(toward) + z_m * std::sin(toward);
    const double phase = 1.5 * (downwind_m - 3.0 * time_s) + 0.8 * std::sin(0.7 * crosswind_m + 0.4 * time_s);
    const double gust = 0.5 + 0.5 * std::sin(phase);
    const double bend = lean_rad + sway_rad * (gust * gust + 0.12 * std::sin(6.0 * time_s + 12.9 * x_m + 7.3 * z_m));
    pose.bend_east_rad.push_back(static_cast<float>(bend * std::sin(toward)));
    pose.bend_south_rad.push_back(static_cast<float>(-bend * std::cos(toward)));
  }
  return pose;
}

wire::Bytes greeting_for(const pose::Skeleton& meadow) {
  return wire::encode(wire::Hello{wire::kProtocol, "a test meadow", 60.0}) +
         wire::encode(wire::Scenes{{{"meadow", "grass", meadow}}});
}

wire::Bytes frame_of(const pose::Skeleton& meadow, const pose::Pose& pose, std::uint64_t sequence, double time_s,
                     double toward_deg, wire::FrameEncoder& encoder) {
  const std::array<const pose::Skeleton*, 1> skeletons{&meadow};
  const std::array<const pose::Pose*, 1> poses{&pose};
  wire::FrameInfo info;
  info.sequence = info.tick = sequence;
  info.time_s = time_s;
  info.wind.wind = wind::wind_from(6.0, toward_deg + 180.0);
  info.wind.source = wind::Source::kLive;
  info.wind.live_weight = 1.0;
  const auto bytes = encoder.encode(info, skeletons, poses);
  return {bytes.begin(), bytes.end()};
}

}  // namespace yuragi::viewer
