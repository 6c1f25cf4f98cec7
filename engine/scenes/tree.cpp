#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/operators/flutter_job.hpp"
#include "engine/operators/oscillator_job.hpp"
#include "engine/operators/split_job.hpp"
#include "engine/operators/tilt_job.hpp"
#include "engine/operators/wind_response.hpp"
#include "engine/operators/wind_side_job.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/scenes/carried_noise.hpp"
#include "engine/scenes/placement.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"
#include "engine/scenes/tree_model.hpp"
#include "engine/scenes/tree_species.hpp"
#include "engine/scenes/wind_grid.hpp"

// A tree in the wind, after N. Chiba, "Development of core technology for a noise-based real-time animation engine for
// fluctuation phenomena" (Iwate University), section 3.3 and figures 12 and 13:
//
//   shift    the wind carries the noise on the ground, and a finer one through the leaves            CarriedNoise
//   sample   each branch reads the one, each leaf the other                                          CarriedNoise
//            how far each branch is from the windward side                                           WindSideJob
//            what is above a threshold that rises from there moves it up and down, the rest sideways SplitJob
//   project  the two tilt the branch: theta and phi                                                  TiltJob
//            and it overshoots and sways on, a damped oscillator                                     OscillatorJob
//            a leaf leans and flutters as its petiole lets it                                        FlutterJob

