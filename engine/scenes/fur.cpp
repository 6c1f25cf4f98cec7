#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "engine/base/fields.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/math/portable.hpp"
#include "engine/operators/bend_share.hpp"
#include "engine/operators/coat_bending_job.hpp"
#include "engine/operators/oscillator_job.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/scenes/carried_noise.hpp"
#include "engine/scenes/coat.hpp"
#include "engine/scenes/placement.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"
#include "engine/scenes/strand_part.hpp"

// Fur in the wind, after N. Chiba, "Development of core technology for a noise-based real-time animation engine for
// fluctuation phenomena" (Iwate University), section 3.1: a coat on a curved body.
//
//   shift the wind carries a small noise through the coat, more slowly than it blows: strokes        CarriedNoise
//   sample   each hair reads it where it grows, twice, far apart: along the wind and across it          CarriedNoise
//   project  the wind along the skin lays the hair over, and the strokes open partings               CoatBendingJob
//            and it overshoots and sways on, a damped oscillator                                      OscillatorJob
//
// The gusts of the wind are longer than a body: all hairs have the wind at the scene's place.

namespace yuragi::scenes {
namespace {

/// The strokes' waves, the shortest and the longest; how many standard deviations they reach; and across the wind
/// against along it.
constexpr std::array kStrokeWaves_m = {0.24, 0.52};
constexpr double kMaxStroke = 2.2;
constexpr double kStrokeAcross = 0.5;

/// The offset of the second reading of the strokes: so large that it is an independent noise.
constexpr float kElsewhere_m = 1618.034F;

/// The reduction of the wind's effect on hairs on the side that faces away from it.
constexpr double kSheltered = 0.6;

const Fields<CoatSpec> kCoatFields = {
    {{"hairs_along", "", std::int64_t{200}, 1, 4096, "rows of hairs from one end of the body to the other"},
     &CoatSpec::hairs_along},
    {{"hairs_around", "", std::int64_t{150}, 1, 4096, "hairs in a row over the body, from the ground to the ground"},
     &CoatSpec::hairs_around},
    {{"links", "", std::int64_t{10}, 1, 64, "links of a hair"}, &CoatSpec::links},
    {{"body_length", "m", 3.0, 0.05, 20, "the body from end to end; it lies from west to east"},
     &CoatSpec::body_length_m},
    {{"body_height", "m", 0.75, 0.05, 20, "the body from the ground up: a back that rises out of the grass"},
     &CoatSpec::body_height_m},
    {{"body_width", "m", 2.0, 0.05, 20, "the body from flank to flank"}, &CoatSpec::body_width_m},
    {{"hair_length", "m", 0.09, 0.002, 1, "length of a hair, on average"}, &CoatSpec::length_m},
    {{"hair_length_variation", "", 0.2, 0, 0.5, "standard deviation of the length, as a part of it"},
     &CoatSpec::length_variation},
    {{"lie", "deg", 55.0, 0, 85, "how far a hair's foot lies over in calm air"}, &CoatSpec::lie_deg},
    {{"curl", "deg", 30.0, 0, 180, "how much farther it curls to its tip"}, &CoatSpec::curl_deg},
    {{"parting", "deg", 20.0, 0, 90, "standard deviation of the direction in which hairs lie"}, &CoatSpec::parting_deg},
};

/// How the hairs sway.
struct FurSway {
  double max_bend_rad, half_bend_speed_m_s, stroke_rad;
  double carry, fastest_stroke_m_s;
  double hybrid, natural_hz, damping_ratio;
};
const Fields<FurSway> kFurSwayFields = {
    {{"max_bend", "deg", 80.0, 0, 170, "how far the strongest wind lays a tip over"},
     &FurSway::max_bend_rad,
     radians_of},
    {{"half_bend_speed", "m/s", 5.5, 0.1, 60, "the wind along the skin that bends a tip half as far"},
     &FurSway::half_bend_speed_m_s},
    {{"strokes", "deg", 16.0, 0, 60,
      "how much a strong wind's strokes bend hairs besides: partings that open, run on and close"},
     &FurSway::stroke_rad,
     radians_of},
    {{"carry", "", 0.145, 0, 1, "strokes run over the coat with this part of the wind's speed"}, &FurSway::carry},
    {{"fastest_stroke", "m/s", 1.5, 0.01, 20, "and never faster than this, however strong the wind"},
     &FurSway::fastest_stroke_m_s},
    {{"hybrid", "", 1.0, 0, 1, "0: hairs follow the wind at once; 1: each is a damped oscillator that sways on"},
     &FurSway::hybrid},
    {{"natural_frequency", "Hz", 4.0, 0.1, 20, "frequency at which a hair sways by itself"}, &FurSway::natural_hz},
    {{"damping", "", 0.35, 0.02, 0.95, "how soon that sway ends: the damping ratio"}, &FurSway::damping_ratio},
};
const std::vector<Parameter> kFurParameters = together(kCoatFields.parameters(), kFurSwayFields.parameters());

const std::array kRetiredFurParameters = {
    RetiredParameter{"gusts",
                     "was removed: gusts are longer than a body, so all hairs have the gusts of the wind outside"},
    RetiredParameter{"turbulence", "is now strokes: by how many degrees hairs part"},
    RetiredParameter{"gust_strength", "is gone: the wind's own gusts swell enough"},
    RetiredParameter{"tile_period", "is gone: strokes are 0.24 to 0.52 m long"},
    RetiredParameter{"tiles", "is gone: strokes never repeat"},
    RetiredParameter{"beta", "is gone: strokes are a band of waves, 0.24 to 0.52 m long"},
    RetiredParameter{"beta_meaning", "is gone, like beta"},
};

Coat placed_coat(const ParameterValues& values, const Setup& setup) {
  CoatSpec spec = kCoatFields.of(values);
  spec.seed = setup.seed;
  Coat coat = make_coat(spec);
  place(setup.placement, coat.skeleton);
  turn(setup.placement, coat.normal_x, coat.normal_z);
  return coat;
}

class Fur final : public Scene {
 public:
  Fur(const ParameterValues& values, const Setup& setup)
      : Fur(placed_coat(values, setup), kFurSwayFields.of(values), setup) {}

