#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/fields.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/math/portable.hpp"
#include "engine/operators/bend_share.hpp"
#include "engine/operators/branch_force_job.hpp"
#include "engine/operators/flutter_job.hpp"
#include "engine/operators/leaf_response_job.hpp"
#include "engine/operators/oscillator_job.hpp"
#include "engine/operators/split_job.hpp"
#include "engine/operators/tilt_job.hpp"
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
//   shift    the wind carries its gusts over the ground, more slowly a finer noise through the crown,
//            and the finest along the leaves                                                          CarriedNoise
//   sample the wind at each branch, and its force there, against the mean wind              BranchForceJob
//            how far each branch is from the windward side                                            WindSideJob
//            what is above a threshold that rises from there moves it up and down, the rest sideways  SplitJob
//            how leaves respond to the wind at each twig, and the noise that each leaf reads          LeafResponseJob
//   project  the two parts tilt the branch: theta and phi                                             TiltJob
//            which overshoots and sways on at a pace of its own, a damped oscillator                  OscillatorJob
//            a leaf leans and flutters as its petiole lets it                                         FlutterJob
//
// Sources of the figures: de Langre 2008, "Effects of wind on plants" (drag and
// streamlining); James, Haritos and Ades 2006, "Mechanical stability of trees under dynamic loads", and Jackson and
// others 2019, "An architectural understanding of natural sway frequencies in trees" (each branch has its own frequency
// and damping); Raupach, Finnigan and Brunet 1996, "Coherent eddies and turbulence in vegetation canopies" (the gusts
// that arise in the crown); Tadrist and others 2018, "Foliage motion under wind, from leaf flutter to branch
// buffeting".

namespace yuragi::scenes {
namespace {

using namespace std::string_literals;

/// kTreeFields defines each.
struct TreeSettings {
  const TreeSpecies* species;
  TreeSpec model;
  pose::FoliageColor foliage;
  std::size_t grove;
  double grove_radius_m;
  double flexibility, streamline_speed_m_s;
  double max_tilt_rad, max_swing_rad;
  double crown_gusts, turbulence;
  double hybrid, natural_hz, damping_ratio;
  CarriedNoiseSpec noise;
  double leaf_lean_rad, half_lean_speed_m_s, leaf_flutter_rad;