namespace yuragi {
namespace {

constexpr std::array<std::string_view, 2> kTreeBetaMeanings = {"transect", "radial"};

using namespace std::string_literals;

const std::array kTreeParameters = {
    Parameter{"species", "", "cherry"s, {}, {}, "how it grows, and how stiff wood and petioles are", kTreeSpeciesNames},
    Parameter{"size", "", 1.0, 0.1, 10, "all lengths, against the species' own (8, 11 and 15 m high)"},
    Parameter{"limbs", "", std::int64_t{15}, 1, 500, "branches on the trunk"},
    Parameter{"twigs", "", std::int64_t{240}, 1, 20000, "branches on the limbs"},
    Parameter{"leaves", "", std::int64_t{10000}, 1, 1000000, "leaves on the twigs, in sprays of 16"},
    Parameter{"branch_links", "", std::int64_t{256}, 1, 256, "links of the trunk and of each branch"},
    Parameter{"leaf_links", "", std::int64_t{4}, 1, 64, "links of a leaf"},
    Parameter{"max_tilt", "deg", 45.0, 0, 120, "how far the strongest wind bends the thinnest twig"},
    Parameter{"max_swing", "deg", 45.0, 0, 120, "and how far sideways"},
    Parameter{"half_tilt_speed", "m/s", 10.0, 0.1, 60, "the wind that wood answers half to"},
    Parameter{"turbulence", "", 0.5, 0, 2,
              "how much branches answer to its gusts: in a wind of turbulence intensity 0.2, the standard deviation"},
    Parameter{"hybrid", "", 0.7, 0, 1, "0: wood follows the noise alone; 1: each branch is a damped oscillator"},
    Parameter{"natural_frequency", "Hz", 0.5, 0.05, 5,
              "how fast the trunk sways by itself; limbs twice, twigs 4 times"},
    Parameter{"damping", "", 0.15, 0.02, 0.95, "how soon that dies away: the damping ratio"},
    Parameter{"tile_period", "m", 64.0, 4, 4096, "after how many metres the wind on the ground repeats; 128 samples"},
    Parameter{"tiles", "", std::int64_t{2}, 1, 2, "2: a second tile hides the repeat; 1: the paper's letter"},
    Parameter{"beta", "", 5.0 / 3.0, kMinTransectBeta2, 4,
              "exponent of the wind's spectrum, 1/f^beta; 5/3 is Simiu's wind"},
    Parameter{"beta_meaning",
              "",
              "transect"s,
              {},
              {},
              "transect: of a line through the field, true to the wind; radial: of each mode, the paper's letter",
              kTreeBetaMeanings},
    Parameter{"leaf_lean", "deg", 25.0, 0, 120, "how far the strongest wind turns the softest leaf, on average"},
    Parameter{"leaf_flutter", "deg", 18.0, 0, 60, "and how much to and fro: the standard deviation"},
    Parameter{"half_flutter_speed", "m/s", 4.0, 0.1, 60, "the wind that leaves answer half to"},
};

/// The paper's dist_to_wind_side, in radii of the tree, is never below this.
constexpr double kWindSideFloor = 0.4;

/// A wind much below this has no windward side.
constexpr double kSidelessWind_m_s = 1.0;

// The threshold of the split, in standard deviations of the noise: it rises from -1.5 at the windward side to 1.5 at
// the lee side, and the step there is one wide.
constexpr double kThresholdRise = 3.0 / (2.0 - kWindSideFloor);
constexpr double kThreshold = -1.5 - kThresholdRise * kWindSideFloor;
constexpr double kSplitWidth = 1.0;

/// Beyond it the noise is cut, in standard deviations.
constexpr double kLargestNoise = 3.0;

/// Gusts that differ within less than this move a crown as one.
constexpr double kCrownCell_m = 1.0;

// The noise that leaves read. It goes with the wind, but never as fast as 2.6 m/s, up to which 60 ticks a second show
// its finest waves, of 18 cm (14 a second), and one layer of it is read. Its period is that of a crown, and it is
// small: read ten thousand times a tick, it stays in the fastest cache.
constexpr CarriedNoiseSpec kLeafNoise = {.period_m = 8.0, .samples = 64, .beta = 1.0, .has_two_tiles = false};
constexpr double kLargestLeafNoiseSpeed_m_s = 2.6;

/// How much further along x and z leaves read for each metre that they are up: those one above the other differ too.
constexpr std::array<double, 2> kHeightSkew = {0.5, 0.7};

constexpr double kLargestTwist_rad = 40.0 * kRadPerDeg;

const TreeSpecies& species_of(const ParameterValues& values) {
  return tree_species(values.text("species"));
}

TreeSkeleton placed_tree(const ParameterValues& values, const SceneSetup& setup) {
  const auto count = [&values](std::string_view name) { return static_cast<std::size_t>(values.integer(name)); };
  TreeSkeleton tree = make_tree({.habit = species_of(values).habit,
                                 .limbs = count("limbs"),
                                 .twigs = count("twigs"),
                                 .leaves = count("leaves"),
                                 .branch_links = count("branch_links"),
                                 .leaf_links = count("leaf_links"),
                                 .size = values.number("size"),
                                 .seed = setup.seed});
  place(setup.placement, tree);
  return tree;
}

CarriedNoiseSpec tree_wind_noise(const ParameterValues& values, std::uint64_t seed) {
  return {.period_m = values.number("tile_period"),
          .samples = 128,
          .beta = values.number("beta"),
          .meaning = values.text("beta_meaning") == "radial" ? BetaMeaning::kRadial : BetaMeaning::kTransect,
          .has_two_tiles = values.integer("tiles") == 2,
          .seed = seed ^ stream_id("tree wind on the ground")};
}

CarriedNoiseSpec leaf_noise(std::uint64_t seed) {
  CarriedNoiseSpec spec = kLeafNoise;
  spec.seed = seed ^ stream_id("tree wind in the leaves");
  return spec;
}

/// One generation of wood: where its branches stand, and what they read.
struct Wood {
  std::size_t level = 0;
  double natural_hz = 1.0;
  CarriedPlaces places;               ///< of the middle of each branch
  std::size_t first_on_grid = 0;      ///< the same on the grid of the wind outside
  std::vector<float> side_x, side_z;  ///< the same from the tree's middle, in its radii
  std::vector<float> gain;
  double largest_gain = 0.0;

  std::vector<float> distance, noise, vertical, horizontal;
  Oscillators oscillators;
};

/// The leaves, and how each gives way along the wind and across it.
struct Foliage {
  CarriedPlaces places;
  std::vector<float> along, across;
  double largest_compliance = 0.0;