  const pose::Skeleton& skeleton() const noexcept override { return skeleton_; }
  const pose::Pose& pose() const noexcept override { return pose_; }

  void shift(const wind::ground::Wind& wind, double dt_s) noexcept override {
    wind_.step(wind, dt_s);
    // Strokes move over the coat as it is unrolled: along the body, and around it.
    const double speed_m_s = wind_.speed_m_s();
    const double carry = speed_m_s > 0.0 ? std::min(sway_.carry, sway_.fastest_stroke_m_s / speed_m_s) : 0.0;
    const double east_m_s = carry * wind_.east_m_s();
    const double south_m_s = carry * wind_.south_m_s();
    strokes_.shift(heading_cos_ * east_m_s + heading_sin_ * south_m_s,
                   heading_cos_ * south_m_s - heading_sin_ * east_m_s, dt_s);
  }

  void sample() noexcept override { sample_part({}); }
  void project(double dt_s) noexcept override { project_part({}, dt_s); }

  void sample_part(Part part) noexcept override {
    const auto read = [&](const CarriedPlaces& places, std::vector<float>& all, double scale) {
      const std::span<float> out = strands_of(part, std::span(all));
      const auto largest = static_cast<float>(scale * kMaxStroke);
      strokes_.sample(places, row_, out, static_cast<float>(scale), 0.0F, -largest, largest,
                      static_cast<std::size_t>(out.data() - all.data()));
    };
    read(places_, along_, 1.0);
    read(elsewhere_, across_, kStrokeAcross);
  }

  void project_part(Part part, double dt_s) noexcept override {
    pose::StrandPose& pose = *std::get_if<pose::StrandPose>(&pose_);
    const std::span<float> bend_east_rad = strands_of(part, std::span(pose.bend_east_rad));
    const std::span<float> bend_south_rad = strands_of(part, std::span(pose.bend_south_rad));
    operators::CoatBendingJob{.wind_east_m_s = wind_.east_m_s(),
                              .wind_south_m_s = wind_.south_m_s(),
                              .normal_x = strands_of(part, std::span<const float>(normal_x_)),
                              .normal_z = strands_of(part, std::span<const float>(normal_z_)),
                              .stroke_along = strands_of(part, std::span<const float>(along_)),
                              .stroke_across = strands_of(part, std::span<const float>(across_)),
                              .flexibility = strands_of(part, std::span<const float>(flexibility_)),
                              .half_bend_speed_m_s = sway_.half_bend_speed_m_s,
                              .max_bend_rad = sway_.max_bend_rad,
                              .stroke_rad = sway_.stroke_rad,
                              .sheltered = kSheltered,
                              .row = row_,
                              .bend_east_rad = bend_east_rad,
                              .bend_south_rad = bend_south_rad}
        .run();
    operators::OscillatorJob{.step = operators::OscillatorStep::exact(sway_.natural_hz, sway_.damping_ratio, dt_s),
                             .blend = sway_.hybrid,
                             .row = row_,
                             .oscillators = &oscillators_,
                             .first = static_cast<std::size_t>(bend_east_rad.data() - pose.bend_east_rad.data()),
                             .east = bend_east_rad,
                             .south = bend_south_rad}
        .run();
  }