  bool is_bare() const noexcept { return foliage == pose::FoliageColor::kBare; }
};

auto of_model(auto member) {
  return member_of(&TreeSettings::model, member);
}
auto of_noise(auto member) {
  return member_of(&TreeSettings::noise, member);
}

const TreeSpecies* species_named(const std::string& name) {
  return &tree_species(name);
}
bool are_two(std::int64_t tiles) {
  return tiles == 2;
}

const Fields<TreeSettings> kTreeFields = {
    {{"species", "", "cherry"s, {}, {}, "how it grows, and how stiff wood and petioles are", kTreeSpeciesNames},
     &TreeSettings::species,
     species_named},
    {{"size", "", 1.0, 0.1, 10, "factor on all lengths of the species (cherry 8, zelkova 11, poplar 15 m high)"},
     of_model(&TreeSpec::size)},
    {{"limbs", "", std::int64_t{15}, 1, 500, "branches on the trunk"}, of_model(&TreeSpec::limbs)},
    {{"twigs", "", std::int64_t{240}, 1, 20000, "branches on the limbs"}, of_model(&TreeSpec::twigs)},
    {{"leaves", "", std::int64_t{10000}, 1, 1000000, "leaves on the twigs, in sprays of 16"},
     of_model(&TreeSpec::leaves)},
    {{"branch_links", "", std::int64_t{256}, 1, 256, "links of the trunk and of each branch"},
     of_model(&TreeSpec::branch_links)},
    {{"leaf_links", "", std::int64_t{4}, 1, 64, "links of a leaf"}, of_model(&TreeSpec::leaf_links)},
    {{"foliage",
      "",
      "green"s,
      {},
      {},
      "the colour of its leaves; bare: as in winter, with twigs in their place",
      pose::kFoliageColorNames},
     &TreeSettings::foliage},
    {{"grove", "", std::int64_t{1}, 1, 256,
      "trees in all: the others are this one, turned and scaled; they cost the stream nothing"},
     &TreeSettings::grove},
    {{"grove_radius", "m", 20.0, 1, 500, "how far from it they stand"}, &TreeSettings::grove_radius_m},
    {{"flexibility", "", 1.0, 0, 10, "factor on how far wood bends and sways: 1 as the species does, 0 not at all"},
     &TreeSettings::flexibility},
    {{"streamline_speed", "m/s", 6.0, 0.1, 60,
      "the wind in which the crown begins to fold: the lower, the less a storm bends wood beyond a breeze"},
     &TreeSettings::streamline_speed_m_s},
    {{"max_tilt", "deg", 60.0, 0, 120, "no wind bends a branch farther than this along the wind"},
     &TreeSettings::max_tilt_rad,
     radians_of},
    {{"max_swing", "deg", 60.0, 0, 120, "no wind bends a branch farther than this sideways"},
     &TreeSettings::max_swing_rad,
     radians_of},
    {{"crown_gusts", "", 0.12, 0, 1,
      "gusts that arise in the crown, as a part of the wind: the stronger, the less its limbs and leaves move "
      "as one"},
     &TreeSettings::crown_gusts},
    {{"turbulence", "", 0.2, 0, 2,
      "gusts of its own if the wind brings none: their standard deviation, as a part of the wind"},
     &TreeSettings::turbulence},
    {{"hybrid", "", 1.0, 0, 1, "0: wood follows the gusts alone; 1: each branch is a damped oscillator"},
     &TreeSettings::hybrid},
    {{"natural_frequency", "Hz", 0.5, 0.05, 5,
      "how fast the trunk sways by itself; limbs twice as fast and twigs 4 times, up to 30 percent off by "
      "their length"},
     &TreeSettings::natural_hz},
    {{"damping", "", 0.12, 0.02, 0.95,
      "how soon that sway ends: the damping ratio; if low, limbs swing long after a gust; of twigs a quarter more"},
     &TreeSettings::damping_ratio},
    {{"tile_period", "m", 64.0, 4, 4096, "after how many metres the wind on the ground repeats; 128 samples"},
     of_noise(&CarriedNoiseSpec::period_m)},
    {{"tiles", "", std::int64_t{2}, 1, 2, "2: a second tile hides the repeat; 1: the paper's letter"},
     of_noise(&CarriedNoiseSpec::has_two_tiles),
     are_two},
    {{"beta", "", 5.0 / 3.0, noise::kMinTransectBeta2, 4,
      "exponent of the wind's spectrum, 1/f^beta; 5/3 is Simiu's wind"},
     of_noise(&CarriedNoiseSpec::beta)},
    {{"beta_meaning",
      "",
      "transect"s,
      {},
      {},
      "transect: of a line through the field, true to the wind; radial: of each mode, the paper's letter",
      noise::kBetaMeaningNames},
     of_noise(&CarriedNoiseSpec::meaning)},
    {{"leaf_lean", "deg", 70.0, 0, 120,
      "how far a storm turns the softest leaf (a poplar's) downwind; a cherry's by 0.8 of it"},
     &TreeSettings::leaf_lean_rad,
     radians_of},
    {{"half_lean_speed", "m/s", 8.0, 0.1, 60,
      "the wind that turns leaves half as far: high, and only storms lay them over"},
     &TreeSettings::half_lean_speed_m_s},
    {{"leaf_flutter", "deg", 28.0, 0, 60,
      "how far the liveliest leaves (a poplar's) flutter in a strong wind: the standard deviation"},
     &TreeSettings::leaf_flutter_rad,
     radians_of},
};

/// The paper's dist_to_wind_side, in radii of the tree, is never below this.
constexpr double kWindSideFloor = 0.4;

/// A wind much below this has no windward side.
constexpr double kSidelessWind_m_s = 1.0;

/// Below this the mean wind is no measure of the gusts.
constexpr double kMinMean_m_s = 0.3;

/// The standard deviation of BranchForceJob's noise in a usual wind, of turbulence intensity 0.2 and with the crown's
/// own gusts: 0.45 in a weak wind, where the force goes with the square of the speed, and 0.3 in a storm.
constexpr double kUsualNoise = 0.4;

// The threshold of the split: it rises from -1.5 standard deviations of the noise at the windward side to 1.5 at the
// lee side, with a soft step one wide.
constexpr double kThresholdRise = 3.0 * kUsualNoise / (2.0 - kWindSideFloor);
constexpr double kThreshold = -1.5 * kUsualNoise - kThresholdRise * kWindSideFloor;
constexpr double kSplitWidth = kUsualNoise;

/// Limit of the tree's own gusts, in standard deviations; and of the finer noises of crown and leaves.
constexpr double kMaxOwnGust = 3.0;
constexpr double kLargestFine = 2.2;

/// Gusts that vary within less than this move a crown as a whole.
constexpr double kCrownCell_m = 1.0;

// The gusts that arise in the crown: as long as limbs, and carried at half the speed of the wind.
constexpr double kCrownShortest_m = 1.5;
constexpr double kCrownLongest_m = 5.0;
constexpr double kCrownCarry = 0.5;

/// The rates of limbs and twigs relative to the trunk, and their additional damping.
constexpr std::array<double, 3> kPace = {1.0, 2.0, 4.0};
constexpr std::array<double, 3> kDamping = {1.0, 1.0, 1.25};
constexpr double kMaxDamping = 0.95;

// Branches shorter than the median of their kind sway faster: by the power of 3/4, up to 30 percent.
constexpr double kPacePower = 0.75;
constexpr double kMaxPace = 1.3;

// The noise of leaves. Its waves, as long as several leaves of a spray, move along it at a speed that rises slowly with
// the wind, so that leaves flutter at 2 to 6 Hz: 0.75 (2.5 + 0.22 u) u / (u + 0.2), u in m/s.
constexpr double kLeafShortest_m = 0.4;
constexpr double kLeafLongest_m = 0.9;

/// That speed over the wind's.
double leaf_carry(double wind_m_s) {
  return 0.75 * (2.5 + 0.22 * wind_m_s) / (wind_m_s + 0.2);
}

/// The shift along x and z, per metre of height, of the place at which the crown is read, so that different heights
/// differ.
constexpr std::array<double, 2> kHeightSkew = {0.5, 0.7};

/// Maximum turn of the axis of a leaf's flutter from the leaf's direction.
constexpr double kMaxTwist_rad = 40.0 * kRadPerDeg;

/// A bare twig leaves its branch at this part of the angle of a leaf, and yields to the wind by this part of a leaf's
/// response.
constexpr double kBareTwigAngle = 0.75;
constexpr double kBareTwigGive = 0.12;

pose::TreeSkeleton placed_tree(const TreeSettings& settings, const Setup& setup) {
  TreeSpec model = settings.model;
  model.seed = setup.seed;
  model.habit = settings.species->habit;
  if (settings.is_bare()) {  // twigs in the place of leaves: they go on along those that bear them, and do not hang
    model.habit.leaf_angle_deg *= kBareTwigAngle;
    model.habit.leaf_droop_deg = 0.0;
  }
  pose::TreeSkeleton tree = make_tree(model);
  tree.foliage = settings.foliage;
  tree.copies = grove_of(settings.grove, settings.grove_radius_m, setup.seed);
  place(setup.placement, tree);
  return tree;
}

CarriedNoiseSpec tree_wind_noise(CarriedNoiseSpec noise, std::uint64_t seed) {
  noise.samples = 128;
  noise.seed = seed ^ math::stream_id("tree wind on the ground");
  return noise;
}

/// Read ten thousand times a tick: one small tile, which stays in the fast caches.
CarriedNoiseSpec leaf_noise(std::uint64_t seed) {
  return {.period_m = 12.8,
          .samples = 128,
          .beta = 1.0,
          .has_two_tiles = false,
          .shortest_m = kLeafShortest_m,
          .longest_m = kLeafLongest_m,
          .seed = seed ^ math::stream_id("tree wind in the leaves")};
}

/// One generation of wood: the positions of its branches, and the noises that they read.
struct Wood {
  std::size_t level = 0;
  std::size_t count = 0;
  double largest_hz = 0.0;
  double damping_ratio = 0.0;
  CarriedPlaces places, crown_places;  ///< for the middle of each branch, on the ground and in the crown
  std::size_t first_on_grid = 0;       ///< the same on the grid of the wind outside
  std::vector<float> side_x, side_z;   ///< the same from the tree's middle, in its radii
  std::vector<float> gain;             ///< rad
  std::vector<float> natural_hz;

