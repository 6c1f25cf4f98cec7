#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "engine/base/fields.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/base/units.hpp"
#include "engine/math/critically_damped.hpp"
#include "engine/math/philox.hpp"
#include "engine/math/trig.hpp"
#include "engine/noise/line_cut.hpp"
#include "engine/noise/unit_reading.hpp"
#include "engine/operators/displacement_job.hpp"
#include "engine/operators/threshold_ramp_job.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/scenes/flame_axis.hpp"
#include "engine/scenes/flame_body.hpp"
#include "engine/scenes/layered_noise.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"

// A flame (Chiba, section 2-2, figure 4b), as a texture on an upright panel or as the shape of a body:
//
//   shift    two noises rise, one faster than the other, so that tongues change as they rise        LayeredNoise
//   sample the noise shows only above a threshold that rises from the foot to the top             ThresholdRampJob
//   project  what shows is the heat, which indexes a color ramp; the body's points are moved        DisplacementJob
//            along their normals by the same noise, and its rows by the wind                        FlameAxis
//
// A body is three shells, one within another. Inside it is hotter: there the threshold is lower. One noise is read at
// east and height of a point, the other at south and height, so that there is no seam and the shells burn together.
//
// It puffs: a fire draws its air in gulps, 1.5 / sqrt(width) a second (Cetegen and Ahmed 1993, Experiments on the
// periodic instability of buoyant plumes and pool fires), and each gulp rises as a wave that lowers the threshold. Wind
// breaks that up.
//
// A flame burns in calm air too. Its rest pose is the body, or the panel, upright and not yet lit (no heat); it catches
// fire in the first seconds. In calm air it burns upright. (is_still_in_calm is false.) The panel feels the wind along
// it, and shows the bent flame as it would be seen.
//
// Heat changes in a tick of dt by at most 1.5 / edge (the soft edge's slope) times the change of noise minus threshold:
// the layers' largest change while they rise by rise_speed dt, plus 2 pi f dt of a puff, plus w dt / e of the whole
// range of thresholds while catching fire.

