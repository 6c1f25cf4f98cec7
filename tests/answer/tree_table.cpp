#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tests/answer/joint_speeds.hpp"
#include "tests/answer/scene_table.hpp"
#include "tests/answer/spectra.hpp"

// Trees: trunk, limbs, twigs and leaves. Sources of the bounds: at Beaufort 3 "leaves and small twigs in constant
// motion", at 5 "small trees in leaf begin to sway", at 7 "whole trees in motion" (WMO); bends grow as U^2 and, as the
// crown gives way, as U^(2 + E) with E = -0.2 to -1.2 (Vogel 1989; de Langre 2008); branches sway at their own
// frequency, with the damping of open-grown broadleaves (Jackson 2019 and 2021; James, Haritos and Ades 2006); leaves
// flutter at some 3 to 6 Hz (Tadrist 2018). There are no data on how far twigs bend: up to 40 degrees on average at
// Beaufort 7, since with 32 a still picture of a storm looked like one of a breeze.

namespace yuragi::answer {
namespace {

/// Of a cherry. What a tree of another species is bent by is in proportion.
std::vector<Bound> tree_bounds(double trunk, double limb, double twig, Bound leaf) {
  const std::array trunk_bounds = {
      Bound{"trunk, mean", "deg", 2, {{at_most(0.1), {0.2, 0.6}, {0.8, 2}, {1.7, 4}}}},
      Bound{"trunk, sd", "deg", 2, {{at_most(0.05), {0.05, 0.3}, {0.15, 0.8}, {0.35, 1.6}}}},
  };
  const std::array limb_bounds = {
      Bound{"limb, mean", "deg", 2, {{at_most(0.3), {0.7, 2}, {2.6, 6.2}, {5.5, 12.5}}}},
      Bound{"limb, sd", "deg", 2, {{at_most(0.1), {0.3, 1.1}, {0.7, 2.4}, {1.0, 4.5}}}},
      Bound{"limb > 0.5 Hz, sd", "deg", 2, {{kAny, {0.3, 1.0}, {0.5, 1.6}, {0.6, 2.7}}}},
  };
  const std::array twig_bounds = {
      Bound{"twig, mean", "deg", 2, {{at_most(0.5), {1.9, 7}, {7, 22}, {14, 40}}}},
      Bound{"twig, sd", "deg", 2, {{at_most(0.2), {0.5, 2.4}, {2.3, 7}, {3.7, 11}}}},
  };
  const Bound peak{"limb > 0.6 Hz, peak", "Hz", 2, {{kAny, {0.8, 1.25}, {0.8, 1.25}, {0.8, 1.25}}}};
  const Bound between{"limb > 0.6 Hz, sd of the peaks", "%", 1, {{kAny, at_least(8), at_least(8), at_least(8)}}};
  const Bound leaf_hz{"leaf > 0.5 Hz, centroid", "Hz", 2, {{{1.6, 4}, {2.5, 5}, {3.3, 6.5}, {4.2, 8.5}}}};
  const std::array both = {
      Bound{"limb, answer", "", 2, {{kAny, at_least(0.5), kAny, kAny}}},
      Bound{"twig tip, speed", "m/s", 3, {}},
      Bound{"twig tip, speed / the number before", "", 2, {{kAny, at_least(2), at_least(1.2), at_least(1)}}},
      Bound{"leaf tip, speed", "m/s", 3, {}},
      Bound{"leaf tip, speed / the number before", "", 2, {{kAny, at_least(2), at_least(1.2), at_least(1)}}},
  };

  std::vector<Bound> all = scaled(trunk_bounds, trunk);
  for (const Bound& bound : scaled(limb_bounds, limb)) all.push_back(bound);
  for (const Bound& bound : {peak, between}) all.push_back(bound);
  for (const Bound& bound : scaled(twig_bounds, twig)) all.push_back(bound);
  for (const Bound& bound : {leaf, leaf_hz}) all.push_back(bound);
  all.insert(all.end(), both.begin(), both.end());
  return all;
}

class TreeMeter final : public Meter {
 public:
  explicit TreeMeter(const pose::Skeleton& skeleton) : TreeMeter(std::get<pose::TreeSkeleton>(skeleton)) {}

  bool needs_joints(std::size_t tick) const override { return JointSpeeds::needs_joints(tick); }

  void take(std::size_t tick, const pose::Pose& pose, const pose::Kinematics& joints) override {
    for (BendTracks* level : {&trunk_, &limbs_, &twigs_, &leaves_}) level->take(pose);
    twig_speeds_.take(tick, joints);
    leaf_speeds_.take(tick, joints);
  }

  Horizontal direction(const pose::Pose& pose, const pose::Kinematics& /*joints*/) const override {
    const pose::StrandPose& limbs = std::get<pose::TreePose>(pose).levels[kLimbs];
    Horizontal sum;
    for (std::size_t i = 0; i < limbs_.count(); ++i) {
      sum.east += static_cast<double>(limbs.bend_east_rad[limbs_.strand(i)]);
      sum.south += static_cast<double>(limbs.bend_south_rad[limbs_.strand(i)]);
    }
    return sum;
  }

  double largest_step_m() const override {
    return std::max(twig_speeds_.largest_step_m(), leaf_speeds_.largest_step_m());
  }