  std::vector<float> east_m_s, south_m_s, gust;  ///< the wind there
  std::vector<float> distance, noise, toward_east, toward_south, vertical, horizontal;
  double force = 0.0;  ///< of the mean wind, over the mean distance
  operators::OscillatorSteps steps;
  operators::Oscillators oscillators;
};

/// The leaves, how each gives way and flutters, and how they respond to the wind at each twig.
struct Foliage {
  CarriedPlaces places;
  std::vector<std::uint32_t> twig;  ///< of each spray
  std::vector<float> give, axis_east, axis_south;
  double largest_give = 0.0;
  double liveliest = 0.0;

  std::vector<float> lean_east_rad, lean_south_rad, flutter_rad;  ///< at each twig
  std::vector<float> noise;
};

/// The position of the middle of a strand at rest.
struct StrandMiddle {
  double x_m, y_m, z_m;
};

StrandMiddle middle_of(const pose::StrandSkeleton& strands, std::size_t strand) {
  const auto number = [strand](const std::vector<float>& array) { return static_cast<double>(array[strand]); };
  StrandMiddle middle{number(strands.root_x_m), number(strands.root_y_m), number(strands.root_z_m)};
  for (std::size_t link = 0; link < (strands.links_per_strand + 1) / 2; ++link) {
    const double curled_rad = static_cast<double>(link) * number(strands.rest_curl_rad);
    const double along_m = number(strands.link_length_m) * std::cos(curled_rad);
    const double across_m = number(strands.link_length_m) * std::sin(curled_rad);
    middle.x_m += along_m * number(strands.rest_x) + across_m * number(strands.curl_x);
    middle.y_m += along_m * number(strands.rest_y) + across_m * number(strands.curl_y);
    middle.z_m += along_m * number(strands.rest_z) + across_m * number(strands.curl_z);
  }
  return middle;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class Tree final : public Scene {
 public:
  Tree(const TreeSettings& settings, const Setup& setup) : Tree(placed_tree(settings, setup), settings, setup) {}

  const pose::Skeleton& skeleton() const noexcept override { return skeleton_; }
  const pose::Pose& pose() const noexcept override { return pose_; }

  void shift(const wind::ground::Wind& wind, double dt_s) noexcept override {
    // The wind carries all noises on.
    wind_.step(wind, dt_s);
    middle_wind_.step(wind, dt_s);
    if (outside_) {
      outside_->step(wind, dt_s);
    } else {
      noise_.shift(wind_.east_m_s(), wind_.south_m_s(), dt_s);
    }
    const double east_m_s = middle_wind_.east_m_s();
    const double south_m_s = middle_wind_.south_m_s();
    crown_noise_.shift(kCrownCarry * east_m_s, kCrownCarry * south_m_s, dt_s);
    const double carry = leaf_carry(middle_wind_.speed_m_s());
    leaf_noise_.shift(carry * east_m_s, carry * south_m_s, dt_s);
  }

  void sample() noexcept override {
    for (Wood& wood : wood_) sample_wood(wood);
    operators::LeafResponseJob{.wind_east_m_s = wood_[kTwigs].east_m_s,
                               .wind_south_m_s = wood_[kTwigs].south_m_s,
                               .half_lean_speed_m_s = half_lean_speed_m_s_,
                               .flutter_speed_m_s = species_.flutter_speed_m_s,
                               .lean_rad = leaf_lean_rad_,
                               .flutter_rad = leaf_flutter_rad_,
                               .row = row_,
                               .lean_east_rad = leaves_.lean_east_rad,
                               .lean_south_rad = leaves_.lean_south_rad,
                               .flutter_rad_each = leaves_.flutter_rad}
        .run();
    const auto largest = static_cast<float>(kLargestFine);
    leaf_noise_.sample(leaves_.places, row_, leaves_.noise, 1.0F, 0.0F, -largest, largest);
  }

  void project(double dt_s) noexcept override {
    auto& levels = std::get_if<pose::TreePose>(&pose_)->levels;
    for (Wood& wood : wood_) {
      wood.steps.set_pace(wood.natural_hz, wood.damping_ratio, dt_s);
      project_wood(wood, levels[wood.level]);
    }
    operators::FlutterJob{.lean_east_rad = leaves_.lean_east_rad,
                          .lean_south_rad = leaves_.lean_south_rad,
                          .flutter_rad = leaves_.flutter_rad,
                          .place = leaves_.twig,
                          .noise = leaves_.noise,
                          .give = leaves_.give,
                          .axis_east = leaves_.axis_east,
                          .axis_south = leaves_.axis_south,
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

  void list_state(StatePass& pass) override {
    pass(wind_, middle_wind_, noise_, crown_noise_, leaf_noise_);
    for (Wood& wood : wood_) pass(wood.oscillators);
    if (outside_) pass(*outside_);
  }

 private:
  Tree(pose::TreeSkeleton tree, const TreeSettings& settings, const Setup& setup);

  /// The positions of branches on the ground, x and z.
  using Places = std::array<std::vector<float>, 2>;

  void add_wood(const pose::TreeSkeleton& tree, std::size_t level, const Placement& placement, Places& all_m);
  void add_leaves(const pose::TreeLevel& level, std::uint64_t seed);
  void sample_wood(Wood& wood) noexcept;
  void blow_on(Wood& wood) noexcept;
  void project_wood(Wood& wood, pose::StrandPose& pose) noexcept;
  double largest_wood_step_rad(const Wood& wood, double dt_s) const noexcept;
  double largest_leaf_step_rad(double dt_s) const noexcept;

  SimdRow row_;
  const TreeSpecies& species_;
  double flexibility_, streamline_speed_m_s_;
  double max_tilt_rad_, max_swing_rad_;
  double crown_gusts_, turbulence_;
  double hybrid_, natural_hz_, damping_ratio_;
  double leaf_lean_rad_, leaf_flutter_rad_, half_lean_speed_m_s_;

  Wind wind_;         ///< without the gusts, which differ from branch to branch
  Wind middle_wind_;  ///< with those at the tree's middle
  CarriedNoise noise_, crown_noise_, leaf_noise_;
  std::optional<WindGrid> outside_;  ///< the wind at each branch, if it has gusts; noise_ is then unused
  std::array<Wood, kLeaves> wood_;
  Foliage leaves_;
  std::array<double, pose::kMaxTreeLevels> levers_m_;
  pose::Skeleton skeleton_;
  pose::Pose pose_;
};

Tree::Tree(pose::TreeSkeleton tree, const TreeSettings& settings, const Setup& setup)
    : row_(setup.row),
      species_(*settings.species),
      flexibility_(settings.flexibility),
      streamline_speed_m_s_(settings.streamline_speed_m_s),
      max_tilt_rad_(settings.max_tilt_rad),
      max_swing_rad_(settings.max_swing_rad),
      crown_gusts_(settings.crown_gusts),
      turbulence_(settings.turbulence),
      hybrid_(settings.hybrid),
      natural_hz_(settings.natural_hz),
      damping_ratio_(settings.damping_ratio),
      leaf_lean_rad_(settings.leaf_lean_rad * (settings.is_bare() ? kBareTwigGive : 1.0)),
      leaf_flutter_rad_(settings.leaf_flutter_rad * species_.flutter * (settings.is_bare() ? kBareTwigGive : 1.0)),
      half_lean_speed_m_s_(settings.half_lean_speed_m_s),
      wind_(setup.placement, nullptr, setup.gusts ? WindPart::kMean : WindPart::kAll),
      middle_wind_(setup.placement, setup.gusts),
      noise_(tree_wind_noise(settings.noise, setup.seed)),
      crown_noise_(CarriedNoise::band(kCrownShortest_m, kCrownLongest_m,
                                      setup.seed ^ math::stream_id("tree gusts in the crown"))),
      leaf_noise_(leaf_noise(setup.seed)),
      levers_m_(tree_levers_m(tree)) {
  Places places_m;
  for (std::size_t level = 0; level < kLeaves; ++level) add_wood(tree, level, setup.placement, places_m);
  if (setup.gusts) outside_.emplace(setup.gusts, places_m[0], places_m[1], setup.row, kCrownCell_m);

  // Places from the tree's middle, in its radii.
  float radius_m = 1e-3F;
  for (const Wood& wood : wood_) {
    for (std::size_t i = 0; i < wood.count; ++i) {
      radius_m = std::max(radius_m, math::length(wood.side_x[i], wood.side_z[i]));
    }
  }
  for (Wood& wood : wood_) {
    for (auto* side : {&wood.side_x, &wood.side_z}) {
      for (float& place : *side) place /= radius_m;
    }
  }

  add_leaves(tree.levels[kLeaves], setup.seed);
  skeleton_ = std::move(tree);
  pose_ = pose::rest_pose(skeleton_);
}

void Tree::add_wood(const pose::TreeSkeleton& tree, std::size_t level, const Placement& placement, Places& all_m) {
  const pose::StrandSkeleton& strands = tree.levels[level].strands;
  const std::size_t padded = strands.padded_count();
  Wood& wood = wood_[level];
  wood.level = level;
  wood.count = strands.strand_count;
  wood.damping_ratio = std::min(kDamping[level] * damping_ratio_, kMaxDamping);

  // Thickness and length relative to the median branch of its kind determine its bend and its rate.
  std::vector<double> thickness_m;
  std::vector<double> length_m;
  for (std::size_t i = 0; i < wood.count; ++i) {
    thickness_m.push_back(static_cast<double>(tree.levels[level].base_radius_m[i]));
    length_m.push_back(static_cast<double>(strands.link_length_m[i]));
  }
  const double median_thickness_m = median(thickness_m);
  const double median_length_m = median(length_m);

  std::vector<float> x_m;
  std::vector<float> z_m;
  std::vector<float> crown_x_m;
  std::vector<float> crown_z_m;
  for (std::size_t i = 0; i < padded; ++i) {
    const bool is_there = i < wood.count;
    const StrandMiddle middle = middle_of(strands, i);
    x_m.push_back(static_cast<float>(middle.x_m));
    z_m.push_back(static_cast<float>(middle.z_m));
    crown_x_m.push_back(static_cast<float>(middle.x_m + kHeightSkew[0] * middle.y_m));
    crown_z_m.push_back(static_cast<float>(middle.z_m + kHeightSkew[1] * middle.y_m));
    wood.side_x.push_back(is_there ? static_cast<float>(middle.x_m - placement.x_m) : 0.0F);
    wood.side_z.push_back(is_there ? static_cast<float>(middle.z_m - placement.z_m) : 0.0F);

    const double thinness = is_there ? std::pow(median_thickness_m / thickness_m[i], species_.thinness_power) : 0.0;
    wood.gain.push_back(static_cast<float>(flexibility_ * species_.sway_deg[level] * kRadPerDeg * thinness));
    const double pace = is_there ? std::pow(median_length_m / length_m[i], kPacePower) : 1.0;
    const double hz = natural_hz_ * kPace[level] * std::clamp(pace, 1.0 / kMaxPace, kMaxPace);
    wood.natural_hz.push_back(static_cast<float>(hz));
    wood.largest_hz = std::max(wood.largest_hz, hz);
  }
  wood.places = noise_.places(x_m, z_m);
  wood.crown_places = crown_noise_.places(crown_x_m, crown_z_m);
  wood.first_on_grid = all_m[0].size();
  all_m[0].insert(all_m[0].end(), x_m.begin(), x_m.end());
  all_m[1].insert(all_m[1].end(), z_m.begin(), z_m.end());
  for (auto* array : {&wood.east_m_s, &wood.south_m_s, &wood.gust, &wood.distance, &wood.noise, &wood.toward_east,
                      &wood.toward_south, &wood.vertical, &wood.horizontal}) {
    array->assign(padded, 0.0F);
  }
  wood.steps = operators::OscillatorSteps(padded);
  wood.oscillators = operators::Oscillators(padded);
}

void Tree::add_leaves(const pose::TreeLevel& level, std::uint64_t seed) {
  const math::RandomStream random(seed, math::stream_id("tree petioles"));
  const pose::StrandSkeleton& strands = level.strands;
  std::vector<float> x_m;
  std::vector<float> z_m;
  for (std::size_t i = 0; i < strands.padded_count(); ++i) {
    const auto y_m = static_cast<double>(strands.root_y_m[i]);
    x_m.push_back(static_cast<float>(static_cast<double>(strands.root_x_m[i]) + kHeightSkew[0] * y_m));
    z_m.push_back(static_cast<float>(static_cast<double>(strands.root_z_m[i]) + kHeightSkew[1] * y_m));
    if (i % operators::FlutterJob::kLeavesOfASpray == 0)
      leaves_.twig.push_back(i < strands.strand_count ? level.parent[i] : 0);

    const double liveliness = 0.7 + 0.6 * random.uniform(2 * i);
    leaves_.give.push_back(static_cast<float>(species_.petiole * liveliness));
    leaves_.largest_give = std::max(leaves_.largest_give, species_.petiole * liveliness);
    leaves_.liveliest = std::max(leaves_.liveliest, liveliness);

    // It nods about an axis across its own direction; if it hangs straight down, about any level axis.
    const double twist_rad = kMaxTwist_rad * (2.0 * random.uniform(2 * i + 1) - 1.0);
    const auto rest_x = static_cast<double>(strands.rest_x[i]);
    const auto rest_z = static_cast<double>(strands.rest_z[i]);
    const double level_part = std::sqrt(rest_x * rest_x + rest_z * rest_z);
    const double x = level_part > 1e-6 ? rest_x / level_part : 1.0;
    const double z = level_part > 1e-6 ? rest_z / level_part : 0.0;
    leaves_.axis_east.push_back(static_cast<float>(liveliness * (std::cos(twist_rad) * x - std::sin(twist_rad) * z)));
    leaves_.axis_south.push_back(static_cast<float>(liveliness * (std::sin(twist_rad) * x + std::cos(twist_rad) * z)));
  }
  leaves_.places = leaf_noise_.places(x_m, z_m);
  leaves_.noise.assign(strands.padded_count(), 0.0F);
  for (auto* array : {&leaves_.lean_east_rad, &leaves_.lean_south_rad, &leaves_.flutter_rad}) {
    array->assign(wood_[kTwigs].east_m_s.size(), 0.0F);
  }
}

/// The wind at each branch: that of the ground there, or a uniform one with the tree's own gusts; plus the gusts that
/// arise in the crown.
void Tree::blow_on(Wood& wood) noexcept {
  const auto largest = static_cast<float>(kLargestFine * crown_gusts_);
  crown_noise_.sample(wood.crown_places, row_, wood.gust, static_cast<float>(crown_gusts_), 1.0F, 1.0F - largest,
                      1.0F + largest);
  if (outside_) {
    outside_->sample(wood.first_on_grid, wood.east_m_s, wood.south_m_s);
    for (std::size_t i = 0; i < wood.gust.size(); ++i) {
      const float gust = std::max(wood.gust[i], 0.0F);
      wood.east_m_s[i] *= gust;
      wood.south_m_s[i] *= gust;
    }
    return;
  }
  const auto largest_own = static_cast<float>(kMaxOwnGust * turbulence_);
  noise_.sample(wood.places, row_, wood.noise, static_cast<float>(turbulence_), 0.0F, -largest_own, largest_own);
  const auto east_m_s = static_cast<float>(wind_.east_m_s());
  const auto south_m_s = static_cast<float>(wind_.south_m_s());
  for (std::size_t i = 0; i < wood.gust.size(); ++i) {
    const float gust = std::max(wood.gust[i] + wood.noise[i], 0.0F);
    wood.east_m_s[i] = gust * east_m_s;
    wood.south_m_s[i] = gust * south_m_s;
  }
}

void Tree::sample_wood(Wood& wood) noexcept {
  blow_on(wood);
  const operators::BranchForceJob force{.mean_m_s = wind_.speed_m_s(),
                                        .streamline_speed_m_s = streamline_speed_m_s_,
                                        .calm_m_s = kMinMean_m_s,
                                        .row = row_,
                                        .wind_east_m_s = wood.east_m_s,
                                        .wind_south_m_s = wood.south_m_s,
                                        .noise = wood.noise,
                                        .toward_east = wood.toward_east,
                                        .toward_south = wood.toward_south};
  force.run();
  operators::WindSideJob{.wind_east_m_s = wind_.east_m_s(),
                         .wind_south_m_s = wind_.south_m_s(),
                         .calm_m_s = kSidelessWind_m_s,
                         .floor = kWindSideFloor,
                         .place_x = wood.side_x,
                         .place_z = wood.side_z,
                         .distance = wood.distance}
      .run();
  // Branches on the windward side bend more than the mean of their kind, those on the lee side less.
  double nearness = 0.0;
  for (std::size_t i = 0; i < wood.count; ++i) nearness += 1.0 / static_cast<double>(wood.distance[i]);
  wood.force = static_cast<double>(force.mean_force()) * static_cast<double>(wood.count) / nearness;
  operators::SplitJob{.noise = wood.noise,
                      .ramp = wood.distance,
                      .threshold = kThreshold,
                      .threshold_rise = kThresholdRise,
                      .width = kSplitWidth,
                      .row = row_,
                      .above = wood.vertical,
                      .below = wood.horizontal}
      .run();
}

void Tree::project_wood(Wood& wood, pose::StrandPose& pose) noexcept {
  operators::TiltJob{.force = wood.force,
                     .toward_east = wood.toward_east,
                     .toward_south = wood.toward_south,
                     .vertical = wood.vertical,
                     .horizontal = wood.horizontal,
                     .distance = wood.distance,
                     .gain = wood.gain,
                     .alpha_vertical = 1.0,
                     .beta_horizontal = species_.beta_horizontal,
                     .max_tilt_rad = max_tilt_rad_,
                     .max_swing_rad = max_swing_rad_,
                     .row = row_,
                     .bend_east_rad = pose.bend_east_rad,
                     .bend_south_rad = pose.bend_south_rad}
      .run();
  operators::OscillatorJob{.steps = &wood.steps,
                           .blend = hybrid_,
                           .row = row_,
                           .oscillators = &wood.oscillators,
                           .east = pose.bend_east_rad,
                           .south = pose.bend_south_rad}
      .run();
}

// How far the bend of a branch may change in a tick. TiltJob gives no bend beyond G = hypot(max_tilt, max_swing): so
// the bend changes by no more than 2 G, its whole range, and an oscillator that it drives by no more than the
// oscillator's largest rate for such a drive.
double Tree::largest_wood_step_rad(const Wood& wood, double dt_s) const noexcept {
  const double largest_rad = math::length(max_tilt_rad_, max_swing_rad_);
  const double swayed_rad =
      operators::OscillatorStep::largest_rate_per_s(wood.largest_hz, wood.damping_ratio) * dt_s * largest_rad;
  return (1.0 - hybrid_) * 2.0 * largest_rad + hybrid_ * swayed_rad;
}

// The bend of a leaf is give lean W + axis flutter V noise, W and V being its response to the wind u at its twig, 0 to
// 1. u is that of the ground (at most L, and changing by at most dL a tick: Wind, WindGrid) times a factor for the
// crown's gusts and the tree's own, each the noise (cut at n, and changing by at most largest_change() of its
// CarriedNoise) times its deviation d. So u is at most L (1 + sum of d n), and changes by at most dL (1 + sum of d n) +
// L (sum of d dn). The slopes of W and V over u are at most LeafResponseJob's constants, and the leaves' noise is cut
// and carried like the others. Neither part changes by more than its whole range.
double Tree::largest_leaf_step_rad(double dt_s) const noexcept {
  const double wind_step_m_s = Wind::largest_step_m_s(dt_s);
  const auto change = [&](const CarriedNoise& noise, double carry, double largest) {
    const double noise_step = noise.largest_change(carry * kStrongestSceneWind_m_s, carry * wind_step_m_s, dt_s);
    return std::min(noise_step, 2.0 * largest);
  };
  double gust = 1.0 + crown_gusts_ * kLargestFine;
  double gust_step = crown_gusts_ * change(crown_noise_, kCrownCarry, kLargestFine);
  if (!outside_) {
    gust += turbulence_ * kMaxOwnGust;
    gust_step += turbulence_ * change(noise_, 1.0, kMaxOwnGust);
  }
  const double step_m_s = wind_step_m_s * gust + kStrongestSceneWind_m_s * gust_step;

  // The noise of the leaves is fastest in the strongest wind.
  const double noise_step = change(leaf_noise_, leaf_carry(kStrongestSceneWind_m_s), kLargestFine);
  const double lean_step = std::min(operators::kSteepestBendShare * step_m_s / half_lean_speed_m_s_, 2.0);
  const double flutter_step = std::min(
      operators::LeafResponseJob::kSteepestFlutter * step_m_s / species_.flutter_speed_m_s * kLargestFine + noise_step,
      2.0 * kLargestFine);
  return leaves_.largest_give * leaf_lean_rad_ * lean_step + leaves_.liveliest * leaf_flutter_rad_ * flutter_step;
}

const std::array kRetiredTreeParameters = {
    RetiredParameter{"half_tilt_speed", "is now streamline_speed; flexibility sets how far wood bends"},
    RetiredParameter{"half_flutter_speed", "is now half_lean_speed; how soon leaves flutter is their species' own"},
};

}  // namespace

extern const Description kTreeScene;
const Description kTreeScene = {
    .name = "tree",
    .summary = "a tree in the wind: branches sway, leaves flutter",
    .parameters = kTreeFields.parameters(),
    .make =
        [](const ParameterValues& values, const Setup& setup) {
          return std::unique_ptr<Scene>(std::make_unique<Tree>(kTreeFields.of(values), setup));
        },
    .retired = kRetiredTreeParameters};

}  // namespace yuragi::scenes