namespace yuragi::scenes {
namespace {

/// The time in which the rising gas crosses a tile, s: its samples are 0.04 s apart, so that nothing is finer than
/// ticks of 1/60 s can show (|k| U < pi rate). The tile is slanted, so that nothing repeats after that time.
constexpr double kCrossed_s = 10.24;
constexpr std::size_t kNoiseSamples = 256;
constexpr double kMinWaves = 28.0;  ///< per tile: no tongue is longer than nine tenths of a metre at 2.5 m/s
constexpr double kSecondFaster = 1.25;

/// The flame's width, as a part of a tile. Its height follows from rise_speed: tongues are four times as long as wide.
constexpr double kWidthOfTile = 0.078125;

/// The thresholds at the foot and at the top, and the soft edge, in standard deviations of the noise. Upward they rise
/// as the cube of the height; at the foot of the inner shells they are lower by this, at the top by nothing.
constexpr double kFootThreshold = -3.1;
constexpr double kTopThreshold = 1.5;
constexpr double kEdge = 4.5;
constexpr std::array<double, 3> kHotter = {0.0, 0.9, 1.8};
constexpr double kHotterPanel = 0.9;

/// The maximum reduction of the threshold by puffing, for a standard deviation of the whole heat of 1 (relative to its
/// mean). Measured.
constexpr double kPuff = 15.5;
/// A puff grows as it rises, up to this part of the way.
constexpr double kPuffGrown = 0.6;
/// A puff's pace wanders by a tenth, within seconds; and the wind that halves its power.
constexpr double kPuff_hz_sqrt_m = 1.5;
constexpr double kPaceWanders = 0.1;
constexpr double kPacePeriod_s = 50.0;
constexpr double kPuffless_m_s = 8.0;

/// How fast a flame catches fire.
constexpr double kKindle_rad_s = 1.8;

/// The axis sways by this part of `flicker`, a lean.
constexpr double kWobblePerFlicker = 0.2;

/// A point is moved inward by at most this part of its distance from the axis.
constexpr float kInward = 0.9F;

constexpr std::array<std::string_view, 2> kFlameForms = {"texture", "shape"};

using namespace std::string_literals;

/// kFlameFields defines each.
struct FlameSettings {
  bool is_panel;
  std::size_t columns;
  std::size_t rows;
  double height_m;
  double width_m;
  double foot_m;
  double rise_speed_m_s;
  double flicker;
  double puffing;
  double exposure;
  double beta;
};

const Fields<FlameSettings> kFlameFields = {
    {{"form",
      "",
      "shape"s,
      {},
      {},
      "texture: colors on an upright panel; shape: a body of three shells that the noise displaces",
      kFlameForms},
     &FlameSettings::is_panel,
     [](const std::string& form) { return form == "texture"; }},
    {{"columns", "", std::int64_t{126}, 9, 1000,
      "points across the panel; of a body, around its three shells together: more is smoother"},
     &FlameSettings::columns},
    {{"rows", "", std::int64_t{96}, 8, 1000, "points from the foot to the top: more shows finer tongues"},
     &FlameSettings::rows},
    {{"height", "m", 1.2, 0.05, 50, "of the flame in calm air; in a wind it is shorter"}, &FlameSettings::height_m},
    {{"width", "m", 0.5, 0.02, 20, "of its thickest part; a wider fire leans less, and puffs more slowly"},
     &FlameSettings::width_m},
    {{"foot", "m", 0.35, 0, 10, "how high over the ground its foot is: it burns in a bowl"}, &FlameSettings::foot_m},
    {{"rise_speed", "m/s", 2.5, 0.05, 20, "how fast its tongues rise, and how fast a gust moves up from its foot"},
     &FlameSettings::rise_speed_m_s},
    {{"flicker", "", 0.3, 0, 0.8,
      "how far the noise moves the shape, as a part of its radius, and lets it sway: 0 burns like a candle"},
     &FlameSettings::flicker},
    {{"puffing", "", 0.13, 0, 0.4,
      "how much brighter and darker the whole flame gets twice a second as it breathes: its standard deviation, "
      "as a part of its light"},
     &FlameSettings::puffing},
    {{"exposure", "", 1.0, 0, 3,
      "how much of the wind reaches it: 1 lets it lean as a fire in the open does, less stands as if behind a "
      "screen, 0 never leans"},
     &FlameSettings::exposure},
    {{"beta", "", 3.0, 1, 6, "exponent of the noise's spectrum, 1/f^beta: less is rougher"}, &FlameSettings::beta},
};

constexpr std::array kRetiredFlameParameters = {
    RetiredParameter{"max_lean",
                     "is now exposure: at 1 the flame leans as real fires of its size do, below 1 it leans less"},
    RetiredParameter{"half_speed", "is now exposure: how much of the wind reaches it"},
};

/// The points' coordinates along the tiles: two noises at right angles to each other through a body, both across a
/// panel.
struct FlamePlaces {
  std::vector<float> first_m, second_m;
};
FlamePlaces places_on_tiles(const FlameBody& body, double across) {
  FlamePlaces places{body.east_m, body.is_panel ? body.east_m : body.south_m};
  for (auto* all_m : {&places.first_m, &places.second_m}) {
    for (float& at_m : *all_m) at_m = static_cast<float>(across * static_cast<double>(at_m));
  }
  return places;
}

std::array<NoiseLayerSpec, 2> flame_layers(const FlameSettings& settings, std::uint64_t seed) {
  const double period_m = settings.rise_speed_m_s * kCrossed_s;
  const auto layer = [&](std::uint64_t which, double longer, float weight) {
    return NoiseLayerSpec{
        .noise = {.size = kNoiseSamples, .beta = settings.beta, .seed = seed ^ which, .from_cycles = kMinWaves},
        .period_x_m = longer * period_m,
        .period_z_m = longer * period_m,
        .weight = weight,
        .turn_cos = noise::LineCut::kEast,
        .turn_sin = noise::LineCut::kSouth};
  };
  return {layer(math::stream_id("flame"), 1.0, 0.8F), layer(math::stream_id("flame tongues"), kSecondFaster, 0.6F)};
}

LayeredNoise flame_noise(const FlameBody& body, const FlameSettings& settings, double across, std::uint64_t seed) {
  const FlamePlaces places = places_on_tiles(body, across);
  std::array<NoiseLayerSpec, 2> layers = flame_layers(settings, seed);
  layers[1].x_m = places.second_m;
  return {layers, places.first_m, body.up_m};
}

/// A noise for the puffs' pace, with waves of one to twelve seconds and more, for it is read along a line.
noise::Tile2 pace_of_puffs(std::uint64_t seed) {
  noise::Tile2 pace = noise::make_noise_2d({.size = 128,
                                            .beta = 1.0,
                                            .seed = seed ^ math::stream_id("flame pace"),
                                            .from_cycles = 4.0,
                                            .to_cycles = 48.0})
                          .value();
  noise::scale_to_unit_reading(pace);
  return pace;
}

class Flame final : public Scene {
 public:
  Flame(const FlameSettings& settings, const Setup& setup)
      : Flame(make_flame_body({.is_panel = settings.is_panel,
                               .columns = settings.columns,
                               .rows = settings.rows,
                               .height_m = settings.height_m,
                               .width_m = settings.width_m,
                               .foot_m = settings.foot_m},
                              setup.placement),
              settings, setup) {}