  std::vector<float> noise;
};

/// Where the middle of a strand is on the ground, at rest: x, z.
std::array<float, 2> middle_of(const StrandSkeleton& strands, std::size_t strand) {
  const auto number = [strand](const std::vector<float>& array) { return static_cast<double>(array[strand]); };
  double x_m = number(strands.root_x_m);
  double z_m = number(strands.root_z_m);
  for (std::size_t link = 0; link < (strands.links_per_strand + 1) / 2; ++link) {
    const double curled_rad = static_cast<double>(link) * number(strands.rest_curl_rad);
    const double along_m = number(strands.link_length_m) * std::cos(curled_rad);
    const double across_m = number(strands.link_length_m) * std::sin(curled_rad);
    x_m += along_m * number(strands.rest_x) + across_m * number(strands.curl_x);
    z_m += along_m * number(strands.rest_z) + across_m * number(strands.curl_z);
  }
  return {static_cast<float>(x_m), static_cast<float>(z_m)};
}

class Tree final : public Scene {
 public:
  Tree(const ParameterValues& values, const SceneSetup& setup) : Tree(placed_tree(values, setup), values, setup) {}

  const Skeleton& skeleton() const noexcept override { return skeleton_; }
  const Pose& pose() const noexcept override { return pose_; }

  void shift(const GroundWind& wind, double dt_s) noexcept override {
    // The wind carries both noises on.
    wind_.step(wind, dt_s);
    leaf_wind_.step(wind, dt_s);
    if (outside_) {
      outside_->step(wind, dt_s);
    } else {
      noise_.shift(wind_.east_m_s(), wind_.south_m_s(), dt_s);
    }
    const double slowed = kLargestLeafNoiseSpeed_m_s / (kLargestLeafNoiseSpeed_m_s + wind_.speed_m_s());
    leaf_noise_.shift(slowed * wind_.east_m_s(), slowed * wind_.south_m_s(), dt_s);
  }

  void sample() noexcept override {
    for (Wood& wood : wood_) sample_wood(wood);
    const auto largest = static_cast<float>(kLargestNoise);
    leaf_noise_.sample(leaves_.places, row_, leaves_.noise, 1.0F, 0.0F, -largest, largest);
  }

  void project(double dt_s) noexcept override {
    auto& levels = std::get_if<TreePose>(&pose_)->levels;
    for (Wood& wood : wood_) project_wood(wood, dt_s, levels[wood.level]);
    FlutterJob{.wind_east_m_s = leaf_wind_.east_m_s(),
               .wind_south_m_s = leaf_wind_.south_m_s(),
               .noise = leaves_.noise,
               .along = leaves_.along,
               .across = leaves_.across,
               .half_flutter_speed_m_s = half_flutter_speed_m_s_,
               .lean_rad = leaf_lean_rad_,
               .flutter_rad = leaf_flutter_rad_,
               .row = row_,
               .bend_east_rad = levels[kLeaves].bend_east_rad,
               .bend_south_rad = levels[kLeaves].bend_south_rad}
        .run();
  }

  /// The bends' largest changes, times the levers that they have (tree_levers_m).
  double largest_joint_step_m(double dt_s) const noexcept override {
    double step_m = levers_m_[kLeaves] * largest_leaf_step_rad(dt_s);
    for (const Wood& wood : wood_) step_m += levers_m_[wood.level] * largest_wood_step_rad(wood, dt_s);
    return step_m;
  }

 private:
  Tree(TreeSkeleton tree, const ParameterValues& values, const SceneSetup& setup);

  /// Where branches are on the ground, x and z.
  using Places = std::array<std::vector<float>, 2>;

  void add_wood(const TreeSkeleton& tree, std::size_t level, double thinnest_m, const ScenePlacement& placement,
                Places& all_m);
  void add_leaves(const TreeLevel& level, std::uint64_t seed);
  void sample_wood(Wood& wood) noexcept;
  void project_wood(Wood& wood, double dt_s, StrandPose& pose) noexcept;
  double largest_wood_step_rad(const Wood& wood, double dt_s) const noexcept;
  double largest_leaf_step_rad(double dt_s) const noexcept;

  SimdRow row_;
  const TreeSpecies& species_;
  double max_tilt_rad_, max_swing_rad_, half_tilt_speed_m_s_;
  double turbulence_;
  double hybrid_, natural_hz_, damping_ratio_;
  double leaf_lean_rad_, leaf_flutter_rad_, half_flutter_speed_m_s_;

