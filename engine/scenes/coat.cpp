#include "engine/scenes/coat.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string_view>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/scenes/blank_strands.hpp"

namespace yuragi::scenes {
namespace {

/// Large, as in the paper for fur: smooth from hair to hair.
constexpr double kCoatBeta = 3.0;

using Vector = std::array<double, 3>;

Vector scaled(double factor, const Vector& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}
Vector sum(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector unit(const Vector& a) {
  return scaled(1.0 / std::sqrt(dot(a, a)), a);
}

noise::Tile2 coat_noise(const CoatSpec& spec, std::string_view property) {
  const std::size_t size = std::bit_ceil(std::max({spec.hairs_along, spec.hairs_around, noise::kMinNoiseSize}));
  return noise::make_noise_2d({.size = size,
                               .beta = kCoatBeta,
                               .meaning = noise::BetaMeaning::kRadial,
                               .seed = spec.seed ^ math::stream_id(property)})
      .value();
}

}  // namespace

Coat make_coat(const CoatSpec& spec) {
  const std::size_t count = spec.hairs_along * spec.hairs_around;
  Coat coat{blank_strands(count, spec.links), {}, {}, {}, {}, {}};
  for (auto* array : {&coat.place_x_m, &coat.place_z_m, &coat.normal_x, &coat.normal_z, &coat.flexibility}) {
    array->assign(coat.skeleton.padded_count(), 0.0F);
  }
  const noise::Tile2 parting_noise = coat_noise(spec, "coat parting");
  const noise::Tile2 length_noise = coat_noise(spec, "coat length");
  const noise::Tile2 lie_noise = coat_noise(spec, "coat lie");
  const math::RandomStream random(spec.seed, math::stream_id("coat stray"));

  const double a_m = 0.5 * spec.body_length_m;
  const double b_m = spec.body_height_m;
  const double c_m = 0.5 * spec.body_width_m;
  for (std::size_t hair = 0; hair < count; ++hair) {
    const std::size_t along = hair / spec.hairs_around;
    const std::size_t around = hair % spec.hairs_around;
    const auto [stray_u, stray_v] = random.uniform_pair(hair);
    const std::size_t on_noise = around * parting_noise.size / spec.hairs_around;

    // Place: even steps in height along the axis are even areas of a sphere (Archimedes), and nearly so here.
    const double u = 2.0 * (static_cast<double>(along) + stray_u) / static_cast<double>(spec.hairs_along) - 1.0;
    const double turn_rad =
        kPi * ((static_cast<double>(around) + stray_v) / static_cast<double>(spec.hairs_around) - 0.5);
    const double ring = std::sqrt(1.0 - u * u);
    const Vector root = {a_m * u, b_m * ring * std::cos(turn_rad), c_m * ring * std::sin(turn_rad)};
    const Vector normal = unit({root[0] / (a_m * a_m), root[1] / (b_m * b_m), root[2] / (c_m * c_m)});

    // Direction of its lie: backward and down, in the body's plane, with locks that part. At the front end only
    // backward, so that the whorl from which all hairs lie away is on the ground.
    const double front = std::max(normal[0], 0.0);
    const Vector wish = {-1.0, -0.55 * (1.0 - front * front), 0.0};
    const Vector along_body = sum(wish, scaled(-dot(wish, normal), normal));
    const Vector flat = dot(along_body, along_body) > 1e-3 ? unit(along_body) : unit(cross(normal, {0.0, 0.0, 1.0}));
    const double parting_rad = spec.parting_deg * kRadPerDeg * static_cast<double>(parting_noise.at(along, on_noise));
    const Vector combed = sum(scaled(std::cos(parting_rad), flat), scaled(std::sin(parting_rad), cross(normal, flat)));
    const double lie_rad =
        kRadPerDeg *
        std::clamp(spec.lie_deg * (1.0 + 0.15 * static_cast<double>(lie_noise.at(along, on_noise))), 0.0, 85.0);
    const Vector rest = sum(scaled(std::cos(lie_rad), normal), scaled(std::sin(lie_rad), combed));
    const Vector curl = sum(scaled(-std::sin(lie_rad), normal), scaled(std::cos(lie_rad), combed));

    pose::StrandSkeleton& skeleton = coat.skeleton;
    skeleton.root_x_m[hair] = static_cast<float>(root[0]);
    skeleton.root_y_m[hair] = static_cast<float>(root[1]);
    skeleton.root_z_m[hair] = static_cast<float>(root[2]);
    skeleton.rest_x[hair] = static_cast<float>(rest[0]);
    skeleton.rest_y[hair] = static_cast<float>(rest[1]);
    skeleton.rest_z[hair] = static_cast<float>(rest[2]);
    skeleton.curl_x[hair] = static_cast<float>(curl[0]);
    skeleton.curl_y[hair] = static_cast<float>(curl[1]);
    skeleton.curl_z[hair] = static_cast<float>(curl[2]);

    const double longer =
        std::clamp(1.0 + spec.length_variation * static_cast<double>(length_noise.at(along, on_noise)), 0.4, 1.8);
    const auto links = static_cast<double>(spec.links);
    skeleton.link_length_m[hair] = static_cast<float>(spec.length_m * longer / links);
    skeleton.rest_curl_rad[hair] = static_cast<float>(spec.curl_deg * kRadPerDeg / links);
    coat.flexibility[hair] = static_cast<float>(longer);
    coat.place_x_m[hair] = static_cast<float>(root[0]);
    coat.place_z_m[hair] = static_cast<float>(turn_rad * 0.5 * (b_m + c_m));
    coat.normal_x[hair] = static_cast<float>(normal[0]);
    coat.normal_z[hair] = static_cast<float>(normal[2]);
  }
  return coat;
}

}  // namespace yuragi::scenes