  const pose::Skeleton& skeleton() const noexcept override { return skeleton_; }
  const pose::Pose& pose() const noexcept override { return pose_; }

  void shift(const wind::ground::Wind& wind, double dt_s) noexcept override {
    wind_.step(wind, dt_s);
    kindled_.step(1.0, kKindle_rad_s, dt_s);
    double east_m_s = exposure_ * wind_.east_m_s();
    double south_m_s = exposure_ * wind_.south_m_s();
    if (body_.is_panel) {  // it feels the wind along it
      const double along_m_s = east_m_s * body_.panel_east + south_m_s * body_.panel_south;
      east_m_s = along_m_s;
      south_m_s = 0.0;
    }
    axis_.step(east_m_s, south_m_s, dt_s);

    noise_.shift(0, 0.0, rise_m_s_ * dt_s);
    noise_.shift(1, 0.0, kSecondFaster * rise_m_s_ * dt_s);
    pace_at_.add(dt_s, kPacePeriod_s);
    puffed_ += puff_hz_ * (1.0 + kPaceWanders * static_cast<double>(noise::read_noise(pace_, pace_at_.phase()))) * dt_s;
    puffed_ -= std::floor(puffed_);
    const double calmer = std::sqrt(east_m_s * east_m_s + south_m_s * south_m_s) / kPuffless_m_s;
    puff_ = kPuff * puffing_ / std::sqrt(1.0 + calmer * calmer);
  }

  void sample() noexcept override {
    pose::SurfacePose& pose = *std::get_if<pose::SurfacePose>(&pose_);
    if (body_.is_panel) {
      axis_.write({bent_m_, unseen_, drop_m_, unseen_, unseen_});
      show_on_panel();
    } else {
      axis_.write({pose.row_east_m, pose.row_south_m, pose.row_drop_m, pose.row_slope_east, pose.row_slope_south});
      show_on_shells();
    }
    noise_.sample(row_, values_);

    // As the flame kindles the thresholds come down from a level at which nothing shows.
    const double unlit = (1.0 - kindled_.value) * (noise_.highest() - kFootThreshold + kHotter.back() + puff_);
    operators::ThresholdRampJob{.noise = values_,
                                .along = along_,
                                .first_threshold = static_cast<float>(kFootThreshold + unlit),
                                .last_threshold = static_cast<float>(kTopThreshold + unlit),
                                .edge = static_cast<float>(kEdge),
                                .row = row_,
                                .level = pose.heat}
        .run();
  }

