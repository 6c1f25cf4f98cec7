#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "engine/base/units.hpp"
#include "engine/math/critically_damped.hpp"
#include "engine/math/philox.hpp"
#include "engine/operators/displacement_job.hpp"
#include "engine/operators/threshold_ramp_job.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/scenes/flame_body.hpp"
#include "engine/scenes/layered_noise.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"

// A flame (Chiba, section 2-2, figure 4b), as a texture on an upright panel or as the shape of a body:
//
//   shift    two noises rise, one faster than the other, so that tongues change as they rise        LayeredNoise
//   sample   the noise shows only above a threshold that rises from the foot to the top             ThresholdRampJob
//   project  what shows is the heat, which indexes a color ramp; the shape's points are moved       DisplacementJob
//            along their normals by the same noise
//
// The wind leans the flame: by tan(max_lean) U^2 / (U^2 + half_speed^2) of a point's height, less near the foot, and
// with a little inertia. The panel's picture is sheared, and only by the wind along the panel; the body's points move
// along their normals as far as the shear takes them.
//
// A flame burns in calm air too. Its rest pose is the body, or the panel, upright and not yet lit (no heat); it catches
// fire in the first seconds. In calm air it burns upright. (is_still_in_calm is false.)
//
// Heat changes in a tick of dt by at most 1.5 / edge (the soft edge's slope) times the change of noise minus threshold:
// the layers' largest change while they rise by rise_speed dt and are leaned, (last - first) times the change of
// `along`, and what catching fire does, w dt / e of the whole range of thresholds.

namespace yuragi {
namespace {

/// A layer of noise comes round after this time, whatever the speed: 64 samples in 150 ticks of 1/60 s, so that nothing
/// is finer than what the ticks show (|k| U < pi rate). The second comes round sooner, and has fewer samples.
constexpr double kRound_s = 2.5;
constexpr std::size_t kFirstSamples = 64;
constexpr std::size_t kSecondSamples = 32;
constexpr double kSecondRound_s = kRound_s / std::numbers::phi;
constexpr double kSecondFaster = 1.25;

/// The thresholds at the foot and at the top, and the soft edge, in standard deviations of the noise.
constexpr double kFootThreshold = -2.8;
constexpr double kTopThreshold = 1.3;
constexpr double kEdge = 2.4;

/// How fast a flame catches fire.
constexpr double kKindle_rad_s = 2.5;

/// How fast it follows the wind.
constexpr double kLean_rad_s = 6.0;

/// A lean below this is none: it moves nothing, and is not worth a denormal number.
constexpr double kUpright = 1e-12;

/// A point is never moved farther inward than this part of its distance from the axis.
constexpr float kInward = 0.9F;

constexpr std::array<std::string_view, 2> kFlameForms = {"texture", "shape"};

using namespace std::string_literals;

const std::array kFlameParameters = {
    Parameter{"form",
              "",
              "shape"s,
              {},
              {},
              "texture: colors on an upright panel; shape: a body that the noise displaces",
              kFlameForms},
    Parameter{"columns", "", std::int64_t{128}, 8, 1000, "points across the panel, or around the body"},
    Parameter{"rows", "", std::int64_t{96}, 8, 1000, "points from the foot to the top"},
    Parameter{"height", "m", 1.2, 0.05, 50, "of the flame in calm air"},
    Parameter{"width", "m", 0.5, 0.02, 20, "of its thickest part"},
    Parameter{"rise_speed", "m/s", 1.4, 0.05, 20, "how fast its tongues rise"},
    Parameter{"flicker", "", 0.3, 0, 0.8, "how far the noise moves the shape, as a part of its radius"},
    Parameter{"max_lean", "deg", 45.0, 0, 60, "how far the strongest wind leans it"},
    Parameter{"half_speed", "m/s", 4.0, 0.1, 60, "the wind that leans it half as far"},
    Parameter{"beta", "", 3.0, 1, 6, "exponent of the noise's spectrum, 1/f^beta: less is rougher"},
};

/// The noises stretch along the way that they rise, and fit around the body with no seam.
std::array<NoiseLayerSpec, 2> flame_layers(const ParameterValues& values, double around_m, std::uint64_t seed) {
  const double rise_m_s = values.number("rise_speed");
  const auto noise = [&](std::size_t size, std::uint64_t which) {
    return NoiseSpec{.size = size, .beta = values.number("beta"), .seed = seed ^ which, .integral_scale = 0.1};
  };
  return {
      {{noise(kFirstSamples, stream_id("flame")), around_m, rise_m_s * kRound_s, 0.8F},
       {noise(kSecondSamples, stream_id("flame tongues")), around_m, rise_m_s * kSecondFaster * kSecondRound_s, 0.6F}}};
}

class Flame final : public Scene {
 public:
  Flame(const ParameterValues& values, const SceneSetup& setup)
      : Flame(make_flame_body({.is_panel = values.text("form") == "texture",
                               .columns = static_cast<std::size_t>(values.integer("columns")),
                               .rows = static_cast<std::size_t>(values.integer("rows")),
                               .height_m = values.number("height"),
                               .width_m = values.number("width"),
                               .largest_lean = std::tan(values.number("max_lean") * kRadPerDeg)},
                              setup.placement),
              values, setup) {}

