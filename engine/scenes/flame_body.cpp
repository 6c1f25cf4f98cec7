#include "engine/scenes/flame_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "engine/base/units.hpp"
#include "engine/math/trig.hpp"
#include "engine/scenes/placement.hpp"

namespace yuragi::scenes {
namespace {

/// A panel is higher than its flame, whose last tongues go out above it, and wide enough for one that leans:
/// FlameInWind reaches at most two thirds of its height to a side.
constexpr double kPanelHeight = 1.35;
constexpr double kPanelReach = 0.7;

/// A body has the thickness sqrt(v) (1 - v) times this times its half width, v from foot to top: thickest, as thick as
/// its width, at a third.
constexpr double kThickest = 1.5 * 1.7320508075688772;

/// The noise moves the foot by this part of the usual movement, which is reached at this part of the height.
constexpr double kSteadyFoot = 0.25;
constexpr double kFreeAt = 0.5;

/// A color of the ramp: its position, and red, green, blue and alpha (sRGB, straight alpha).
struct RampColor {
  double at;
  std::array<double, 4> rgba;
};
constexpr std::array<RampColor, 7> kFlameColors = {{{0.00, {20, 0, 0, 0}},
                                                    {0.12, {70, 6, 0, 40}},
                                                    {0.30, {185, 32, 4, 140}},
                                                    {0.50, {245, 100, 12, 210}},
                                                    {0.70, {255, 175, 40, 240}},
                                                    {0.87, {255, 228, 120, 252}},
                                                    {1.00, {255, 250, 225, 255}}}};

std::vector<std::uint8_t> flame_ramp() {
  std::vector<std::uint8_t> ramp;
  for (int color = 0; color < 256; ++color) {
    const double at = color / 255.0;
    std::size_t next = 1;
    while (kFlameColors[next].at < at) ++next;
    const RampColor& below = kFlameColors[next - 1];
    const RampColor& above = kFlameColors[next];
    const double part = (at - below.at) / (above.at - below.at);
    for (std::size_t channel = 0; channel < 4; ++channel) {
      const double value = below.rgba[channel] + part * (above.rgba[channel] - below.rgba[channel]);
      ramp.push_back(static_cast<std::uint8_t>(std::lround(value)));
    }
  }
  return ramp;
}

void add_point(pose::SurfaceSkeleton& surface, std::array<double, 3> place_m, std::array<double, 3> normal) {
  surface.rest_x_m.push_back(static_cast<float>(place_m[0]));
  surface.rest_y_m.push_back(static_cast<float>(place_m[1]));
  surface.rest_z_m.push_back(static_cast<float>(place_m[2]));
  surface.normal_x.push_back(static_cast<float>(normal[0]));
  surface.normal_y.push_back(static_cast<float>(normal[1]));
  surface.normal_z.push_back(static_cast<float>(normal[2]));
}

void add_flame_point(std::array<double, 3> place_m, std::array<double, 3> normal, double radius_m, double moved_m,
                     FlameBody& body) {
  add_point(body.surface, place_m, normal);
  body.east_m.push_back(static_cast<float>(place_m[0]));
  body.up_m.push_back(static_cast<float>(place_m[1]));
  body.south_m.push_back(static_cast<float>(place_m[2]));
  body.radius_m.push_back(static_cast<float>(radius_m));
  body.moved_m.push_back(static_cast<float>(moved_m));
}

void add_panel_row(const FlameBodySpec& spec, double up_m, FlameBody& body) {
  const double half_m = 0.75 * spec.width_m + kPanelReach * spec.height_m;
  for (std::size_t column = 0; column < spec.columns; ++column) {
    const double across_m = (2.0 * static_cast<double>(column) / static_cast<double>(spec.columns - 1) - 1.0) * half_m;
    add_flame_point({across_m, up_m, 0.0}, {0.0, 0.0, 1.0}, 0.0, 0.0, body);
  }
}

void add_body_row(const FlameBodySpec& spec, double up_m, FlameBody& body) {
  const double v = up_m / spec.height_m;
  const double root = std::max(std::sqrt(v), 1e-6);
  const std::size_t around = body.surface.columns / kFlameShells.size();
  for (const double part : kFlameShells) {
    const double half_m = 0.5 * part * spec.width_m;
    const double radius_m = half_m * kThickest * std::sqrt(v) * (1.0 - v);
    const double moved_m = radius_m * std::min(kSteadyFoot + v * (1.0 - kSteadyFoot) / kFreeAt, 1.0);

    // The normal is perpendicular to the outline, whose radius grows by d radius / d up; at the foot it points down.
    const double growth = kThickest * half_m * (0.5 / root - 1.5 * root) / spec.height_m;
    const double length = std::sqrt(1.0 + growth * growth);
    for (std::size_t column = 0; column < around; ++column) {
      const math::SinCos turn =
          math::sin_cos(static_cast<float>(2.0 * kPi * static_cast<double>(column) / static_cast<double>(around)));
      const auto x = static_cast<double>(turn.cos);
      const auto z = static_cast<double>(turn.sin);
      add_flame_point({radius_m * x, up_m, radius_m * z}, {x / length, -growth / length, z / length}, radius_m, moved_m,
                      body);
    }
    body.largest_radius_m = std::max(body.largest_radius_m, radius_m);
  }
}

}  // namespace

FlameBody make_flame_body(const FlameBodySpec& spec, const Placement& placement) {
  FlameBody body;
  body.is_panel = spec.is_panel;
  const std::size_t shells = spec.is_panel ? 1 : kFlameShells.size();
  body.surface.columns = spec.columns - spec.columns % shells;
  body.surface.rows = spec.rows;
  body.surface.is_closed = !spec.is_panel;
  body.surface.shells = shells;
  body.surface.axis_x_m.assign(spec.is_panel ? 0 : spec.rows, 0.0F);
  body.surface.axis_z_m = body.surface.axis_x_m;
  body.surface.ramp_rgba = flame_ramp();

  const double top_m = spec.is_panel ? kPanelHeight * spec.height_m : spec.height_m;
  for (std::size_t row = 0; row < spec.rows; ++row) {
    const double up_m = top_m * static_cast<double>(row) / static_cast<double>(spec.rows - 1);
    if (spec.is_panel) {
      add_panel_row(spec, up_m, body);
    } else {
      add_body_row(spec, up_m, body);
    }
    body.along.push_back(static_cast<float>(up_m / spec.height_m));
  }

  for (float& y_m : body.surface.rest_y_m) y_m += static_cast<float>(spec.foot_m);
  place(placement, body.surface);
  body.panel_east = std::cos(placement.heading_deg * kRadPerDeg);
  body.panel_south = std::sin(placement.heading_deg * kRadPerDeg);
  return body;
}

}  // namespace yuragi::scenes