  /// With s the wind along the skin in half-bend speeds, the bend is s^2/(1+s^2) (max e + strokes) downwind. The slope
  /// of s^2/(1+s^2) in its direction over s, as a vector, is at most 3 sqrt(3)/8; the exposure e changes by at most
  /// `sheltered` times the turn of the wind, |du|/|u|, which s^2/(1+s^2) holds to half of `sheltered` over s; and
  /// strokes change by the change of their noise. A projection onto the skin changes by no more than the original. At
  /// most the whole range; an oscillator and the joints as in StrandSway.
  double largest_joint_step_m(double dt_s) const noexcept override {
    const double largest_stroke = math::length(1.0, kStrokeAcross) * kMaxStroke;
    const double largest_bend_rad = sway_.max_bend_rad + sway_.stroke_rad * largest_stroke;
    const double s = largest_flexibility_ / sway_.half_bend_speed_m_s * Wind::largest_step_m_s(dt_s);
    const double slope = operators::kSteepestBendShare * largest_bend_rad + 0.5 * kSheltered * sway_.max_bend_rad;
    const double stroke_step = math::length(1.0, kStrokeAcross) *
                               strokes_.largest_change(sway_.fastest_stroke_m_s, sway_.fastest_stroke_m_s, dt_s);
    const double bend_rad =
        std::min(slope * s + sway_.stroke_rad * std::min(stroke_step, 2.0 * largest_stroke), 2.0 * largest_bend_rad);
    const double swaying_rad = std::min(
        operators::OscillatorStep::largest_gain(sway_.damping_ratio) * bend_rad,
        operators::OscillatorStep::largest_rate_per_s(sway_.natural_hz, sway_.damping_ratio) * dt_s * largest_bend_rad);
    return lever_m_ * ((1.0 - sway_.hybrid) * bend_rad + sway_.hybrid * swaying_rad);
  }

  void list_state(StatePass& pass) override { pass(wind_, strokes_, oscillators_); }

 private:
  Fur(Coat coat, const FurSway& sway, const Setup& setup)
      : row_(setup.row),
        sway_(sway),
        heading_cos_(std::cos(setup.placement.heading_deg * kRadPerDeg)),
        heading_sin_(std::sin(setup.placement.heading_deg * kRadPerDeg)),
        wind_(setup.placement, setup.gusts),
        strokes_(CarriedNoise::band(kStrokeWaves_m[0], kStrokeWaves_m[1],
                                    setup.seed ^ math::stream_id("strokes over the coat"), false)),
        places_(strokes_.places(coat.place_x_m, coat.place_z_m)),
        elsewhere_(places_elsewhere(coat)),
        along_(coat.place_x_m.size(), 0.0F),
        across_(coat.place_x_m.size(), 0.0F),
        normal_x_(std::move(coat.normal_x)),
        normal_z_(std::move(coat.normal_z)),
        flexibility_(std::move(coat.flexibility)),
        oscillators_(flexibility_.size()),
        largest_flexibility_(static_cast<double>(*std::max_element(flexibility_.begin(), flexibility_.end()))),
        lever_m_(static_cast<double>(
                     *std::max_element(coat.skeleton.link_length_m.begin(), coat.skeleton.link_length_m.end())) *
                 (static_cast<double>(coat.skeleton.links_per_strand) + 1.0) / 2.0),
        skeleton_(std::move(coat.skeleton)),
        pose_(pose::rest_pose(skeleton_)) {}

  CarriedPlaces places_elsewhere(const Coat& coat) const {
    std::vector<float> x_m = coat.place_x_m;
    for (float& x : x_m) x += kElsewhere_m;
    return strokes_.places(x_m, coat.place_z_m);
  }

  SimdRow row_;
  FurSway sway_;
  double heading_cos_, heading_sin_;

  Wind wind_;
  CarriedNoise strokes_;
  CarriedPlaces places_, elsewhere_;   ///< of each hair on the coat
  std::vector<float> along_, across_;  ///< what it reads there
  std::vector<float> normal_x_, normal_z_;
  std::vector<float> flexibility_;
  operators::Oscillators oscillators_;
  double largest_flexibility_, lever_m_;
  pose::Skeleton skeleton_;
  pose::Pose pose_;
};

}  // namespace

extern const Description kFurScene;
const Description kFurScene = {
    .name = "fur",
    .summary = "a coat on a curved body: the wind parts it and strokes over it",
    .parameters = kFurParameters,
    .make = [](const ParameterValues& values,
               const Setup& setup) { return std::unique_ptr<Scene>(std::make_unique<Fur>(values, setup)); },
    .retired = kRetiredFurParameters};

}  // namespace yuragi::scenes