  Figures figures(const WindRecord& wind) const override {
    Figures all;
    const Horizontal downwind = wind.downwind();
    add_level("trunk", trunk_.along_deg(downwind), all);
    const std::vector<Series> limbs_deg = limbs_.along_deg(downwind);
    add_level("limb", limbs_deg, all);
    add_level("twig", twigs_.along_deg(downwind), all);

    Welch welch(kRate_hz);
    std::vector<double> quick_deg, peak_hz;
    for (const Series& limb_deg : limbs_deg) {
      const Spectrum spectrum = welch.of(limb_deg);
      quick_deg.push_back(spectrum.deviation_above(0.5));
      peak_hz.push_back(spectrum.peak_hz(0.6, 0.5 * kRate_hz));
    }
    all.push_back({"limb > 0.5 Hz, sd", median(quick_deg)});
    all.push_back({"limb > 0.6 Hz, peak", median(peak_hz)});
    all.push_back({"limb > 0.6 Hz, sd of the peaks", 100.0 * deviation_of(peak_hz) / mean_of(peak_hz)});

    // Of leaves both axes count: the variances add up.
    std::vector<double> leaf_deg, leaf_hz;
    for (std::size_t i = 0; i < leaves_.count(); ++i) {
      leaf_deg.push_back(std::hypot(deviation(leaves_.east_deg(i)), deviation(leaves_.south_deg(i))));
      Spectrum spectrum = welch.of(leaves_.east_deg(i));
      spectrum += welch.of(leaves_.south_deg(i));
      leaf_hz.push_back(spectrum.centroid_hz(0.5));
    }
    all.push_back({"leaf, sd", median(leaf_deg)});
    all.push_back({"leaf > 0.5 Hz, centroid", median(leaf_hz)});
    all.push_back({"limb, answer", wind.answer_of(mean_at_each_moment(limbs_deg))});
    all.push_back({"twig tip, speed", twig_speeds_.median_m_s(kRate_hz)});
    all.push_back({"leaf tip, speed", leaf_speeds_.median_m_s(kRate_hz)});
    return all;
  }

  std::vector<Trace> traces(const WindRecord& wind) const override {
    const Horizontal downwind = wind.downwind();
    return {{"limb", "deg", limbs_.along_deg(downwind)[limbs_.count() / 2]},
            {"twig", "deg", twigs_.along_deg(downwind)[twigs_.count() / 2]},
            {"leaf", "deg", leaves_.along_deg(downwind)[leaves_.count() / 2]}};
  }

 private:
  static constexpr std::size_t kLimbs = 1, kTwigs = 2, kLeaves = 3;  ///< levels, in the order in which they grow
  static constexpr std::size_t kMaxTwigs = 60, kMaxLeaves = 100;

  explicit TreeMeter(const pose::TreeSkeleton& tree)
      : trunk_({0}, 0),
        limbs_(spread(strands_in(tree, kLimbs), strands_in(tree, kLimbs)), kLimbs),
        twigs_(spread(strands_in(tree, kTwigs), kMaxTwigs), kTwigs),
        leaves_(spread(strands_in(tree, kLeaves), kMaxLeaves), kLeaves),
        twig_speeds_(tips(tree, kTwigs, kMaxTwigs)),
        leaf_speeds_(tips(tree, kLeaves, kMaxLeaves)) {}

  static std::size_t strands_in(const pose::TreeSkeleton& tree, std::size_t level) {
    return tree.levels[level].strands.strand_count;
  }

  static std::vector<std::size_t> tips(const pose::TreeSkeleton& tree, std::size_t level, std::size_t most) {
    std::size_t first = 0;
    for (std::size_t below = 0; below < level; ++below) {
      first += strands_in(tree, below) * tree.levels[below].strands.links_per_strand;
    }
    const std::size_t links = tree.levels[level].strands.links_per_strand;
    std::vector<std::size_t> joints = spread(strands_in(tree, level), most);
    for (std::size_t& joint : joints) joint = first + joint * links + links - 1;
    return joints;
  }

  static void add_level(const std::string& level, const std::vector<Series>& bends_deg, Figures& all) {
    std::vector<double> means, deviations;
    for (const Series& bend_deg : bends_deg) {
      means.push_back(mean(bend_deg));
      deviations.push_back(deviation(bend_deg));
    }
    all.push_back({level + ", mean", median(means)});
    all.push_back({level + ", sd", median(deviations)});
  }

  BendTracks trunk_, limbs_, twigs_, leaves_;
  JointSpeeds twig_speeds_, leaf_speeds_;
};

/// Fewer leaves and links than a tree is shown with: neither changes how a branch or a leaf is bent.
SceneTable table_of(std::string_view name, const std::string& species, std::vector<Bound> bounds) {
  return {.name = name,
          .scene = "tree",
          .parameters = {{"species", species}, {"leaves", std::int64_t{1600}}, {"branch_links", std::int64_t{32}}},
          .bounds = std::move(bounds),
          .make_meter = [](const pose::Skeleton& skeleton) -> std::unique_ptr<Meter> {
            return std::make_unique<TreeMeter>(skeleton);
          }};
}

}  // namespace

SceneTable tree_table() {
  return table_of("tree", "cherry",
                  tree_bounds(1.0, 1.0, 1.0, {"leaf, sd", "deg", 1, {{{0.1, 2}, {5, 11}, {9, 18}, {9, 20}}}}));
}

/// Its leaves flutter as a cherry's, a seventh farther.
SceneTable zelkova_table() {
  return table_of("zelkova", "zelkova",
                  tree_bounds(1.15, 1.15, 1.15, {"leaf, sd", "deg", 1, {{{0.1, 2.9}, {6, 14}, {9, 21}, {9, 23}}}}));
}

SceneTable poplar_table() {
  return table_of("poplar", "poplar",
                  tree_bounds(1.5, 0.9, 1.0, {"leaf, sd", "deg", 1, {{{3, 12}, {18, 36}, {20, 38}, {18, 38}}}}));
}

}  // namespace yuragi::answer