  void project(double /*dt_s*/) noexcept override {
    if (body_.is_panel) return;  // its pose consists of colors alone

    // The shape's points move along their normals, by the noise.
    std::vector<float>& displacement_m = std::get_if<pose::SurfacePose>(&pose_)->displacement_m;
    operators::DisplacementJob{.noise = values_,
                               .share = body_.moved_m,
                               .amplitude_m = kindled_.value * flicker_,
                               .row = row_,
                               .displacement_m = displacement_m}
        .run();
    for (std::size_t i = 0; i < displacement_m.size(); ++i) {
      displacement_m[i] = std::max(displacement_m[i], -kInward * body_.radius_m[i]);
    }
  }

  /// The panel's points do not move at all. The body's move by no more than kindled flicker radius noise, cut inward,
  /// which makes no step larger, plus the movement of their row; up and down also by its slope, times their distance
  /// from the axis. In a tick `kindled` changes by at most w dt / e, the noise by the rise.
  double largest_joint_step_m(double dt_s) const noexcept override {
    if (body_.is_panel) return 0.0;
    const double kindled_step = std::min(kKindle_rad_s * dt_s / std::numbers::e, 1.0);
    const double largest_noise = std::max(noise_.highest(), -noise_.lowest());
    const double noise_step = noise_.largest_change(0, 0.0, rise_m_s_ * dt_s) +
                              noise_.largest_change(1, 0.0, kSecondFaster * rise_m_s_ * dt_s);
    const double step_m = flicker_ * body_.largest_radius_m * (noise_step + kindled_step * largest_noise);
    const double farthest_m = body_.largest_radius_m * (1.0 + flicker_ * largest_noise);
    return step_m * (1.0 + axis_.largest_slope()) + farthest_m * axis_.largest_slope_step(dt_s) +
           axis_.largest_step_m(dt_s);
  }

  void list_state(StatePass& pass) override {
    pass(wind_, kindled_, axis_, noise_, pace_at_);
    pass.within(puffed_, 0.0, 1.0);
  }

 private:
  Flame(FlameBody body, const FlameSettings& settings, const Setup& setup)
      : row_(setup.row),
        rise_m_s_(settings.rise_speed_m_s),
        height_m_(settings.height_m),
        width_m_(settings.width_m),
        flicker_(settings.flicker),
        puffing_(settings.puffing),
        exposure_(settings.exposure),
        puff_hz_(kPuff_hz_sqrt_m / std::sqrt(settings.width_m)),
        across_(kWidthOfTile * kCrossed_s * settings.rise_speed_m_s / settings.width_m),
        wind_(setup.placement, setup.gusts),
        axis_({.rows = body.surface.rows,
               .height_m = settings.height_m * static_cast<double>(body.along.back()),
               .felt_at_m = settings.height_m / 2.0,  // the bowl's rim shelters it: as if it stood on the ground
               .foot_m = settings.width_m,
               .rise_m_s = settings.rise_speed_m_s,
               .wobble = kWobblePerFlicker * settings.flicker,
               .strongest_m_s = kStrongestSceneWind_m_s * settings.exposure,
               .seed = setup.seed}),
        noise_(flame_noise(body, settings, across_, setup.seed)),
        pace_(pace_of_puffs(setup.seed)),
        values_(body.east_m.size(), 0.0F),
        along_(body.east_m.size(), 0.0F),
        bent_m_(body.is_panel ? body.surface.rows : 0),
        drop_m_(bent_m_.size()),
        unseen_(bent_m_.size()),
        skeleton_(std::move(body.surface)),
        pose_(pose::rest_pose(skeleton_)),
        body_(std::move(body)) {}

  /// The position along the rising threshold of a part of the flame at `v` of the way from its foot to its top. The
  /// foot of a puff's wave leaves the flame's foot when its top reaches the next one's.
  double along_at(double v, double hotter) const noexcept {
    double wave = puffed_ - v * height_m_ * puff_hz_ / rise_m_s_;
    wave -= std::floor(wave);
    const auto sine = static_cast<double>(math::sin_cos(static_cast<float>(2.0 * kPi * wave)).sin);
    const double grown = std::min(v / kPuffGrown, 1.0);
    return v * v * v - (puff_ * grown * sine + hotter * std::max(1.0 - v, 0.0)) / (kTopThreshold - kFootThreshold);
  }

