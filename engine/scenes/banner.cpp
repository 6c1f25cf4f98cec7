#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/scenes/cloth.hpp"
#include "engine/scenes/cloth_noise.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"

// A nobori, the tall banner of festivals and shop fronts, after N. Chiba, "Development of core technology for a
// noise-based real-time animation engine for fluctuation phenomena" (Iwate University), section 3.2 and figure 11:
//
//   shift    the wind carries a 2-D noise along the banner                                          ShiftJob
//   sample   each column reads it where it hangs                                                   SampleJob
//   project  a base sway for all of it, and the noise propagates from the cross-arm down, growing  Cloth
//
// Row 0 hangs from the cross-arm and the first column is on the pole: neither moves. From the pole to the free side
// sway and noise grow with the distance, so that the cloth is not torn from it; and the base sway is small, since a
// thread that is held by its side cannot hang far out.

namespace yuragi {
namespace {

const std::array kBannerParameters = {
    Parameter{"columns", "", std::int64_t{64}, 2, 4000, "threads from the pole to the free side"},
    Parameter{"rows", "", std::int64_t{256}, 2, 4000, "joints from the cross-arm down"},
    Parameter{"width", "m", 0.6, 0.05, 20, "of the cloth"},
    Parameter{"height", "m", 2.7, 0.1, 50, "of the cloth"},
    Parameter{"clearance", "m", 0.5, 0, 50, "between the cloth and the ground"},
    Parameter{"max_sway", "deg", 10.0, 0, 60, "how far the strongest wind blows the free side out"},
    Parameter{"max_flutter", "deg", 50.0, 0, 80, "how far the strongest wind makes the free corner flutter"},
    Parameter{"half_sway_speed", "m/s", 4.5, 0.1, 60, "the wind that moves it half as much"},
    Parameter{"travel_time", "s", 1.2, 0, 10, "that the noise takes from the cross-arm to the bottom"},
    Parameter{"growth", "", 0.4, 0, 4, "the noise grows as the way from the cross-arm to this power"},
    Parameter{"quickness", "rad/s", 18.0, 0.5, 50, "how quickly it follows; heavier cloth has less"},
    Parameter{"hybrid", "", 0.0, 0, 1, "0: the noise alone; 1: dynamics of a coarse cloth, with the noise as detail"},
    Parameter{"tile_period", "m", 6.0, 2, 4096, "the longest wave of the noise; 128 samples"},
    Parameter{"beta", "", 1.3, kMinTransectBeta2, 4, "exponent of the noise's spectrum along a line, 1/f^beta"},
};

/// In the hybrid the cloth is taut from the pole to the free side, and by its loops the pole takes most of the wind.
ClothSpec banner_spec(const ParameterValues& values) {
  return {.rows = static_cast<std::size_t>(values.integer("rows")),
          .length_m = values.number("height"),
          .is_first_column_fixed = true,
          .travel_time_s = values.number("travel_time"),
          .growth_exponent = values.number("growth"),
          .quickness_rad_s = values.number("quickness"),
          .largest_sway = lean_of_deg(values.number("max_sway")),
          .largest_wave = lean_of_deg(values.number("max_flutter")),
          .hybrid = values.number("hybrid"),
          .normal_drag_per_m = 0.6 * drag_per_m(values.number("half_sway_speed")),
          .skin_drag_per_m = 0.05 * drag_per_m(values.number("half_sway_speed")),
          .across_stiffness_s2 = 6'000.0};
}

/// The pole stands at the scene's origin, the cross-arm points to the scene's east.
ClothEdge banner_edge(const ParameterValues& values, const SceneSetup& setup) {
  ClothEdge edge(static_cast<std::size_t>(values.integer("columns")));
  const double pitch_m = values.number("width") / static_cast<double>(edge.columns - 1);
  for (std::size_t column = 0; column < edge.stride(); ++column) {
    const Turned place = turned(setup.placement, pitch_m * static_cast<double>(column), 0.0);
    edge.x_m[column] = static_cast<float>(setup.placement.x_m + place.east);
    edge.y_m[column] = static_cast<float>(setup.placement.y_m + values.number("height") + values.number("clearance"));
    edge.z_m[column] = static_cast<float>(setup.placement.z_m + place.south);
  }
  return edge;
}

class Banner final : public Scene {
 public:
  Banner(const ParameterValues& values, const SceneSetup& setup) : Banner(banner_edge(values, setup), values, setup) {}

  const Skeleton& skeleton() const noexcept override { return cloth_.skeleton(); }
  const Pose& pose() const noexcept override { return cloth_.pose(); }
  double largest_joint_step_m(double dt_s) const noexcept override { return cloth_.largest_joint_step_m(dt_s); }

  void shift(const GroundWind& wind, double dt_s) noexcept override {
    wind_.step(wind, dt_s);
    noise_.shift(wind_.east_m_s(), wind_.south_m_s(), dt_s);
  }
  void sample() noexcept override { noise_.sample(flutter_); }

  void project(double dt_s) noexcept override {
    // How much the wind blows across the banner, and how much it blows at all.
    const double speed_m_s = wind_.speed_m_s();
    const double s = speed_m_s / half_sway_speed_m_s_;
    const double strength = s * s / (1.0 + s * s);
    const double per_speed = speed_m_s > 0.0 ? strength / speed_m_s : 0.0;
    const double across = (wind_.south_m_s() * arm_.east - wind_.east_m_s() * arm_.south) * per_speed;

    // It gives way across itself, more the farther from the pole.
    const double swell = 0.6 + own_swell_ * static_cast<double>(noise_.swell());
    const auto sway_across = static_cast<float>(max_sway_ * swell * across);
    const auto wave_across = static_cast<float>(max_wave_ * strength);
    const auto across_east = static_cast<float>(-arm_.south);
    const auto across_south = static_cast<float>(arm_.east);
    const std::span<float> sway = cloth_.sway();
    const std::span<float> wave = cloth_.wave();
    const std::size_t stride = flutter_.size();
    for (std::size_t column = 0; column < stride; ++column) {
      const float column_sway = from_pole_[column] * sway_across;
      const float column_wave = from_pole_[column] * flutter_[column] * wave_across;
      sway[column] = column_sway * across_east;
      sway[stride + column] = column_sway * across_south;
      wave[column] = column_wave * across_east;
      wave[stride + column] = column_wave * across_south;
    }
    cloth_.blow(wind_.east_m_s(), wind_.south_m_s(), flutter_);
    cloth_.project(dt_s);
  }

 private:
  Banner(const ClothEdge& edge, const ParameterValues& values, const SceneSetup& setup)
      : half_sway_speed_m_s_(values.number("half_sway_speed")),
        max_sway_(lean_of_deg(values.number("max_sway"))),
        max_wave_(lean_of_deg(values.number("max_flutter"))),
        arm_(turned(setup.placement, 1.0, 0.0)),
        own_swell_(setup.gusts ? 0.0 : 0.4),
        wind_(setup.placement, setup.gusts),
        noise_(values, setup.seed ^ stream_id("banner noise"), edge.x_m, edge.z_m, setup.row),
        flutter_(edge.stride(), 0.0F),
        from_pole_(edge.stride(), 0.0F),
        cloth_(banner_spec(values), edge, setup.row) {
    for (std::size_t column = 0; column < edge.stride(); ++column) {
      from_pole_[column] = std::min(static_cast<float>(column) / static_cast<float>(edge.columns - 1), 1.0F);
    }
  }

  double half_sway_speed_m_s_;
  double max_sway_;  ///< leans
  double max_wave_;
  Turned arm_;  ///< where the cross-arm points to

  double own_swell_;  ///< how much the whole of it swells by itself; gusts from outside are swell enough
  SceneWind wind_;
  ClothNoise noise_;
  std::vector<float> flutter_;    ///< each column's noise
  std::vector<float> from_pole_;  ///< 0 on the pole, 1 at the free side
  Cloth cloth_;
};

}  // namespace

extern const SceneDescription kBannerScene;
const SceneDescription kBannerScene = {.name = "banner",
                                       .summary = "a nobori, held by its pole and cross-arm, that flutters in the wind",
                                       .parameters = kBannerParameters,
                                       .make = [](const ParameterValues& values, const SceneSetup& setup) {
                                         return std::unique_ptr<Scene>(std::make_unique<Banner>(values, setup));
                                       }};

}  // namespace yuragi