  SceneWind wind_;       ///< without the gusts, which differ from branch to branch
  SceneWind leaf_wind_;  ///< in the tree's middle
  CarriedNoise noise_, leaf_noise_;
  std::optional<WindGrid> outside_;  ///< the wind at each branch, where it brings its gusts; noise_ is not read then
  std::array<Wood, kLeaves> wood_;
  Foliage leaves_;
  std::array<double, kMaxTreeLevels> levers_m_;
  Skeleton skeleton_;
  Pose pose_;
};

Tree::Tree(TreeSkeleton tree, const ParameterValues& values, const SceneSetup& setup)
    : row_(setup.row),
      species_(species_of(values)),
      max_tilt_rad_(values.number("max_tilt") * kRadPerDeg),
      max_swing_rad_(values.number("max_swing") * kRadPerDeg),
      half_tilt_speed_m_s_(values.number("half_tilt_speed")),
      turbulence_(values.number("turbulence")),
      hybrid_(values.number("hybrid")),
      natural_hz_(values.number("natural_frequency")),
      damping_ratio_(values.number("damping")),
      leaf_lean_rad_(values.number("leaf_lean") * kRadPerDeg),
      leaf_flutter_rad_(values.number("leaf_flutter") * kRadPerDeg),
      half_flutter_speed_m_s_(values.number("half_flutter_speed")),
      wind_(setup.placement, nullptr, setup.gusts ? WindPart::kMean : WindPart::kAll),
      leaf_wind_(setup.placement, setup.gusts),
      noise_(tree_wind_noise(values, setup.seed)),
      leaf_noise_(leaf_noise(setup.seed)),
      levers_m_(tree_levers_m(tree)) {
  // The thinnest wood has gain 1.
  const TreeLevel& twigs = tree.levels[kTwigs];
  const auto last_twig = twigs.base_radius_m.begin() + static_cast<std::ptrdiff_t>(twigs.strands.strand_count);
  const float thinnest_m = *std::min_element(twigs.base_radius_m.begin(), last_twig);
  Places places_m;
  for (std::size_t level = 0; level < kLeaves; ++level) {
    add_wood(tree, level, static_cast<double>(thinnest_m), setup.placement, places_m);
  }
  if (setup.gusts) outside_.emplace(setup.gusts, places_m[0], places_m[1], setup.row, kCrownCell_m);

  // Places from the tree's middle, in its radii.
  float radius_m = 1e-3F;
  for (const Wood& wood : wood_) {
    for (std::size_t i = 0; i < tree.levels[wood.level].strands.strand_count; ++i) {
      radius_m = std::max(radius_m, std::hypot(wood.side_x[i], wood.side_z[i]));
    }
  }
  for (Wood& wood : wood_) {
    for (auto* side : {&wood.side_x, &wood.side_z}) {
      for (float& place : *side) place /= radius_m;
    }
  }

  add_leaves(tree.levels[kLeaves], setup.seed);
  skeleton_ = std::move(tree);
  pose_ = rest_pose(skeleton_);
}

void Tree::add_wood(const TreeSkeleton& tree, std::size_t level, double thinnest_m, const ScenePlacement& placement,
                    Places& all_m) {
  const StrandSkeleton& strands = tree.levels[level].strands;
  const std::size_t count = strands.padded_count();
  Wood& wood = wood_[level];
  wood.level = level;
  wood.natural_hz = natural_hz_ * static_cast<double>(1U << level);

  std::vector<float> x_m;
  std::vector<float> z_m;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [middle_x_m, middle_z_m] = middle_of(strands, i);
    x_m.push_back(middle_x_m);
    z_m.push_back(middle_z_m);
    const bool is_there = i < strands.strand_count;
    wood.side_x.push_back(is_there ? static_cast<float>(static_cast<double>(middle_x_m) - placement.x_m) : 0.0F);
    wood.side_z.push_back(is_there ? static_cast<float>(static_cast<double>(middle_z_m) - placement.z_m) : 0.0F);

    const double thickness = static_cast<double>(tree.levels[level].base_radius_m[i]) / thinnest_m;
    const double gain = is_there ? std::pow(std::max(thickness, 1.0), -species_.thinness_power) : 0.0;
    wood.gain.push_back(static_cast<float>(gain));
    wood.largest_gain = std::max(wood.largest_gain, gain);
  }
  wood.places = noise_.places(x_m, z_m);
  wood.first_on_grid = all_m[0].size();
  all_m[0].insert(all_m[0].end(), x_m.begin(), x_m.end());
  all_m[1].insert(all_m[1].end(), z_m.begin(), z_m.end());
  for (auto* array : {&wood.distance, &wood.noise, &wood.vertical, &wood.horizontal}) array->assign(count, 0.0F);
  wood.oscillators = Oscillators(count);
}

void Tree::add_leaves(const TreeLevel& level, std::uint64_t seed) {
  const RandomStream random(seed, stream_id("tree petioles"));
  const StrandSkeleton& strands = level.strands;
  std::vector<float> x_m;
  std::vector<float> z_m;
  for (std::size_t i = 0; i < strands.padded_count(); ++i) {
    const auto y_m = static_cast<double>(strands.root_y_m[i]);
    x_m.push_back(static_cast<float>(static_cast<double>(strands.root_x_m[i]) + kHeightSkew[0] * y_m));
    z_m.push_back(static_cast<float>(static_cast<double>(strands.root_z_m[i]) + kHeightSkew[1] * y_m));
    const double compliance = species_.petiole * (0.7 + 0.6 * random.uniform(2 * i));
    const double twist_rad = kLargestTwist_rad * (2.0 * random.uniform(2 * i + 1) - 1.0);
    leaves_.along.push_back(static_cast<float>(compliance * std::cos(twist_rad)));
    leaves_.across.push_back(static_cast<float>(compliance * std::sin(twist_rad)));
    leaves_.largest_compliance = std::max(leaves_.largest_compliance, compliance);
  }
  leaves_.places = leaf_noise_.places(x_m, z_m);
  leaves_.noise.assign(strands.padded_count(), 0.0F);
}

void Tree::sample_wood(Wood& wood) noexcept {
  WindSideJob{.wind_east_m_s = wind_.east_m_s(),
              .wind_south_m_s = wind_.south_m_s(),
              .calm_m_s = kSidelessWind_m_s,
              .floor = kWindSideFloor,
              .place_x = wood.side_x,
              .place_z = wood.side_z,
              .distance = wood.distance}
      .run();

  const auto largest = static_cast<float>(kLargestNoise * turbulence_);
  if (outside_) {
    outside_->sample_gusts(wood.first_on_grid, wood.noise, static_cast<float>(kLargestNoise));
    for (float& noise : wood.noise) noise *= static_cast<float>(turbulence_);
  } else {
    noise_.sample(wood.places, row_, wood.noise, static_cast<float>(turbulence_), 0.0F, -largest, largest);
  }
  SplitJob{.noise = wood.noise,
           .ramp = wood.distance,
           .threshold = kThreshold * turbulence_,
           .threshold_rise = kThresholdRise * turbulence_,
           .width = std::max(kSplitWidth * turbulence_, 1e-6),
           .row = row_,
           .above = wood.vertical,
           .below = wood.horizontal}
      .run();
}

void Tree::project_wood(Wood& wood, double dt_s, StrandPose& pose) noexcept {
  TiltJob{.wind_east_m_s = wind_.east_m_s(),
          .wind_south_m_s = wind_.south_m_s(),
          .vertical = wood.vertical,
          .horizontal = wood.horizontal,
          .distance = wood.distance,
          .gain = wood.gain,
          .half_tilt_speed_m_s = half_tilt_speed_m_s_,
          .alpha_vertical = species_.alpha_vertical,
          .beta_horizontal = species_.beta_horizontal,
          .max_tilt_rad = max_tilt_rad_,
          .max_swing_rad = max_swing_rad_,
          .row = row_,
          .bend_east_rad = pose.bend_east_rad,
          .bend_south_rad = pose.bend_south_rad}
      .run();
  OscillatorJob{.step = OscillatorStep::exact(wood.natural_hz, damping_ratio_, dt_s),
                .blend = hybrid_,
                .row = row_,
                .oscillators = &wood.oscillators,
                .east = pose.bend_east_rad,
                .south = pose.bend_south_rad}
      .run();
}

// How far the bend of a branch may change in a tick. Along the wind it is max_tilt x / sqrt(1 + x^2), x = gain W
// (N_vertical + alpha) / dist, at most k where W is 1; nowhere steeper than max_tilt over x:
//
//   wind      s changes by ds. As a vector along the wind the bend is nowhere steeper over s than 1.02 sqrt(k) max_tilt
//             (x = k s^2/(1 + s^2); that slope is at most 2 sqrt(k x) / (1 + x^2)^1.5), nor than 0.65 k max_tilt
//   noise     each part of the split changes by no more than noise and threshold together
//   distance  the unit vector of WindSideJob changes by at most dU / U, W / U is at most 1 / (2 half_tilt_speed), and
//             a place is within 1 of the middle: ds / 2 in all, times the threshold's rise and the slope of 1 / dist
//
// and by no more than from one extreme G to the other, 2 G. Across the wind it is the same with its own numbers. An
// oscillator moves by at most its largest gain times that, and by at most what its largest rate gives for a bend that
// never exceeds G.
double Tree::largest_wood_step_rad(const Wood& wood, double dt_s) const noexcept {
  const double ds = SceneWind::largest_step_m_s(dt_s) / half_tilt_speed_m_s_;
  const double largest_noise = kLargestNoise * turbulence_;
  const double dn =
      outside_ ? 2.0 * largest_noise
               : turbulence_ * noise_.largest_change(kStrongestSceneWind_m_s, SceneWind::largest_step_m_s(dt_s), dt_s);
  const double dd = 0.5 * ds;  // with W in it

  // The parts along the wind and across it: how far they may change, and how large they may be.
  double step_rad = 0.0;
  double largest_rad = 0.0;
  const auto add_part = [&](double constant, double max_rad) {
    const double over_distance = wood.largest_gain / kWindSideFloor;
    const double k = over_distance * (largest_noise + constant);
    const double part_rad = max_rad * k / std::sqrt(1.0 + k * k);
    const double from_wind = std::min(WindResponse::kSteepest * k, 1.02 * std::sqrt(k)) * ds;
    const double from_noise = over_distance * (dn + kThresholdRise * turbulence_ * dd);
    const double from_distance = k / kWindSideFloor * dd;
    step_rad += max_rad * (from_wind + from_noise + from_distance);
    largest_rad = std::hypot(largest_rad, part_rad);
  };
  add_part(species_.alpha_vertical, max_tilt_rad_);
  add_part(species_.beta_horizontal, max_swing_rad_);
  step_rad = std::min(step_rad, 2.0 * largest_rad);

  const double swayed_rad =
      std::min(OscillatorStep::largest_gain(damping_ratio_) * step_rad,
               OscillatorStep::largest_rate_per_s(wood.natural_hz, damping_ratio_) * dt_s * largest_rad);
  return (1.0 - hybrid_) * step_rad + hybrid_ * swayed_rad;
}

// compliance (lean + flutter noise) W as a vector: its slope over s is at most 0.65, over the noise flutter.
double Tree::largest_leaf_step_rad(double dt_s) const noexcept {
  const double ds = SceneWind::largest_step_m_s(dt_s) / half_flutter_speed_m_s_;
  const double largest = leaf_lean_rad_ + kLargestNoise * leaf_flutter_rad_;
  const double carried_step_m_s = std::min(SceneWind::largest_step_m_s(dt_s), 2.0 * kLargestLeafNoiseSpeed_m_s);
  const double dn = leaf_noise_.largest_change(kLargestLeafNoiseSpeed_m_s, carried_step_m_s, dt_s);
  const double step = std::min(largest * WindResponse::kSteepest * ds + leaf_flutter_rad_ * dn, 2.0 * largest);
  return leaves_.largest_compliance * step;
}

}  // namespace

extern const SceneDescription kTreeScene;
const SceneDescription kTreeScene = {.name = "tree",
                                     .summary = "a tree in the wind: branches sway, leaves flutter",
                                     .parameters = kTreeParameters,
                                     .make = [](const ParameterValues& values, const SceneSetup& setup) {
                                       return std::unique_ptr<Scene>(std::make_unique<Tree>(values, setup));
                                     }};

}  // namespace yuragi