  /// The position of each point of the body along the rising threshold.
  void show_on_shells() noexcept {
    const auto& surface = *std::get_if<pose::SurfaceSkeleton>(&skeleton_);
    const std::size_t around = surface.columns / surface.shells;
    float* along = along_.data();
    for (std::size_t row = 0; row < surface.rows; ++row) {
      for (std::size_t shell = 0; shell < surface.shells; ++shell, along += around) {
        std::fill(along, along + around,
                  static_cast<float>(along_at(static_cast<double>(body_.along[row]), kHotter[shell])));
      }
    }
  }

  /// The same for the panel: at each height it shows the part of the bent flame at that height.
  void show_on_panel() noexcept {
    const auto& surface = *std::get_if<pose::SurfaceSkeleton>(&skeleton_);
    const auto up_m = [this](std::size_t row) { return static_cast<double>(body_.along[row]) * height_m_; };
    const auto high_m = [&](std::size_t row) { return up_m(row) - static_cast<double>(drop_m_[row]); };
    std::size_t part = 0;  // of the axis: the last part whose end is not higher
    for (std::size_t row = 0; row < surface.rows; ++row) {
      while (part + 2 < surface.rows && high_m(part + 1) <= up_m(row)) ++part;
      const double link_m = std::max(high_m(part + 1) - high_m(part), 1e-6);
      const double fraction = std::max((up_m(row) - high_m(part)) / link_m, 0.0);
      const double within = std::min(fraction, 1.0);
      const double v = static_cast<double>(body_.along[part]) +
                       fraction * static_cast<double>(body_.along[part + 1] - body_.along[part]);
      const double way_m =
          static_cast<double>(bent_m_[part]) + within * static_cast<double>(bent_m_[part + 1] - bent_m_[part]);
      const std::size_t first = row * surface.columns;
      noise_.lean(first, surface.columns, -across_ * way_m);
      const auto middle = static_cast<float>(along_at(v, kHotterPanel));
      // Cut level, a flame that leans is wider.
      const auto goes_m = static_cast<double>(bent_m_[part + 1] - bent_m_[part]);
      const double wider = std::sqrt(std::sqrt(1.0 + goes_m * goes_m / (link_m * link_m)));
      const auto per_half_width = static_cast<float>(1.6 / (wider * width_m_ * (1.0 - 0.5 * std::min(v, 1.0))));
      for (std::size_t i = first; i < first + surface.columns; ++i) {
        const float side = (body_.east_m[i] - static_cast<float>(way_m)) * per_half_width;
        along_[i] = middle + side * side;
      }
    }
  }

  SimdRow row_;
  double rise_m_s_;
  double height_m_;
  double width_m_;
  double flicker_;
  double puffing_;
  double exposure_;
  double puff_hz_;
  double across_;  ///< metres of a tile per metre across the flame

  Wind wind_;
  math::CriticallyDamped kindled_;  ///< 0 unlit, 1 burning
  FlameAxis axis_;
  LayeredNoise noise_;
  noise::Tile2 pace_;
  noise::LineCut pace_at_;
  double puffed_ = 0.0;                          ///< puffs, without their whole number
  double puff_ = 0.0;                            ///< the maximum reduction of the threshold by one
  std::vector<float> values_, along_;            ///< a point each
  std::vector<float> bent_m_, drop_m_, unseen_;  ///< of the panel's flame, one per row
  pose::Skeleton skeleton_;
  pose::Pose pose_;
  FlameBody body_;  ///< without its surface, which is in skeleton_
};

}  // namespace

extern const Description kFlameScene;
const Description kFlameScene = {
    .name = "flame",
    .summary = "a flame: tongues of noise rise, it breathes, and the wind lays it over",
    .parameters = kFlameFields.parameters(),
    .make =
        [](const ParameterValues& values, const Setup& setup) {
          return std::unique_ptr<Scene>(std::make_unique<Flame>(kFlameFields.of(values), setup));
        },
    .is_still_in_calm = false,
    .retired = kRetiredFlameParameters};

}  // namespace yuragi::scenes