  const Skeleton& skeleton() const noexcept override { return skeleton_; }
  const Pose& pose() const noexcept override { return pose_; }

  void shift(const GroundWind& wind, double dt_s) noexcept override {
    wind_.step(wind, dt_s);
    kindled_.step(1.0, kKindle_rad_s, dt_s);
    const double speed_m_s = wind_.speed_m_s();
    const double lean_s_m = largest_lean_ * speed_m_s / (speed_m_s * speed_m_s + half_speed_m_s_ * half_speed_m_s_);
    follow(lean_east_, lean_s_m * wind_.east_m_s(), dt_s);
    follow(lean_south_, lean_s_m * wind_.south_m_s(), dt_s);

    noise_.shift(0, 0.0, rise_m_s_ * dt_s);
    noise_.shift(1, 0.0, kSecondFaster * rise_m_s_ * dt_s);
  }

  void sample() noexcept override {
    lean(lean_east_.value, lean_south_.value);
    noise_.sample(row_, values_);

    // As the flame kindles the thresholds come down from where nothing shows.
    const double unlit = (1.0 - kindled_.value) * (noise_.highest() - kFootThreshold);
    ThresholdRampJob{.noise = values_,
                     .along = along_,
                     .first_threshold = static_cast<float>(kFootThreshold + unlit),
                     .last_threshold = static_cast<float>(kTopThreshold + unlit),
                     .edge = static_cast<float>(kEdge),
                     .row = row_,
                     .level = std::get_if<SurfacePose>(&pose_)->heat}
        .run();
  }

  void project(double /*dt_s*/) noexcept override {
    if (body_.is_panel) return;  // its colors are all that there is to it

    // The shape's points move along their normals, by the noise and to where they lean.
    std::vector<float>& displacement_m = std::get_if<SurfacePose>(&pose_)->displacement_m;
    DisplacementJob{.noise = values_,
                    .share = body_.radius_m,
                    .amplitude_m = kindled_.value * flicker_,
                    .row = row_,
                    .displacement_m = displacement_m}
        .run();
    for (std::size_t i = 0; i < leaned_m_.size(); ++i) {
      displacement_m[i] = std::max(displacement_m[i] + leaned_m_[i], -kInward * body_.radius_m[i]);
    }
  }

  /// The panel's points do not move at all. The body's move by kindled flicker radius noise + lean lever, cut inward,
  /// which makes no step larger. In a tick `kindled` changes by at most w dt / e, the noise by what rises past, and the
  /// lean, which follows a target that is never longer than tan(max_lean), by at most that times 2 w dt / e.
  double largest_joint_step_m(double dt_s) const noexcept override {
    if (body_.is_panel) return 0.0;
    const double kindled_step = std::min(kKindle_rad_s * dt_s / std::numbers::e, 1.0);
    const double largest_noise = std::max(noise_.highest(), -noise_.lowest());
    const double noise_step = noise_.largest_change(0, 0.0, rise_m_s_ * dt_s) +
                              noise_.largest_change(1, 0.0, kSecondFaster * rise_m_s_ * dt_s);
    const double lean_step = largest_lean_ * std::min(2.0 * kLean_rad_s * dt_s / std::numbers::e, 2.0);
    return flicker_ * body_.largest_radius_m * (noise_step + kindled_step * largest_noise) +
           lean_step * body_.largest_lever_m;
  }

