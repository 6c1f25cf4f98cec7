#include "engine/scenes/tree_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"

namespace yuragi::scenes {
namespace {

constexpr double kGoldenAngle_rad = kPi * (3.0 - 2.23606797749979);  // 137.5 degrees

/// At the foot of an average twig, for a tree of 8 m; all wood is in proportion.
constexpr double kTwigRadiusPerHeight = 0.008 / 8.0;
constexpr double kTipRadiusShare = 0.3;  ///< of the radius at the foot, for a twig

/// Maximum length of a branch, relative to the habit's length.
constexpr double kMaxVigour = 1.06;

/// Leaves grow at nodes, this many from a twig's foot to its tip, in sprays of 16 consecutive leaves. (So they have few
/// joints as roots, which stay in the cache.)
constexpr std::size_t kNodesOfATwig = 36;

/// Length of a whorl, as a share of the distance between whorls.
constexpr double kWhorlLength = 0.3;

struct TreeVector {
  double x, y, z;

  friend TreeVector operator+(TreeVector a, TreeVector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend TreeVector operator*(double k, TreeVector a) { return {k * a.x, k * a.y, k * a.z}; }
};

double dot(TreeVector a, TreeVector b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
TreeVector cross(TreeVector a, TreeVector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
TreeVector unit(TreeVector a) {
  return 1.0 / std::sqrt(dot(a, a)) * a;
}

/// The unit vector across `along` (a unit vector) at an angle around it. At 0 it is level, and continuous except where
/// `along` is upright.
TreeVector across(TreeVector along, double around_rad) {
  const TreeVector level = cross({0.0, 1.0, 0.0}, along);
  const TreeVector first = dot(level, level) > 1e-12 ? unit(level) : TreeVector{1.0, 0.0, 0.0};
  return std::cos(around_rad) * first + std::sin(around_rad) * cross(along, first);
}

/// One strand at rest.
struct Shoot {
  TreeVector root;
  TreeVector rest;
  TreeVector curl;
  double curl_rad;  ///< between one link and the next
  double link_length_m;
  double base_radius_m = 0.0;
  double tip_radius_m = 0.0;
  std::uint32_t parent = 0;
  std::uint32_t parent_link = 0;
};

/// A shoot that leaves `root` toward `rest`, and from foot to tip curls toward `to` (up, or down) by `curl_rad` in all.
Shoot shoot(TreeVector root, TreeVector rest, TreeVector to, double curl_rad, double length_m, std::size_t links) {
  const double count = static_cast<double>(links);
  const TreeVector side = to + -dot(to, rest) * rest;
  const double flat = std::sqrt(dot(side, side));  // upright or hanging: no direction to curl to
  return {.root = root,
          .rest = rest,
          .curl = flat > 1e-3 ? 1.0 / flat * side : across(rest, 0.0),
          .curl_rad = curl_rad * std::min(flat, 1.0) / count,
          .link_length_m = length_m / count};
}

/// The joints of a shoot at rest: the place of a child, and the direction of the link on which it grows.
struct Course {
  std::vector<TreeVector> joint;
  std::vector<TreeVector> direction;
};

Course course_of(const Shoot& shoot, std::size_t links) {
  Course course;
  TreeVector at = shoot.root;
  for (std::size_t k = 0; k < links; ++k) {
    const double curled_rad = static_cast<double>(k) * shoot.curl_rad;
    const TreeVector direction = std::cos(curled_rad) * shoot.rest + std::sin(curled_rad) * shoot.curl;
    at = at + shoot.link_length_m * direction;
    course.joint.push_back(at);
    course.direction.push_back(direction);
  }
  return course;
}

/// The place of branch `i` of `count` in whorls of about `whorl`: 0 at the lowest place, 1 at the parent's tip.
/// `jitter`: 0 to 1, its shift within the whorl.
double place_in_whorls(std::size_t i, std::size_t count, std::size_t whorl, double jitter) {
  const double even = (static_cast<double>(i) + 0.2 + 0.6 * jitter) / static_cast<double>(count);
  if (whorl <= 1) return even;
  const double whorls = std::max(std::round(static_cast<double>(count) / static_cast<double>(whorl)), 1.0);
  const double number = std::floor(even * whorls);
  // The last one ends at the tip.
  return (number + 1.0 - kWhorlLength * (1.0 - (even * whorls - number))) / whorls;
}

double interpolated(const std::array<double, 2>& ends, double part) {
  return ends[0] + part * (ends[1] - ends[0]);
}

/// A factor around 1, within 40 % of it.
double random_factor(const math::RandomStream& random, std::size_t index, double deviation) {
  return std::clamp(1.0 + deviation * random.normal(index), 0.6, 1.4);
}

class Grower {
 public:
  explicit Grower(const TreeSpec& spec) : spec_(spec), height_m_(spec.size * spec.habit.height_m) {}

  pose::TreeSkeleton grow() {
    grow_trunk();
    limbs_ = grow_branches(trunk_, spec_.habit.limb, spec_.limbs, "tree limbs");
    twigs_ = grow_branches(limbs_, spec_.habit.twig, spec_.twigs, "tree twigs");
    grow_leaves();
    thicken();

    pose::TreeSkeleton tree;
    tree.levels.resize(kTreePartCount);
    fill(tree.levels[kTrunk], trunk_, spec_.branch_links);
    fill(tree.levels[kLimbs], limbs_, spec_.branch_links);
    fill(tree.levels[kTwigs], twigs_, spec_.branch_links);
    fill(tree.levels[kLeaves], leaves_, spec_.leaf_links);
    for (std::size_t i = kLimbs; i < kTreePartCount; ++i) tree.levels[i].parent_level = i - 1;
    tree.levels[kTrunk].parent.clear();
    tree.levels[kTrunk].parent_link.clear();
    tree.levels[kLeaves].is_turned_by_block = true;
    tree.levels[kLeaves].is_leaves = true;
    return tree;
  }

 private:
  /// Nearly upright, with a slight bow.
  void grow_trunk() {
    const math::RandomStream random(spec_.seed, math::stream_id("tree trunk"));
    const double around_rad = 2.0 * kPi * random.uniform(0);
    const double lean_rad = 2.0 * kRadPerDeg * random.uniform(1);
    const TreeVector side = {std::sin(around_rad), 0.0, -std::cos(around_rad)};
    const TreeVector rest = std::cos(lean_rad) * TreeVector{0.0, 1.0, 0.0} + std::sin(lean_rad) * side;
    const double length_m = spec_.habit.trunk_share * height_m_;
    Shoot trunk = shoot({0.0, 0.0, 0.0}, rest, across(rest, 2.0 * kPi * random.uniform(2)),
                        5.0 * kRadPerDeg * random.uniform(3), length_m, spec_.branch_links);
    trunk_.push_back(trunk);
  }

  /// `count` branches, shared out evenly among the parents, from the foot of each to its tip.
  std::vector<Shoot> grow_branches(const std::vector<Shoot>& parents, const BranchHabit& habit, std::size_t count,
                                   std::string_view what) const {
    const math::RandomStream random(spec_.seed, math::stream_id(what));
    std::vector<Shoot> branches;
    for (std::size_t p = 0; p < parents.size(); ++p) {
      const std::size_t first = p * count / parents.size();
      const std::size_t own = (p + 1) * count / parents.size() - first;
      const Course course = course_of(parents[p], spec_.branch_links);
      for (std::size_t i = 0; i < own; ++i) {
        const std::size_t index = 8 * (first + i);  // of its random numbers
        const double part = place_in_whorls(i, own, habit.whorl, random.uniform(index));
        const std::size_t link = link_at(habit.first_at + part * (1.0 - habit.first_at));
        const double around_rad = kGoldenAngle_rad * static_cast<double>(first + i) + 0.5 * random.uniform(index + 1);
        const double angle_rad =
            interpolated(habit.angle_deg, part) * kRadPerDeg * random_factor(random, index + 2, 0.12);
        const TreeVector rest = std::cos(angle_rad) * course.direction[link] +
                                std::sin(angle_rad) * across(course.direction[link], around_rad);
        const double rank = i % 2 == 0 ? 1.0 : habit.minor_share;
        // None is much larger than its neighbours: parts above the crown are exposed to the wind, and light is
        // everywhere.
        const double vigour = std::min(random_factor(random, index + 4, 0.15), kMaxVigour);
        const double length_m = rank * interpolated(habit.length_share, part) * height_m_ * vigour;
        const double lift_rad = habit.lift_deg * kRadPerDeg * random_factor(random, index + 6, 0.3);
        Shoot& branch = branches.emplace_back(shoot(course.joint[link], rest, {0.0, lift_rad < 0.0 ? -1.0 : 1.0, 0.0},
                                                    std::abs(lift_rad), length_m, spec_.branch_links));
        branch.parent = static_cast<std::uint32_t>(p);
        branch.parent_link = static_cast<std::uint32_t>(link);
      }
    }
    return branches;
  }

  /// The root of a spray of leaves.
  struct Spray {
    std::size_t twig;
    std::size_t node;
  };

  /// Sprays one after the other along the twigs: the remainder of their number per twig shifts them from twig to twig.
  /// In the order of their roots in memory: by blocks of twigs, then by node (JointPositions).
  std::vector<Spray> sprays() const {
    const std::size_t count = (spec_.leaves + pose::kStrandsPerBlock - 1) / pose::kStrandsPerBlock;
    const std::size_t most = kNodesOfATwig - pose::kStrandsPerBlock;
    const auto first =
        std::min(static_cast<std::size_t>(spec_.habit.leafless_share * static_cast<double>(kNodesOfATwig)), most);
    const std::size_t starts = most - first + 1;
    std::vector<Spray> sprays;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t left_over = i * twigs_.size() % count;
      sprays.push_back({i * twigs_.size() / count, first + left_over * starts / count});
    }
    std::stable_sort(sprays.begin(), sprays.end(), [](const Spray& a, const Spray& b) {
      const std::size_t a_block = a.twig / pose::kStrandsPerBlock;
      const std::size_t b_block = b.twig / pose::kStrandsPerBlock;
      return a_block != b_block ? a_block < b_block : a.node < b.node;
    });
    return sprays;
  }

  void grow_leaves() {
    const math::RandomStream random(spec_.seed, math::stream_id("tree leaves"));
    const TreeHabit& habit = spec_.habit;
    std::vector<Course> courses;
    for (const Shoot& twig : twigs_) courses.push_back(course_of(twig, spec_.branch_links));
    const std::vector<Spray> all_sprays = sprays();
    for (std::size_t leaf = 0; leaf < spec_.leaves; ++leaf) {
      const Spray& spray = all_sprays[leaf / pose::kStrandsPerBlock];
      const Course& course = courses[spray.twig];
      const std::size_t node = spray.node + leaf % pose::kStrandsPerBlock;
      const std::size_t link = link_at(static_cast<double>(node) / kNodesOfATwig);
      const double angle_rad = habit.leaf_angle_deg * kRadPerDeg * random_factor(random, 4 * leaf, 0.2);
      const TreeVector rest =
          std::cos(angle_rad) * course.direction[link] +
          std::sin(angle_rad) * across(course.direction[link], kGoldenAngle_rad * static_cast<double>(leaf));
      const double length_m = habit.leaf_length_m * spec_.size * random_factor(random, 4 * leaf + 2, 0.15);
      Shoot& grown = leaves_.emplace_back(shoot(course.joint[link], rest, {0.0, -1.0, 0.0},
                                                habit.leaf_droop_deg * kRadPerDeg, length_m, spec_.leaf_links));
      grown.parent = static_cast<std::uint32_t>(spray.twig);
      grown.parent_link = static_cast<std::uint32_t>(link);
      grown.base_radius_m = grown.tip_radius_m = 0.5 * habit.leaf_width_share * length_m;
    }
  }

  /// The pipe model, from the twigs down to the trunk.
  void thicken() {
    double mean_m = 0.0;
    for (const Shoot& twig : twigs_) mean_m += twig.link_length_m / static_cast<double>(twigs_.size());
    for (Shoot& twig : twigs_) {
      twig.base_radius_m = kTwigRadiusPerHeight * height_m_ * twig.link_length_m / mean_m;
      twig.tip_radius_m = kTipRadiusShare * twig.base_radius_m;
    }
    carry(twigs_, limbs_);
    carry(limbs_, trunk_);
  }

  /// A branch's section at its foot is the sum of its children's, and at its tip it is as thin as their mean.
  static void carry(const std::vector<Shoot>& children, std::vector<Shoot>& branches) {
    std::vector<double> square_m2(branches.size(), 0.0);
    std::vector<double> count(branches.size(), 0.0);
    for (const Shoot& child : children) {
      square_m2[child.parent] += child.base_radius_m * child.base_radius_m;
      count[child.parent] += 1.0;
    }
    for (std::size_t i = 0; i < branches.size(); ++i) {
      if (count[i] == 0.0) {  // bare: as thick as one child
        square_m2[i] = children.front().base_radius_m * children.front().base_radius_m;
        count[i] = 1.0;
      }
      branches[i].base_radius_m = std::sqrt(square_m2[i]);
      branches[i].tip_radius_m = std::sqrt(square_m2[i] / count[i]) * 0.7;
    }
  }

  std::size_t link_at(double part) const {
    const double links = static_cast<double>(spec_.branch_links);
    return static_cast<std::size_t>(std::clamp(part * links, 0.0, links - 1.0));
  }

  /// The padding after the last strand is upright at the world's origin and has length 0.
  static void fill(pose::TreeLevel& level, const std::vector<Shoot>& shoots, std::size_t links) {
    pose::StrandSkeleton& strands = level.strands;
    strands.strand_count = shoots.size();
    strands.links_per_strand = links;
    const Shoot nothing{
        .root = {}, .rest = {0.0, 1.0, 0.0}, .curl = {1.0, 0.0, 0.0}, .curl_rad = 0, .link_length_m = 0};
    for (std::size_t i = 0; i < strands.padded_count(); ++i) {
      const Shoot& shoot = i < shoots.size() ? shoots[i] : nothing;
      strands.root_x_m.push_back(static_cast<float>(shoot.root.x));
      strands.root_y_m.push_back(static_cast<float>(shoot.root.y));
      strands.root_z_m.push_back(static_cast<float>(shoot.root.z));
      strands.rest_x.push_back(static_cast<float>(shoot.rest.x));
      strands.rest_y.push_back(static_cast<float>(shoot.rest.y));
      strands.rest_z.push_back(static_cast<float>(shoot.rest.z));
      strands.curl_x.push_back(static_cast<float>(shoot.curl.x));
      strands.curl_y.push_back(static_cast<float>(shoot.curl.y));
      strands.curl_z.push_back(static_cast<float>(shoot.curl.z));
      strands.rest_curl_rad.push_back(static_cast<float>(shoot.curl_rad));
      strands.link_length_m.push_back(static_cast<float>(shoot.link_length_m));
      level.base_radius_m.push_back(static_cast<float>(shoot.base_radius_m));
      level.tip_radius_m.push_back(static_cast<float>(shoot.tip_radius_m));
      level.parent.push_back(shoot.parent);
      level.parent_link.push_back(shoot.parent_link);
    }
  }

  const TreeSpec& spec_;
  double height_m_;
  std::vector<Shoot> trunk_, limbs_, twigs_, leaves_;
};

}  // namespace

pose::TreeSkeleton make_tree(const TreeSpec& spec) {
  return Grower(spec).grow();
}

pose::TreeCopies grove_of(std::size_t trees, double radius_m, std::uint64_t seed) {
  const math::RandomStream random(seed, math::stream_id("tree grove"));
  const double spacing_m = radius_m / std::sqrt(static_cast<double>(trees));
  pose::TreeCopies copies;
  for (std::size_t i = 1; i < trees; ++i) {
    const double around_rad = kGoldenAngle_rad * static_cast<double>(i) + 2.0 * kPi * random.uniform(0);
    const double away_m = radius_m * std::sqrt(static_cast<double>(i) / static_cast<double>(trees - 1));
    const double shifted_rad = 2.0 * kPi * random.uniform(4 * i);
    const double shift_m = 0.3 * spacing_m * random.uniform(4 * i + 1);
    copies.x_m.push_back(static_cast<float>(away_m * std::cos(around_rad) + shift_m * std::cos(shifted_rad)));
    copies.z_m.push_back(static_cast<float>(away_m * std::sin(around_rad) + shift_m * std::sin(shifted_rad)));
    copies.turn_rad.push_back(static_cast<float>(0.5 * kPi * static_cast<double>(i % 4)));
    copies.scale.push_back(static_cast<float>(0.8 + 0.35 * random.uniform(4 * i + 2)));
  }
  return copies;
}

std::array<double, pose::kMaxTreeLevels> tree_levers_m(const pose::TreeSkeleton& tree) {
  std::array<double, pose::kMaxTreeLevels> largest_m = {};
  for (std::size_t top = 0; top < tree.levels.size(); ++top) {
    for (std::size_t tip = 0; tip < tree.levels[top].strands.strand_count; ++tip) {
      // From the tip of a strand down to the ground: for each strand on the path, the links up to the branch.
      std::array<double, pose::kMaxTreeLevels> lever_m = {};
      double beyond_m = 0.0;  // the distance from there to the tip
      std::size_t level = top;
      std::size_t strand = tip;
      double links = static_cast<double>(tree.levels[top].strands.links_per_strand);  // up to it
      for (;;) {
        const pose::StrandSkeleton& strands = tree.levels[level].strands;
        const double all_links = static_cast<double>(strands.links_per_strand);
        const double link_m = static_cast<double>(strands.link_length_m[strand]);
        lever_m[level] += link_m * links * (links + 1.0) / (2.0 * all_links) + beyond_m * links / all_links;
        beyond_m += link_m * links;
        if (level == 0) break;
        links = static_cast<double>(tree.levels[level].parent_link[strand]) + 1.0;
        strand = tree.levels[level].parent[strand];
        level = tree.levels[level].parent_level;
      }
      for (std::size_t i = 0; i < pose::kMaxTreeLevels; ++i) largest_m[i] = std::max(largest_m[i], lever_m[i]);
    }
  }
  return largest_m;
}

}  // namespace yuragi::scenes