 private:
  Flame(FlameBody body, const ParameterValues& values, const SceneSetup& setup)
      : row_(setup.row),
        rise_m_s_(values.number("rise_speed")),
        flicker_(values.number("flicker")),
        largest_lean_(std::tan(values.number("max_lean") * kRadPerDeg)),
        half_speed_m_s_(values.number("half_speed")),
        wind_(setup.placement, setup.gusts),
        noise_(flame_layers(values, body.around_m, setup.seed), body.across_m, body.up_m),
        values_(body.across_m.size(), 0.0F),
        along_(body.across_m.size(), 0.0F),
        leaned_m_(body.across_m.size(), 0.0F),
        skeleton_(std::move(body.surface)),
        pose_(rest_pose(skeleton_)),
        body_(std::move(body)) {}

  static void follow(CriticallyDamped& lean, double target, double dt_s) noexcept {
    lean.step(target, kLean_rad_s, dt_s);
    if (target == 0.0 && std::abs(lean.value) < kUpright && std::abs(lean.rate_per_s) < kUpright) lean = {};
  }

  /// Leans the flame: where each point is along the rising threshold, and how far the shape's points are moved by it.
  /// `east` and `south` are the lean's tangent.
  void lean(double east, double south) noexcept {
    const auto& surface = *std::get_if<SurfaceSkeleton>(&skeleton_);
    for (std::size_t row = 0; row < surface.rows; ++row) {
      const std::size_t first = row * surface.columns;
      const double lever_m = static_cast<double>(body_.lever_m[row]);
      if (body_.is_panel) {
        const double way_m = lever_m * (east * body_.panel_east + south * body_.panel_south);
        noise_.lean(first, surface.columns, -way_m);
        for (std::size_t i = first; i < first + surface.columns; ++i) {
          const float side = (body_.across_m[i] - static_cast<float>(way_m)) * body_.per_half_width_m[row];
          along_[i] = body_.along[row] + side * side;
        }
      } else {
        const auto east_m = static_cast<float>(lever_m * east);
        const auto south_m = static_cast<float>(lever_m * south);
        const float all_m = std::sqrt(east_m * east_m + south_m * south_m);
        for (std::size_t i = first; i < first + surface.columns; ++i) {
          leaned_m_[i] = surface.normal_x[i] * east_m + surface.normal_z[i] * south_m;
          // Upwind of a leaning flame and beside it there is less to see.
          along_[i] = body_.along[row] + (all_m - leaned_m_[i]) * body_.per_height_m;
        }
      }
    }
  }

  SimdRow row_;
  double rise_m_s_;
  double flicker_;
  double largest_lean_;
  double half_speed_m_s_;

  SceneWind wind_;
  CriticallyDamped kindled_;                 ///< 0 unlit, 1 burning
  CriticallyDamped lean_east_, lean_south_;  ///< tangents
  LayeredNoise noise_;
  std::vector<float> values_, along_, leaned_m_;  ///< a point each
  Skeleton skeleton_;
  Pose pose_;
  FlameBody body_;  ///< but for its surface, which is in skeleton_
};

}  // namespace

extern const SceneDescription kFlameScene;
const SceneDescription kFlameScene = {
    .name = "flame",
    .summary = "a flame: tongues of noise rise, and the wind leans it",
    .parameters = kFlameParameters,
    .make = [](const ParameterValues& values,
               const SceneSetup& setup) { return std::unique_ptr<Scene>(std::make_unique<Flame>(values, setup)); },
    .is_still_in_calm = false};

}  // namespace yuragi
